//! Figures of a whole run, gathered frame by frame.

use std::time::{Duration, Instant};

use unipbd_core::observe::{Diagnostics, Event, Severity};
use unipbd_core::phase::Phase;
use unipbd_core::step::FrameReport;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It reached its duration.
    Completed,
    /// The solver gave up.
    Diverged {
        /// Where and why.
        message: String,
    },
    /// A `--stop-on` condition was met.
    ConditionMet {
        /// The condition and the value that met it.
        message: String,
    },
    /// Ctrl-C.
    Interrupted,
}

impl Outcome {
    /// The word used in the JSON summary.
    pub fn word(&self) -> &'static str {
        match self {
            Outcome::Completed => "completed",
            Outcome::Diverged { .. } => "diverged",
            Outcome::ConditionMet { .. } => "condition_met",
            Outcome::Interrupted => "interrupted",
        }
    }

    /// The message about the outcome, if there is one.
    pub fn message(&self) -> Option<&str> {
        match self {
            Outcome::Diverged { message } | Outcome::ConditionMet { message } => Some(message),
            Outcome::Completed | Outcome::Interrupted => None,
        }
    }
}

/// Figures of a whole run.
#[derive(Clone, Debug)]
pub struct Statistics {
    started: Instant,
    /// Frames done.
    pub frames: u64,
    /// Fewest substeps of a frame.
    pub substeps_min: u32,
    /// Most substeps of a frame.
    pub substeps_max: u32,
    /// Substeps of all frames.
    pub substeps: u64,
    /// Neighbour lists built in all frames.
    pub list_builds: u64,
    /// Particles added by emitters.
    pub emitted: u64,
    /// Particles removed.
    pub removed: u64,
    /// Most particles of each phase at the end of a frame, in the order of [`Phase::ALL`].
    pub peak_by_phase: [u64; Phase::ALL.len()],
    /// Most particles at the end of a frame.
    pub peak_particles: u64,
    /// Largest density error of all frames, as a fraction.
    pub density_error_max: f64,
    /// Simulated time of the largest density error \[s].
    pub density_error_max_time: f64,
    /// Largest speed of all frames [m/s].
    pub speed_max: f64,
    /// Warnings given.
    pub warnings: u64,
    density_error_sum: f64,
    samples: u64,
}

impl Statistics {
    /// Starts the clock.
    pub fn start() -> Self {
        Statistics {
            started: Instant::now(),
            frames: 0,
            substeps_min: 0,
            substeps_max: 0,
            substeps: 0,
            list_builds: 0,
            emitted: 0,
            removed: 0,
            peak_by_phase: [0; Phase::ALL.len()],
            peak_particles: 0,
            density_error_max: 0.0,
            density_error_max_time: 0.0,
            speed_max: 0.0,
            warnings: 0,
            density_error_sum: 0.0,
            samples: 0,
        }
    }

    /// Takes in what a frame did.
    pub fn add_frame(&mut self, report: &FrameReport) {
        self.substeps_min = if self.frames == 0 { report.substeps } else { self.substeps_min.min(report.substeps) };
        self.substeps_max = self.substeps_max.max(report.substeps);
        self.substeps += u64::from(report.substeps);
        self.list_builds += u64::from(report.list_builds);
        self.emitted += report.emitted;
        self.removed += report.removed;
        self.frames += 1;
    }

    /// Takes in the state at the start or after a frame.
    pub fn add_state(&mut self, diagnostics: &Diagnostics) {
        for (peak, count) in self.peak_by_phase.iter_mut().zip(diagnostics.counts) {
            *peak = (*peak).max(count);
        }
        self.peak_particles = self.peak_particles.max(diagnostics.particles());
        if diagnostics.density_error_max > self.density_error_max {
            self.density_error_max = diagnostics.density_error_max;
            self.density_error_max_time = diagnostics.time;
        }
        self.speed_max = self.speed_max.max(diagnostics.speed_max);
        self.density_error_sum += diagnostics.density_error_mean;
        self.samples += 1;
    }

    /// Takes in what happened.
    pub fn add_events(&mut self, events: &[Event]) {
        self.warnings += events.iter().filter(|event| event.severity == Severity::Warning).count() as u64;
    }

    /// Density error averaged over particles and frames, as a fraction.
    pub fn density_error_mean(&self) -> f64 {
        self.density_error_sum / self.samples.max(1) as f64
    }

    /// Substeps of a frame, on average.
    pub fn substeps_mean(&self) -> f64 {
        self.substeps as f64 / self.frames.max(1) as f64
    }

    /// Wall-clock time since the start.
    pub fn wall_time(&self) -> Duration {
        self.started.elapsed()
    }
}
