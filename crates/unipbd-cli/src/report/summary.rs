//! The summary at the end of a run: the last JSON line, or a few lines for people.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Duration;

use serde::Serialize;
use unipbd_core::Solver;
use unipbd_core::observe::Diagnostics;
use unipbd_core::phase::Phase;

use super::format::{bytes, count, duration, percent, plural};
use super::json::ByPhase;
use super::progress::significant;
use super::{Outcome, Statistics, Verbosity};

/// A finished log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFile {
    /// Where it lies.
    pub path: PathBuf,
    /// Its size [B].
    pub bytes: u64,
    /// A layout of viewers for it.
    pub layout: Option<PathBuf>,
}

impl LogFile {
    /// Whether the log went to standard output.
    pub fn is_standard_output(&self) -> bool {
        self.path.as_os_str() == "-"
    }
}

/// Everything worth knowing at the end of a run.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Title of the scene.
    pub scene: String,
    /// How it ended.
    pub outcome: Outcome,
    /// Figures of all frames.
    pub statistics: Statistics,
    /// The last state.
    pub last: Diagnostics,
    /// Hash of the last state.
    pub state_hash: u64,
    /// Memory held by the solver [B].
    pub memory_bytes: usize,
    /// Wall-clock time of the whole run.
    pub wall_time: Duration,
    /// Wall-clock time per stage.
    pub timings: Vec<(&'static str, Duration)>,
    /// The log, where one was written.
    pub log: Option<LogFile>,
}

impl Summary {
    /// Takes stock of a run that has ended.
    pub fn new(
        scene: String,
        outcome: Outcome,
        statistics: Statistics,
        solver: &Solver,
        last: Diagnostics,
        log: Option<LogFile>,
    ) -> Self {
        Summary {
            scene,
            outcome,
            last,
            state_hash: solver.state_hash(),
            memory_bytes: solver.memory_bytes(),
            wall_time: statistics.wall_time(),
            timings: solver.timings().to_vec(),
            statistics,
            log,
        }
    }

    /// Simulated seconds per second of wall-clock time.
    pub fn speed(&self) -> f64 {
        self.last.time / self.wall_time.as_secs_f64().max(1e-9)
    }

