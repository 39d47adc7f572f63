//! Arguments of `plot`.

use std::path::PathBuf;

use clap::Args;

use crate::render::Background;

const AFTER_HELP: &str = "\
Examples:
  unipbd plot sloshing.mcap                                   all gauges of the scene, as sloshing.svg
  unipbd plot sloshing.mcap -o level.pdf --gauge left --gauge right
  unipbd plot dam_break.mcap -o energy.png --gauge kinetic_energy --gauge potential_energy

Curves of one unit share a panel. Where a gauge has nothing to read, its line has a gap.";

/// Arguments of `plot`.
#[derive(Clone, Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct PlotArgs {
    /// A log (.mcap)
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// What to write: NAME.svg, NAME.pdf or NAME.png [default: the name of the log with .svg, in the current directory]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// What to plot: a gauge of the scene, or a number of the diagnostics such as energy or density_error_max; may be
    /// repeated; left out, all gauges
    #[arg(long = "gauge", value_name = "NAME")]
    pub gauges: Vec<String>,
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
    /// No frame before this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = super::render::finite)]
    pub from: Option<f64>,
    /// No frame after this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = super::render::finite)]
    pub to: Option<f64>,
    /// Width of the plot [pixels]
    #[arg(long, value_name = "PIXELS", default_value = "640", value_parser = clap::value_parser!(u32).range(200..=8192))]
    pub width: u32,
    /// Ground colour
    #[arg(long, default_value = "light", value_parser = super::render::background())]
    pub background: Background,
}
