//! Description of a case, and its outcome.

use unipbd_core::scene::{LegacySettings, PressureGridUse, Scene, SolverSettings};

use crate::runner::{Cost, Failure, Runner};

/// Where a figure must lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Smallest good value.
    pub low: f64,
    /// Largest good value.
    pub high: f64,
}

impl Band {
    /// Up to this size, either sign.
    pub const fn within(size: f64) -> Band {
        Band { low: -size, high: size }
    }

    /// From `low` to `high`.
    pub const fn between(low: f64, high: f64) -> Band {
        Band { low, high }
    }

    /// Anything: the figure is reported only.
    pub const OPEN: Band = Band { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Whether the band asks for anything.
    pub fn is_open(self) -> bool {
        self.low == f64::NEG_INFINITY && self.high == f64::INFINITY
    }

    /// Whether a value lies in it; a value that is not finite never does.
    pub fn holds(self, value: f64) -> bool {
        value.is_finite() && self.low <= value && value <= self.high
    }
}

impl std::fmt::Display for Band {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_open() {
            write!(f, "reported")
        } else if self.low == -self.high {
            write!(f, "±{}", self.high)
        } else if self.low == f64::NEG_INFINITY {
            write!(f, "≤ {}", self.high)
        } else {
            write!(f, "{} to {}", self.low, self.high)
        }
    }
}

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Description of the figure, with its unit.
    pub what: &'static str,
    /// The value.
    pub value: f64,
    /// Where it must lie.
    pub band: Band,
}

impl Figure {
    /// A figure with its band.
    pub const fn new(what: &'static str, value: f64, band: Band) -> Figure {
        Figure { what, value, band }
    }

    /// Whether it lies in its band.
    pub fn holds(&self) -> bool {
        self.band.is_open() || self.band.holds(self.value)
    }
}

/// The step settings of most full runs: how much compression `auto` may allow.
pub const TARGETS: &[f64] = &[0.04, 0.01, 0.0025];

/// How a case is to be run.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Particles along the length of the case.
    pub resolution: u32,
    /// How the constraints are solved.
    pub solver: SolverSettings,
    /// Options that are there for comparison.
    pub legacy: LegacySettings,
    /// Most frames of a stretch: no limit for figures, one to see that a case can be built.
    pub frames: u32,
}

impl Trial {
    /// This case size with these settings.
    pub fn new(resolution: u32, solver: SolverSettings) -> Trial {
        Trial { resolution, solver, legacy: LegacySettings::default(), frames: u32::MAX }
    }

    /// Builds a scene of the case on one thread.
    ///
    /// # Errors
    /// When the scene is refused.
    pub fn start(&self, scene: &Scene) -> Result<Runner, Failure> {
        let mut runner = Runner::new(scene)?;
        runner.most = self.frames;
        Ok(runner)
    }

    /// A band that is meant for the pressure grid; without it the figure is reported only.
    pub fn with_grid(&self, band: Band) -> Band {
        if self.solver.pressure_grid == PressureGridUse::Off { Band::OPEN } else { band }
    }

    /// A band that is meant for this target compression, or a lower one; above it the figure is reported only.
    pub fn from_target(&self, target: f64, band: Band) -> Band {
        if self.solver.target_compression <= target { band } else { Band::OPEN }
    }
}

/// Outcome of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name of the case.
    pub case: &'static str,
    /// Particles along its length.
    pub resolution: u32,
    /// The figures; the first is the error norm of the case.
    pub figures: Vec<Figure>,
    /// Cost of the run.
    pub cost: Cost,
}

impl Outcome {
    /// The value of this figure.
    pub fn figure(&self, what: &str) -> Option<f64> {
        self.figures.iter().find(|figure| figure.what == what).map(|figure| figure.value)
    }

    /// Figures outside their bands.
    pub fn missed(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|figure| !figure.holds())
    }
}

/// A case of the suite.
#[derive(Clone, Copy)]
pub struct Case {
    /// Short name, for the command line and the table.
    pub name: &'static str,
    /// Known facts about it, with their source.
    pub truth: &'static str,
    /// Resolution of the quick run.
    pub quick: u32,
    /// Resolutions of the full run.
    pub full: &'static [u32],
    /// Target compressions of the full run.
    pub targets: &'static [f64],
    /// Runs it.
    pub run: fn(&Trial) -> Result<Measured, Failure>,
}

/// Figures of a run and its cost.
pub type Measured = (Vec<Figure>, Cost);

impl Case {
    /// Runs the case.
    ///
    /// # Errors
    /// When the scene is refused or the run diverges.
    pub fn run(&self, resolution: u32, solver: &SolverSettings) -> Result<Outcome, Failure> {
        self.run_trial(&Trial::new(resolution, solver.clone()))
    }

    /// Builds the scenes of the case and runs a frame of every stretch: its figures mean nothing.
    ///
    /// # Errors
    /// When a scene is refused or its first frames diverge.
    pub fn build(&self, resolution: u32, solver: &SolverSettings) -> Result<Outcome, Failure> {
        // How far the start settles makes no difference to whether it can be built, but most of the time.
        let solver = SolverSettings { settle_substeps: Some(0), ..solver.clone() };
        self.run_trial(&Trial { frames: 1, ..Trial::new(resolution, solver) })
    }

    /// Runs the case with options for comparison too.
    ///
    /// # Errors
    /// When the scene is refused or the run diverges.
    pub fn run_trial(&self, trial: &Trial) -> Result<Outcome, Failure> {
        let (figures, cost) = (self.run)(trial)?;
        Ok(Outcome { case: self.name, resolution: trial.resolution, figures, cost })
    }
}