    /// The summary as an object for JSON.
    pub fn line(&self) -> SummaryLine<'_> {
        let statistics = &self.statistics;
        SummaryLine {
            kind: "summary",
            scene: &self.scene,
            outcome: self.outcome.word(),
            message: self.outcome.message(),
            time: self.last.time,
            frames: statistics.frames,
            steps: self.last.step,
            substeps: SubstepsLine {
                min: statistics.substeps_min,
                mean: statistics.substeps_mean(),
                max: statistics.substeps_max,
            },
            list_builds: statistics.list_builds,
            state_hash: format!("{:016x}", self.state_hash),
            particles: self.last.particles(),
            particles_peak: statistics.peak_particles,
            counts: ByPhase(self.last.counts),
            counts_peak: ByPhase(statistics.peak_by_phase),
            emitted: statistics.emitted,
            removed: statistics.removed,
            density_error_mean: statistics.density_error_mean(),
            density_error_max: statistics.density_error_max,
            density_error_mean_last: self.last.density_error_mean,
            density_error_max_last: self.last.density_error_max,
            speed_max: statistics.speed_max,
            speed_max_last: self.last.speed_max,
            warnings: statistics.warnings,
            wall_time: self.wall_time.as_secs_f64(),
            simulated_per_wall: self.speed(),
            memory_bytes: self.memory_bytes,
            timings: self.timings.iter().map(|(stage, time)| (*stage, time.as_secs_f64())).collect(),
            log: self.log.as_ref().map(LogLine::from),
        }
    }

    /// The summary for people.
    pub fn text(&self, verbosity: Verbosity) -> String {
        let statistics = &self.statistics;
        let mut text = String::new();
        let _ = writeln!(text, "{}", self.headline());
        let _ = writeln!(text, "  particles      {}", self.particles());
        let _ = writeln!(
            text,
            "  substeps       {} a frame on average ({} to {}), {} in all",
            significant(statistics.substeps_mean()),
            statistics.substeps_min,
            statistics.substeps_max,
            count(self.last.step),
        );
        let _ = writeln!(
            text,
            "  density error  {} mean, {} worst (at {:.2} s)",
            percent(statistics.density_error_mean()),
            percent(statistics.density_error_max),
            statistics.density_error_max_time,
        );
        let _ = writeln!(
            text,
            "  wall time      {} ({}x real time), {} of memory",
            duration(self.wall_time),
            significant(self.speed()),
            bytes(self.memory_bytes as u64),
        );
        let _ = writeln!(text, "  state hash     {:016x}", self.state_hash);
        if verbosity == Verbosity::Verbose {
            self.add_timings(&mut text);
        }
        match &self.log {
            Some(log) => {
                let path = log.path.display();
                let _ = writeln!(text, "  log            {path} ({})", bytes(log.bytes));
                let page = beside(log, "html");
                let _ = writeln!(text, "  see it         unipbd render {path} -o {page}");
                let layout = match &log.layout {
                    Some(layout) => layout.display().to_string(),
                    None => format!("unipbd layout {path} -o {}", beside(log, "json")),
                };
                let _ = write!(text, "  in viewers     rerun {path}; Lichtblick, layout: {layout}");
            }
            None => text.truncate(text.trim_end().len()),
        }
        text
    }

    fn headline(&self) -> String {
        let name = if self.scene.is_empty() { "The scene" } else { &self.scene };
        let ending = match &self.outcome {
            Outcome::Completed => "done",
            Outcome::Diverged { .. } => "diverged",
            Outcome::ConditionMet { .. } => "stopped",
            Outcome::Interrupted => "interrupted",
        };
        format!("{name}: {ending} at {:.2} s, {}", self.last.time, plural(self.statistics.frames, "frame"))
    }

    fn particles(&self) -> String {
        let mut parts = Vec::new();
        for (phase, (now, peak)) in
            Phase::ALL.into_iter().zip(self.last.counts.into_iter().zip(self.statistics.peak_by_phase))
        {
            match (now, peak) {
                (_, 0) => {}
                (now, peak) if now == peak => parts.push(format!("{} {}", count(now), phase.name())),
                (now, peak) => parts.push(format!("{} {} (peak {})", count(now), phase.name(), count(peak))),
            }
        }
        if parts.is_empty() { "none".into() } else { parts.join(", ") }
    }

    fn add_timings(&self, text: &mut String) {
        let total: Duration = self.timings.iter().map(|(_, time)| *time).sum();
        for (stage, time) in &self.timings {
            let share = 100.0 * time.as_secs_f64() / total.as_secs_f64().max(1e-9);
            let _ = writeln!(text, "    {stage:<20} {:>10}  {share:5.1} %", duration(*time));
        }
    }
}

/// The name of a log with another ending.
fn beside(log: &LogFile, extension: &str) -> String {
    let name = log.path.with_extension(extension);
    name.file_name().map_or("pictures".into(), |name| name.to_string_lossy().into_owned())
}

/// The last line of `run --json`.
#[derive(Debug, Serialize)]
pub struct SummaryLine<'a> {
    #[serde(rename = "type")]
    kind: &'static str,
    scene: &'a str,
    outcome: &'static str,
    message: Option<&'a str>,
    time: f64,
    frames: u64,
    steps: u64,
    substeps: SubstepsLine,
    list_builds: u64,
    state_hash: String,
    particles: u64,
    particles_peak: u64,
    counts: ByPhase,
    counts_peak: ByPhase,
    emitted: u64,
    removed: u64,
    density_error_mean: f64,
    density_error_max: f64,
    density_error_mean_last: f64,
    density_error_max_last: f64,
    speed_max: f64,
    speed_max_last: f64,
    warnings: u64,
    wall_time: f64,
    simulated_per_wall: f64,
    memory_bytes: usize,
    timings: std::collections::BTreeMap<&'static str, f64>,
    log: Option<LogLine>,
}

#[derive(Debug, Serialize)]
struct SubstepsLine {
    min: u32,
    mean: f64,
    max: u32,
}

#[derive(Debug, Serialize)]
struct LogLine {
    path: String,
    bytes: u64,
    layout: Option<String>,
}

impl From<&LogFile> for LogLine {
    fn from(log: &LogFile) -> Self {
        let shown = |path: &PathBuf| path.display().to_string();
        LogLine { path: shown(&log.path), bytes: log.bytes, layout: log.layout.as_ref().map(shown) }
    }
}
