//! Curves over time, for print: a panel for each unit, one above the other, over a common axis.

mod panel;

use std::path::Path;

use super::encode::write_png;
use super::error::RenderError;
use super::image::Image;
use super::job::Existing;
use super::options::Background;
use super::origin::Origin;
use super::output::{Output, plan_output};
use super::paper::Paper;
use super::sheet::Sheet;
use super::theme::Theme;
use panel::{Frame, Panel};

/// A quantity over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Name of the quantity: it stands above a panel whose curves all are the same.
    pub quantity: String,
    /// Unit; empty for counts, `1` for fractions.
    pub unit: String,
    /// Time \[s] and value; where a value is not a number, the line has a gap.
    pub points: Vec<[f64; 2]>,
}

/// How a plot looks.
#[derive(Clone, Debug)]
pub struct PlotOptions {
    /// Width in pixels; the height follows from the number of panels.
    pub width: u32,
    /// Ground colour.
    pub background: Background,
    /// Whether an existing file may be replaced.
    pub existing: Existing,
    /// The run it shows: a plot of the same run may be replaced.
    pub origin: Origin,
}

/// Writes a plot as `NAME.svg`, `NAME.pdf` or `NAME.png`.
///
/// # Errors
/// For another ending, for a file that exists and may not be replaced or cannot be written.
pub fn write_plot(curves: &[Curve], options: PlotOptions, path: &Path) -> Result<(), RenderError> {
    let output = plan_output(path).ok();
    let kept = options.existing == Existing::Keep && !options.origin.made(path);
    if kept && path.symlink_metadata().is_ok() {
        return Err(RenderError::Exists(path.to_owned()));
    }
    let (mark, plot) = (options.origin.mark(), Plot::new(curves, &options));
    let write = |bytes: Vec<u8>| {
        std::fs::write(path, bytes).map_err(|source| RenderError::Write { path: path.to_owned(), source })
    };
    match output {
        Some(Output::Svg(_)) => write(plot.sheet().svg(mark).into_bytes()),
        Some(Output::Pdf(_)) => write(plot.sheet().pdf(mark)),
        Some(Output::Picture(_)) => {
            let [width, height] = plot.size().map(|length| length.round() as u32);
            let mut image = Image::new(width, height, plot.theme.background)?;
            plot.draw(&mut image);
            write_png(path, &image, mark)
        }
        _ => Err(RenderError::PlotFormat(path.to_owned())),
    }
}

struct Plot<'a> {
    panels: Vec<Panel<'a>>,
    theme: Theme,
    width: f32,
    /// First and last time \[s].
    times: [f64; 2],
}

impl<'a> Plot<'a> {
    /// Sorts the curves by unit, in the order in which units come.
    fn new(curves: &'a [Curve], options: &PlotOptions) -> Self {
        let mut panels: Vec<Panel<'a>> = Vec::new();
        for (number, curve) in curves.iter().enumerate() {
            match panels.iter_mut().find(|panel| panel.unit == curve.unit) {
                Some(panel) => panel.curves.push((number, curve)),
                None => panels.push(Panel { unit: &curve.unit, curves: vec![(number, curve)] }),
            }
        }
        let times = || curves.iter().flat_map(|curve| curve.points.iter().map(|point| point[0]));
        let times = [times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max)];
        let times = if times[0] < times[1] { times } else { [0.0, 1.0] };
        Plot { panels, theme: Theme::of(options.background), width: options.width as f32, times }
    }

    fn scale(&self) -> f32 {
        (self.width / 640.0).clamp(0.4, 8.0)
    }

    /// Places of the panels on the sheet, from the top, and the height of all.
    fn frames(&self) -> (Vec<Frame>, f32) {
        let scale = self.scale();
        let (left, right) = (66.0 * scale, self.width - 18.0 * scale);
        let tall = (right - left) * if self.panels.len() == 1 { 0.5 } else { 0.32 };
        let mut top = 0.0;
        let frames = self.panels.iter().map(|panel| {
            let head = panel.head_height(right - left, scale);
            let frame = Frame { left, right, top: top + head, bottom: top + head + tall, head: top, scale };
            top = frame.bottom + 12.0 * scale;
            frame
        });
        (frames.collect(), top + 34.0 * scale)
    }

    fn size(&self) -> [f32; 2] {
        [self.width, self.frames().1.ceil()]
    }

    fn draw(&self, paper: &mut dyn Paper) {
        let frames = self.frames().0;
        for (number, (panel, frame)) in self.panels.iter().zip(&frames).enumerate() {
            panel.draw(paper, frame, self.times, number + 1 == frames.len(), &self.theme);
        }
    }

    fn sheet(&self) -> Sheet {
        let mut sheet = Sheet::new(self.size(), self.theme.background);
        self.draw(&mut sheet);
        sheet
    }
}
