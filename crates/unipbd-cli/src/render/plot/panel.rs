//! One panel of a plot: axes, curves, and a head with their names.

use super::Curve;
use crate::render::axes::{tick_step, ticks};
use crate::render::color::{Rgb, mix};
use crate::render::labels::number;
use crate::render::paper::Paper;
use crate::render::text::{self, Align, Lettering};
use crate::render::theme::Theme;

/// Colours that people with any colour vision tell apart (Okabe and Ito, 2008).
const COLORS: [Rgb; 6] = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];
/// Height of a capital, from one line of the head to the next, and length of the line beside a name, at scale 1.
const LETTER: f32 = 9.0;
const LINE: f32 = 19.0;
const SAMPLE: f32 = 20.0;

/// Curves of one unit, with their numbers in the whole plot.
pub(super) struct Panel<'a> {
    pub unit: &'a str,
    pub curves: Vec<(usize, &'a Curve)>,
}

/// Where a panel stands [pixels].
pub(super) struct Frame {
    pub left: f32,
    pub right: f32,
    pub top: f32,
    pub bottom: f32,
    /// Top of what stands above the axes.
    pub head: f32,
    pub scale: f32,
}

impl Panel<'_> {
    /// The name of the vertical axis: of the quantity where there is one, and the unit.
    fn label(&self) -> String {
        let first = &self.curves[0].1.quantity;
        let one = self.curves.iter().all(|(_, curve)| curve.quantity == *first);
        let quantity = if one { first.as_str() } else { "" };
        let text = if self.unit.is_empty() { quantity.to_owned() } else { format!("{quantity} [{}]", self.unit) };
        text.trim_start().to_owned()
    }

    /// Where the names of the legend stand in the head: row, and distance from the left [pixels].
    fn entries(&self, width: f32, scale: f32) -> Vec<(usize, f32)> {
        let room = |name: &str| text::width(name, LETTER * scale) + (SAMPLE + 24.0) * scale;
        let mut place = (0, text::width(&self.label(), LETTER * scale) + 24.0 * scale);
        let mut places = Vec::new();
        for (_, curve) in self.curves.iter().filter(|_| self.has_legend()) {
            let wide = room(&curve.name);
            if place.1 + wide > width && place.1 > 0.0 {
                place = (place.0 + 1, 0.0);
            }
            places.push(place);
            place.1 += wide;
        }
        places
    }

    /// A single curve is named by its axis, if that says its name.
    fn has_legend(&self) -> bool {
        self.curves.len() > 1 || self.curves[0].1.name != self.curves[0].1.quantity
    }

    /// Height of what stands above the axes.
    pub(super) fn head_height(&self, width: f32, scale: f32) -> f32 {
        let rows = self.entries(width, scale).last().map_or(0, |(row, _)| *row) + 1;
        (rows as f32 * LINE + 14.0) * scale
    }

    /// Smallest and largest value, with some room.
    fn range(&self) -> [f64; 2] {
        let values = self.curves.iter().flat_map(|(_, curve)| curve.points.iter().map(|point| point[1]));
        let finite = values.filter(|value| value.is_finite());
        let [low, high] =
            finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
        if low > high {
            return [0.0, 1.0];
        }
        let flat = high - low <= 1e-9 * high.abs().max(low.abs());
        let room = if flat { (0.1 * high.abs()).max(1e-9) } else { 0.05 * (high - low) };
        [low - room, high + room]
    }

    pub(super) fn draw(&self, paper: &mut dyn Paper, frame: &Frame, times: [f64; 2], last: bool, theme: &Theme) {
        let range = self.range();
        let at = |point: [f64; 2]| {
            let part = |value: f64, [from, to]: [f64; 2]| ((value - from) / (to - from)) as f32;
            let (x, y) = (part(point[0], times), part(point[1], range));
            [frame.left + x * (frame.right - frame.left), frame.bottom - y * (frame.bottom - frame.top)]
        };
        frame.draw_axes(paper, times, range, last, theme, at);
        for (number, curve) in &self.curves {
            draw_curve(paper, curve, color_of(*number, theme), 1.6 * frame.scale, at);
        }
        frame.outline(paper, theme);
        self.draw_head(paper, frame, theme);
    }

    fn draw_head(&self, paper: &mut dyn Paper, frame: &Frame, theme: &Theme) {
        let scale = frame.scale;
        let line = |row: usize| frame.head + (16.0 + LINE * row as f32) * scale;
        let lettering =
            Lettering { height: LETTER * scale, align: Align::Left, color: theme.text, halo: theme.background };
        text::draw(paper, &self.label(), [frame.left, line(0)], lettering);
        let places = self.entries(frame.right - frame.left, scale);
        for ((number, curve), (row, right)) in self.curves.iter().zip(places) {
            let (x, y) = (frame.left + right, line(row));
            let middle = y - 0.5 * LETTER * scale;
            paper.line(&[[x, middle], [x + SAMPLE * scale, middle]], color_of(*number, theme), 2.0 * scale);
            text::draw(paper, &curve.name, [x + (SAMPLE + 7.0) * scale, y], lettering);
        }
    }
}

impl Frame {
    /// Lines of the grid, and the numbers beside it.
    fn draw_axes(
        &self,
        paper: &mut dyn Paper,
        times: [f64; 2],
        range: [f64; 2],
        last: bool,
        theme: &Theme,
        at: impl Fn([f64; 2]) -> [f32; 2],
    ) {
        let (scale, height) = (self.scale, LETTER * self.scale);
        let faint = mix(theme.background, theme.text, 0.14);
        let lettering = |align| Lettering { height, align, color: theme.text, halo: theme.background };
        let step = tick_step(times[1] - times[0], f64::from((self.right - self.left) / (6.0 * height)));
        for time in ticks(times[0], times[1], step) {
            let x = at([time, range[0]])[0];
            paper.line(&[[x, self.top], [x, self.bottom]], faint, scale);
            if last {
                let base = self.bottom + 7.0 * scale + height;
                text::draw(paper, &number(time, step), [x, base], lettering(Align::Center));
            }
        }
        let step = tick_step(range[1] - range[0], f64::from((self.bottom - self.top) / (3.2 * height)));
        for value in ticks(range[0], range[1], step) {
            let y = at([times[0], value])[1];
            paper.line(&[[self.left, y], [self.right, y]], faint, scale);
            let place = [self.left - 7.0 * scale, y + 0.5 * height];
            text::draw(paper, &number(value, step), place, lettering(Align::Right));
        }
        if last {
            let place = [0.5 * (self.left + self.right), self.bottom + 18.0 * scale + 2.0 * height];
            text::draw(paper, "time [s]", place, lettering(Align::Center));
        }
    }

    fn outline(&self, paper: &mut dyn Paper, theme: &Theme) {
        let Frame { left, right, top, bottom, .. } = *self;
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        paper.line(&corners, theme.text, 1.2 * self.scale);
    }
}

fn color_of(number: usize, theme: &Theme) -> Rgb {
    theme.visible(COLORS[number % COLORS.len()])
}

/// Draws the stretches of a curve between its gaps; a single value is a dot.
fn draw_curve(paper: &mut dyn Paper, curve: &Curve, color: Rgb, width: f32, at: impl Fn([f64; 2]) -> [f32; 2]) {
    for stretch in curve.points.split(|point| !point[1].is_finite()) {
        let line: Vec<[f32; 2]> = stretch.iter().map(|point| at(*point)).collect();
        match line[..] {
            [] => {}
            [dot] => paper.disc(dot, width, color, 1.0),
            _ => paper.line(&line, color, width),
        }
    }
}
