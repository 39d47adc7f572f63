//! Arguments of the commands that read a log: `recover`, `export`, `layout`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const RECOVER_HELP: &str = "\
Examples:
  unipbd recover dam_break.mcap                        complete the log of a run that was killed
  unipbd recover .dam_break.mcap.partial -o dam.mcap   the same into a new file

A frame that was not written whole is left out. Without -o a log is replaced only when all else of it was read.";

/// Arguments of `recover`.
#[derive(Clone, Debug, Args)]
#[command(after_help = RECOVER_HELP)]
pub struct RecoverArgs {
    /// A log (.mcap) that was cut off
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// The log to write [default: the log itself]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Replace the file given with -o if it exists
    #[arg(long)]
    pub force: bool,
}

const EXPORT_HELP: &str = "\
Examples:
  unipbd export dam_break.mcap -o dam_break.npz             NumPy: arrays of all frames
  unipbd export dam_break.mcap -o tables/ --format csv      pandas: particles.csv, bodies.csv, diagnostics.csv
  unipbd export dam_break.mcap -o columns/ --format parquet   the same as Parquet, for large runs
  unipbd export dam_break.mcap -o paraview/ --format vtk    ParaView: open particles.pvd and bodies.pvd
  unipbd export dam_break.mcap -o late.npz --from 1.5 --every 10";

/// Arguments of `export`.
#[derive(Clone, Debug, Args)]
#[command(after_help = EXPORT_HELP)]
pub struct ExportArgs {
    /// A log (.mcap)
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// What to write: NAME.npz, or the folder of the other formats
    #[arg(short, long, value_name = "PATH")]
    pub output: PathBuf,
    /// The format; left out, npz for a name that ends in .npz
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<ExportFormat>,
    /// Replace files that exist
    #[arg(long)]
    pub force: bool,
    /// No frame before this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = super::render::finite)]
    pub from: Option<f64>,
    /// No frame after this simulated time [s]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = super::render::finite)]
    pub to: Option<f64>,
    /// One frame of N
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: u64,
}

/// Formats of `export`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// Tables of text, one row per particle and frame
    Csv,
    /// The same tables as Apache Parquet: typed and compressed, for pandas, Polars, DuckDB
    #[cfg(feature = "parquet")]
    Parquet,
    /// Arrays of NumPy in one file
    Npz,
    /// VTK XML PolyData, one file per frame
    Vtk,
}

const LAYOUT_HELP: &str = "\
Example:
  unipbd layout dam_break.mcap -o dam_break_layout.json
then in Lichtblick or Foxglove: Layouts, Import from file.";

/// Arguments of `layout`.
#[derive(Clone, Debug, Args)]
#[command(after_help = LAYOUT_HELP)]
pub struct LayoutArgs {
    /// A log (.mcap)
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// The layout to write [default: standard output]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Replace the file given with -o if it exists
    #[arg(long)]
    pub force: bool,
}
