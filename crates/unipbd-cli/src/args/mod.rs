//! The arguments of the command line.
// The command prints these texts as they are, with units such as [s].
#![allow(rustdoc::broken_intra_doc_links)]

mod bench;
mod dispatch;
#[cfg(feature = "live")]
mod live;
mod logs;
mod plot;
mod render;
mod run;
mod stop_on;

use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;

pub use bench::BenchArgs;
pub use dispatch::{is_log, log_is_no_scene, with_default_command};
pub use logs::{ExportArgs, ExportFormat, LayoutArgs, RecoverArgs};
pub use plot::PlotArgs;
pub use render::{LookArgs, RenderArgs};
pub use run::{LogArgs, RunArgs, SceneChanges};
pub use stop_on::StopCondition;

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

const AFTER_HELP: &str = "\
Exit codes:
    0  done
    1  a file could not be read or written, or does not exist
    2  wrong arguments, or an output that exists and --force was not given
    3  the scene file has errors
    4  the simulation diverged (the log up to there is kept)
    5  a --stop-on condition was met, or an expectation of a scene does not hold
  129  the terminal was closed (SIGHUP)
  130  interrupted by Ctrl-C (the frame is finished and the log closed; press twice to quit at once)
  141  the reader of standard output closed it, as head does (SIGPIPE)
  143  asked to end by SIGTERM, as by kill

Environment:
  UNIPBD_THREADS  number of threads where --threads is not given
  UNIPBD_SIMD     instruction set: scalar, sse2, avx2, avx512, portable (other processors) [default: the fastest]; never changes results
  NO_COLOR        no colours in messages

Examples:
  unipbd scenes/open_gas.toml                      run a scene, record open_gas.mcap
  unipbd check my_scene.toml                       find mistakes, estimate the cost
  unipbd run my_scene.toml --set spacing=0.05      run with another particle distance [m]
  unipbd bench my_scene.toml --threads 1,2         time a scene
  unipbd render open_gas.mcap -o plume.gif         make an animation of a log
  unipbd export open_gas.mcap -o plume.npz         arrays for NumPy
  unipbd plot open_gas.mcap --gauge energy         a number of the log over time, as open_gas.svg
  unipbd run my_scene.toml --json --no-record | jq .density_error_max";

/// Run, inspect and draw 2D particle scenes: liquids, gas, smoke and rigid bodies.
///
/// `unipbd SCENE.toml` is short for `unipbd run SCENE.toml`. The Python package adds `unipbd dataset`
/// and `unipbd sweep`. Data goes to standard output, messages
/// and progress to standard error.
#[derive(Debug, Parser)]
#[command(name = "unipbd", version, styles = STYLES, after_help = AFTER_HELP, max_term_width = 110)]
#[command(arg_required_else_help = true, infer_subcommands = false)]
pub struct Arguments {
    /// How much is printed, and in which form.
    #[command(flatten)]
    pub output: OutputArgs,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// How much is printed, and in which form.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Output")]
pub struct OutputArgs {
    /// Print errors only: no progress, no warnings, no summary (--json lines stay)
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print more: settings at the start, the wall-clock time of each stage at the end
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Print data as JSON, one object a line, on standard output
    #[arg(long, global = true)]
    pub json: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene and record it to a log
    Run(RunArgs),
    /// Check a scene for mistakes and estimate its cost
    #[command(
        after_help = "Examples:\n  unipbd check scenes/dam_break.toml\n  unipbd check my_scene.toml --set spacing=0.01 --json"
    )]
    Check(CheckArgs),
    /// Run scenes and compare them with their [expect] tables
    #[command(after_help = EXPECT_HELP)]
    Expect(ExpectArgs),
    /// Summarise a scene or a log
    #[command(after_help = "Examples:\n  unipbd info scenes/open_gas.toml\n  unipbd info open_gas.mcap --json")]
    Info(InfoArgs),
    /// Draw a log (or a scene, which is run first) as pictures, a film or a page that plays
    Render(RenderArgs),
    /// Plot gauges and other numbers of a log over time
    Plot(PlotArgs),
    /// Write a log as tables (CSV, Parquet), NumPy arrays or VTK files
    Export(ExportArgs),
    /// Complete the log of a run that was killed
    Recover(RecoverArgs),
    /// Print a layout of Lichtblick and Foxglove that frames a log
    Layout(LayoutArgs),
    /// Time a scene, by stage and number of threads
    Bench(BenchArgs),
    /// Print the JSON schema of scene files, for completion and checking in editors
    #[command(after_help = "Example:\n  unipbd schema > scene.schema.json")]
    Schema,
    /// Print the completions of this command for a shell
    #[command(after_help = COMPLETIONS_HELP)]
    Completions(CompletionsArgs),
    /// Print the manual page, or write one page per command into a folder
    #[command(after_help = MAN_HELP)]
    Man(ManArgs),
}

const COMPLETIONS_HELP: &str = "\
Examples:
  unipbd completions bash > ~/.local/share/bash-completion/completions/unipbd
  unipbd completions zsh > ~/.zfunc/_unipbd             where ~/.zfunc is in $fpath
  unipbd completions fish > ~/.config/fish/completions/unipbd.fish";

const MAN_HELP: &str = "\
Examples:
  unipbd man | man -l -
  unipbd man --directory ~/.local/share/man/man1";

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Arguments of `man`.
#[derive(Debug, Args)]
pub struct ManArgs {
    /// Write unipbd.1 and a page for each command into this folder
    #[arg(long, value_name = "PATH")]
    pub directory: Option<PathBuf>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The scene file (.toml)
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: SceneChanges,
    /// Threads of the run that is estimated [default: all]
    #[arg(long, value_name = "N", help_heading = "Running", allow_negative_numbers = true, value_parser = run::thread_count)]
    pub threads: Option<usize>,
}

const EXPECT_HELP: &str = "\
Examples:
  unipbd expect scenes/*.toml
  unipbd expect scenes/dam_break.toml --set solver.substeps=16

Exit code 5 when a scene does not do what its [expect] table says; every line that does not hold is named.";

/// Arguments of `expect`.
#[derive(Debug, Args)]
pub struct ExpectArgs {
    /// The scene files (.toml)
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,
    /// Changes to each scene.
    #[command(flatten)]
    pub changes: SceneChanges,
    /// Threads to use [default: all]; never changes results
    #[arg(long, value_name = "N", help_heading = "Running", allow_negative_numbers = true, value_parser = run::thread_count)]
    pub threads: Option<usize>,
}

/// Arguments of `info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// A scene (.toml) or a log (.mcap)
    #[arg(value_name = "SCENE|LOG")]
    pub path: PathBuf,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: SceneChanges,
}
