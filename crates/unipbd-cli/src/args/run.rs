//! Arguments of `run`, and the changes to a scene that other commands share.

use std::path::PathBuf;

use clap::Args;

use unipbd_core::scene::{FRAME_RATES, LONGEST_DURATION};

use super::StopCondition;
use crate::exit::Failure;
use crate::record::Fields;
use crate::scene_file::{InvalidOverride, Override};

const AFTER_HELP: &str = "\
Examples:
  unipbd run scenes/dam_break.toml
  unipbd run scenes/open_gas.toml --threads 4 --duration 2 -o short.mcap --force
  unipbd run my_scene.toml --set liquid.0.xsph=0.02 --set solver.substeps=16
  unipbd run my_scene.toml --stop-on \"density_error>0.05\" --stop-on \"time>1.5\"
  unipbd run scenes/water_wheel.toml --live

Exit codes: 0 done, 1 input or output, 2 arguments, 3 scene, 4 diverged, 5 --stop-on met or
--expect not held, 129 terminal closed, 130 Ctrl-C, 141 closed pipe, 143 SIGTERM.";

/// Changes to a scene.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Changes to the scene")]
pub struct SceneChanges {
    /// Set a key of the scene, as if the file said so; may be repeated
    ///
    /// The value is TOML (a bare word is a string); a table of an array is named by its number, from
    /// 0, or its name: --set spacing=0.05, --set "gravity=[0,-1.62]", --set emitter.0.speed=2,
    /// --set gas.air.drag=10
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<Override>,
    /// Simulated time [s], instead of that of the scene
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = duration)]
    pub duration: Option<f64>,
    /// Output frames per simulated second [1/s], instead of that of the scene
    #[arg(long, value_name = "RATE", allow_negative_numbers = true, value_parser = rate)]
    pub fps: Option<f64>,
    /// Seed of every random choice, instead of that of the scene
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = seed)]
    pub seed: Option<u64>,
}

impl SceneChanges {
    /// All of them, in the order in which they apply.
    pub fn all(&self) -> Result<Vec<Override>, InvalidOverride> {
        let mut overrides = self.overrides.clone();
        for (key, value) in [("duration", self.duration), ("fps", self.fps)] {
            if let Some(value) = value {
                overrides.push(Override::new(key, format_args!("{value:?}"))?);
            }
        }
        if let Some(seed) = self.seed {
            overrides.push(Override::new("seed", seed)?);
        }
        Ok(overrides)
    }

    /// A log cannot be changed.
    pub fn refuse_for_log(&self) -> Result<(), Failure> {
        let given = !self.overrides.is_empty() || self.duration.is_some() || self.fps.is_some() || self.seed.is_some();
        if given {
            Err(Failure::usage("--set, --duration, --fps and --seed change a scene, not a log"))
        } else {
            Ok(())
        }
    }
}

/// Arguments of `run`.
#[derive(Clone, Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct RunArgs {
    /// The scene file (.toml)
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Changes to the scene.
    #[command(flatten)]
    pub changes: SceneChanges,
    /// Threads to use [default: all]; never changes results
    #[arg(long, value_name = "N", help_heading = "Running", allow_negative_numbers = true, value_parser = thread_count)]
    pub threads: Option<usize>,
    /// Stop after the first frame in which this holds, with exit code 5; may be repeated
    ///
    /// A quantity, < or >, and a number: density_error (largest, as a fraction), speed (largest)
    /// [m/s], energy (kinetic and potential) [J], time [s], particles, the count of a phase
    /// (liquid, gas, smoke, rigid, solid), or any number of the diagnostics by its name, such as
    /// density_error_mean, pressure_max, momentum_x, substeps (docs/diagnostics.md lists them), or gauge.NAME for a
    /// gauge of the scene. Quote it: < and >
    /// mean something to a shell.
    #[arg(long, value_name = "CONDITION", help_heading = "Running")]
    pub stop_on: Vec<StopCondition>,
    /// Compare the run with the [expect] table of the scene: exit code 5 where it does not hold
    #[arg(long, help_heading = "Running")]
    pub expect: bool,
    /// The log and what goes into it.
    #[command(flatten)]
    pub log: LogArgs,
    /// Viewers that watch.
    #[cfg(feature = "live")]
    #[command(flatten)]
    pub live: super::live::LiveArgs,
}

/// The log of a run.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Log")]
pub struct LogArgs {
    /// The log to write, - for standard output [default: the name of the scene with .mcap, in the current directory]
    ///
    /// The default log replaces an older one when it is complete; a path given here must be new
    /// unless --force is given.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Replace the file given with -o if it exists
    #[arg(long)]
    pub force: bool,
    /// Columns to record besides position, id, phase and material: a list such as velocity,density
    ///
    /// velocity [m/s], density (its error C = rho/rho0 - 1, as a fraction), temperature, or all three.
    /// Each makes the log larger: velocity about doubles it. samples: the samples of bodies as the topic
    /// /bodies/samples.
    #[arg(long, value_name = "FIELDS", default_value = "", hide_default_value = true)]
    pub fields: Fields,
    /// Write a layout of Lichtblick and Foxglove that frames the scene
    ///
    /// With --live it is there from the start, framing the first frame. A layout that unipbd wrote is replaced, another
    /// file with --force alone.
    #[arg(long, value_name = "FILE", conflicts_with = "no_record")]
    pub layout: Option<PathBuf>,
    /// Write no log
    ///
    /// With -q too, and neither --json nor --stop-on, the frames are not measured either: the quickest run.
    #[arg(long, conflicts_with_all = ["output", "force", "fields"])]
    pub no_record: bool,
}

pub(super) fn thread_count(text: &str) -> Result<usize, String> {
    unipbd_core::step::thread_count(text)
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text).filter(|value| *value > 0.0).ok_or_else(|| "expected a positive number".into())
}

fn duration(text: &str) -> Result<f64, String> {
    let value = positive(text)?;
    if value > LONGEST_DURATION { Err(format!("expected at most {LONGEST_DURATION} s")) } else { Ok(value) }
}

fn rate(text: &str) -> Result<f64, String> {
    let (least, most) = FRAME_RATES;
    let value = positive(text)?;
    let fits = (least..=most).contains(&value);
    if fits { Ok(value) } else { Err(format!("expected a number from {least} to {most}")) }
}

fn seed(text: &str) -> Result<u64, String> {
    let seed = text.trim().parse().ok().filter(|seed| *seed <= i64::MAX as u64);
    seed.ok_or_else(|| format!("expected a whole number from 0 to {}", i64::MAX))
}

pub(super) fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite())
}
