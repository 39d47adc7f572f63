//! Arguments of `render`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::SceneChanges;
use super::run::{number, positive, thread_count};
use crate::render::{Background, ColorBy, Range, Style, View};

const AFTER_HELP: &str = "\
Examples:
  unipbd render open_gas.mcap -o plume.gif --width 480
  unipbd render open_gas.mcap -o plume.html                   a page that plays in any browser
  unipbd render open_gas.mcap -o plume.mp4 --speed 0.5        half as fast as it happened
  unipbd render open_gas.mcap -o plume.png --time 1.5         one picture
  unipbd render open_gas.mcap -o pictures/ --every 10         numbered pictures
  unipbd render dam_break.mcap -o dam.gif --color speed       a log recorded with --fields velocity
  unipbd render scenes/dam_break.toml -o dam.gif              run the scene, keep no log

Exit codes: 0 done, 1 input or output, 2 arguments, 3 scene, 4 diverged, 130 Ctrl-C.";

/// Arguments of `render`.
#[derive(Clone, Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct RenderArgs {
    /// A log (.mcap), or a scene (.toml) to run first
    #[arg(value_name = "LOG|SCENE")]
    pub source: PathBuf,
    /// What to write: NAME.png, NAME.svg or NAME.pdf (one picture), NAME_%04d.png or DIRECTORY/ (a picture per frame), NAME.gif, NAME.mp4, NAME.html
    ///
    /// MP4 needs ffmpeg.
    #[arg(short, long, value_name = "PATH")]
    pub output: PathBuf,
    /// Replace an output that exists
    #[arg(long)]
    pub force: bool,
    /// Which frames to draw.
    #[command(flatten)]
    pub frames: FrameArgs,
    /// How pictures look.
    #[command(flatten)]
    pub look: LookArgs,
    /// The program that makes MP4 files
    #[arg(long, value_name = "PROGRAM", help_heading = "Running", default_value = "ffmpeg")]
    pub ffmpeg: PathBuf,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: SceneChanges,
    /// Threads to run a scene with [default: all]; never changes results
    #[arg(long, value_name = "N", help_heading = "Running", allow_negative_numbers = true, value_parser = thread_count)]
    pub threads: Option<usize>,
}

/// Which frames to draw.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Frames")]
pub struct FrameArgs {
    /// One picture of the frame nearest to this simulated time [s]; left out, of the last frame
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["from", "to", "every"], allow_negative_numbers = true, value_parser = finite)]
    pub time: Option<f64>,
    /// No frame before this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = finite)]
    pub from: Option<f64>,
    /// No frame after this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = finite)]
    pub to: Option<f64>,
    /// One frame of N; left out, all, or as many as a film needs
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: Option<u64>,
    /// Simulated seconds shown in a second of a film
    #[arg(long, value_name = "FACTOR", default_value = "1", allow_negative_numbers = true, value_parser = positive)]
    pub speed: f64,
}

/// How pictures look.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// What colours show: density and temperature need a log recorded with these --fields, speed is taken from
    /// positions where the log has no velocity
    #[arg(long, value_name = "QUANTITY", default_value = "material", value_parser = color_by())]
    pub color: ColorBy,
    /// Ends of the colour map, MIN..MAX, in the unit of the colour bar: m/s, or % for density
    #[arg(long, value_name = "MIN..MAX", allow_hyphen_values = true, value_parser = range)]
    pub range: Option<Range>,
    /// Width of pictures [pixels]
    #[arg(long, value_name = "PIXELS", default_value = "960", value_parser = clap::value_parser!(u32).range(16..=16384))]
    pub width: u32,
    /// Region to show [m], lower left and upper right corner: X0,Y0,X1,Y1
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = view)]
    pub view: Option<View>,
    /// How liquids and other carriers are drawn
    #[arg(long, default_value = "surface", value_parser = style())]
    pub style: Style,
    /// Ground colour
    #[arg(long, default_value = "dark", value_parser = background())]
    pub background: Background,
    /// Leave out the simulated time
    #[arg(long)]
    pub no_time_stamp: bool,
    /// Draw axes in metres
    #[arg(long)]
    pub axes: bool,
    /// Draw a bar of a round length
    #[arg(long)]
    pub scale_bar: bool,
    /// Name the materials and bodies
    #[arg(long)]
    pub legend: bool,
}

fn color_by() -> impl TypedValueParser<Value = ColorBy> {
    let names = PossibleValuesParser::new(ColorBy::ALL.map(ColorBy::name));
    names.map(|name| ColorBy::ALL.into_iter().find(|by| by.name() == name).unwrap_or_default())
}

fn style() -> impl TypedValueParser<Value = Style> {
    let names = PossibleValuesParser::new(["surface", "discs"]);
    names.map(|name| if name == "discs" { Style::Discs } else { Style::Surface })
}

pub(super) fn background() -> impl TypedValueParser<Value = Background> {
    let names = PossibleValuesParser::new(["dark", "light"]);
    names.map(|name| if name == "light" { Background::Light } else { Background::Dark })
}

pub(super) fn finite(text: &str) -> Result<f64, String> {
    number(text).ok_or_else(|| "expected a number".into())
}

fn range(text: &str) -> Result<Range, String> {
    let ends = text.split_once("..").and_then(|(min, max)| Some((number(min)?, number(max)?)));
    match ends {
        Some((min, max)) if min < max => Ok(Range::Fixed { min, max }),
        _ => Err("expected a smaller and a larger number, such as 0..3".into()),
    }
}

fn view(text: &str) -> Result<View, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(View { min: [x0, y0], max: [x1, y1] }),
        _ => Err("expected the lower left and the upper right corner, such as -1,0,1,3".into()),
    }
}
