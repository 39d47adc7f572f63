use serde::{Deserialize, Serialize};

use super::{PressureGridUse, Scene};

/// How the constraints are solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct SolverSettings {
    /// Substeps per frame: `"auto"` or a number.
    #[cfg_attr(feature = "schema", schemars(with = "SubstepsKey"))]
    pub substeps: Substeps,
    /// Most substeps per frame that `"auto"` may choose.
    pub max_substeps: u32,
    /// Target of `"auto"` for the largest compression of a liquid, as a fraction.
    pub target_compression: f64,
    /// Constraint iterations per substep; with a tolerance, the most.
    pub iterations: u32,
    /// The iteration ends once no constraint is violated by more; 0 runs all iterations. A density
    /// error is a fraction.
    pub tolerance: f64,
    /// Kernel radius h in spacings.
    pub kernel_radius: f64,
    /// Where the density constraint is evaluated; left out, `start` where any fluid resists dilation too (gas,
    /// `surface = "none"`), `predicted` beside bodies and with the pressure grid, else `early`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradients: Option<GradientPoint>,
    /// Relaxation of the density iteration, omega; left out, what is stable with the kernel radius and `gradients`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relaxation: Option<f64>,
    /// Shifting of liquids that fill their domain (`surface = "none"`), 0 to 0.2: the density error whose
    /// correction, made everywhere, evens out their particles without a change of velocities. Left out, what is
    /// stable with the kernel radius; 0 is off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shifting: Option<f64>,
    /// Substeps without gravity before time 0 that bring the start to its rest density: at most this many, fewer
    /// where nothing moves any more. Left out, 100, and up to three times the layers of what is deep and narrow.
    /// Without the pressure grid, liquids at rest take substeps with gravity instead, until their pressure carries them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle_substeps: Option<u32>,
    /// Whether a grid of cells two spacings wide carries the smooth part of the pressure: `"on"`, `"off"`, or
    /// `"auto"`, where it pays. `check` and `info` say which, and why.
    pub pressure_grid: PressureGridUse,
    /// Residual at which the solver of the pressure grid ends, as a part of that at its start.
    pub pressure_tolerance: f64,
    /// Most steps of the solver of the pressure grid in a substep.
    pub pressure_steps: u32,
    /// Whether liquid at rest falls asleep: it is held where it is, at no cost, until something near it moves.
    pub sleep: bool,
}

impl Default for SolverSettings {
    fn default() -> Self {
        SolverSettings {
            substeps: Substeps::Auto,
            max_substeps: 256,
            target_compression: 0.01,
            iterations: 1,
            tolerance: 0.0,
            kernel_radius: 3.0,
            gradients: None,
            relaxation: None,
            shifting: None,
            settle_substeps: None,
            pressure_grid: PressureGridUse::default(),
            pressure_tolerance: 0.01,
            pressure_steps: 50,
            sleep: false,
        }
    }
}

/// What depends on the kernel radius.
struct ByRadius {
    /// Kernel radius \[spacings].
    radius: f64,
    /// Relaxation that is stable with a free surface and gradients at the start or at the prediction...
    free: f64,
    /// ...with a constraint taken early...
    early: f64,
    /// ...and in fluids that resist dilation too. One iteration per substep is linearly stable below
    /// 4/(3 lambda_max), lambda_max the largest eigenvalue of the iteration (2.9, 3.15 and 3.9 at 2, 2.5 and
    /// 3 spacings); a free surface bears a little more. Taken at
    /// x_n + eta dt v it is stable below 4/((1 + 2 eta) lambda_max).
    filled: f64,
    /// Shifting of such liquids: about half of what is stable with that relaxation. The faster a mode is evened out,
    /// the less relaxation it bears.
    shifting: f64,
    /// D of the law C_max = (D/omega) P dt^2/dx^2: measured for Wendland C2 at 2.5 spacings on columns 10 to
    /// 300 particles deep; elsewhere it goes as the response of the rest lattice.
    compressibility: f64,
}

#[rustfmt::skip]
const BY_RADIUS: [ByRadius; 4] = [
    ByRadius { radius: 2.0, free: 0.5, early: 0.73, filled: 0.4, shifting: 0.03, compressibility: 0.533 },
    ByRadius { radius: 2.5, free: 0.5, early: 0.67, filled: 0.4, shifting: 0.04, compressibility: 0.335 },
    ByRadius { radius: 3.0, free: 0.36, early: 0.57, filled: 0.33, shifting: 0.03, compressibility: 0.183 },
    ByRadius { radius: 4.0, free: 0.24, early: 0.33, filled: 0.19, shifting: 0.015, compressibility: 0.062 },
];

impl SolverSettings {
    /// Relaxation omega of fluids with a free surface, the constraint taken there.
    pub fn relaxation_of_liquids(&self, gradients: GradientPoint) -> f64 {
        self.relaxation.unwrap_or_else(|| match gradients {
            GradientPoint::Early => self.by_radius(|row| row.early),
            GradientPoint::Start | GradientPoint::Predicted => self.by_radius(|row| row.free),
        })
    }

    /// Relaxation omega of gas, and of liquids without a surface.
    pub fn relaxation_of_filled(&self) -> f64 {
        self.relaxation.unwrap_or_else(|| self.by_radius(|row| row.filled))
    }

    /// Shifting of liquids that fill their domain.
    pub fn shifting_of_filled(&self) -> f64 {
        self.shifting.unwrap_or_else(|| self.by_radius(|row| row.shifting))
    }

    /// D/omega of the law C_max = (D/omega) P dt^2/dx^2, for all iterations of a substep.
    pub fn compressibility(&self, gradients: GradientPoint) -> f64 {
        let iterations = f64::from(self.iterations.max(1));
        self.by_radius(|row| row.compressibility) / (self.relaxation_of_liquids(gradients) * iterations)
    }

    /// Linear between the rows of the table, constant beyond its ends.
    fn by_radius(&self, column: impl Fn(&ByRadius) -> f64) -> f64 {
        let last = BY_RADIUS.len() - 1;
        let radius = self.kernel_radius.clamp(BY_RADIUS[0].radius, BY_RADIUS[last].radius);
        let upper = BY_RADIUS.iter().position(|row| radius <= row.radius).unwrap_or(last).max(1);
        let (below, above) = (&BY_RADIUS[upper - 1], &BY_RADIUS[upper]);
        let part = (radius - below.radius) / (above.radius - below.radius);
        column(below) + part * (column(above) - column(below))
    }
}

impl Scene {
    /// Whether liquids that rest start compressed by their weight: where particles alone carry it, and all fluids have a
    /// surface. A wave does not rest, and what hangs together would be moved by the damping.
    pub(crate) fn starts_under_weight(&self) -> bool {
        let fills = self.materials().any(|material| material.phase().is_fluid() && material.is_two_sided());
        let moves = self.has_tied_particles() || !self.wave.is_empty();
        !(fills || moves || self.uses_pressure_grid() || self.legacy.changes_density())
    }

    /// Where the density constraint is evaluated: what `solver.gradients` says, or else what suits the fluids.
    pub fn gradients(&self) -> GradientPoint {
        let fluids = || self.materials().filter(|material| material.phase().is_fluid());
        let default = if fluids().next().is_none() {
            GradientPoint::Predicted
        } else if fluids().any(|fluid| fluid.is_two_sided()) {
            GradientPoint::Start
        } else if self.body.is_empty() && !self.uses_pressure_grid() {
            GradientPoint::Early
        } else {
            GradientPoint::Predicted
        };
        self.solver.gradients.unwrap_or(default)
    }
}

/// Substeps per frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "SubstepsKey", into = "SubstepsKey")]
pub enum Substeps {
    /// As many as speed, depth and the target compression ask for.
    #[default]
    Auto,
    /// This many in every frame.
    Fixed(u32),
}

/// `"auto"` or a number of substeps per frame.
#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum SubstepsKey {
    Word(SubstepsWord),
    Count(u32),
}

#[derive(Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
enum SubstepsWord {
    Auto,
}

impl From<SubstepsKey> for Substeps {
    fn from(key: SubstepsKey) -> Self {
        match key {
            SubstepsKey::Word(SubstepsWord::Auto) => Substeps::Auto,
            SubstepsKey::Count(count) => Substeps::Fixed(count),
        }
    }
}

impl From<Substeps> for SubstepsKey {
    fn from(substeps: Substeps) -> Self {
        match substeps {
            Substeps::Auto => SubstepsKey::Word(SubstepsWord::Auto),
            Substeps::Fixed(count) => SubstepsKey::Count(count),
        }
    }
}

/// Where the gradient of the density constraint is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GradientPoint {
    /// At the positions of the start of the substep (less damping, one more pass).
    Start,
    /// Value and gradient at x_n + 0.3 dt v, soon after the start (least damping that holds a surface calm).
    Early,
    /// At the predicted positions.
    Predicted,
}

impl GradientPoint {
    /// How far behind the prediction the whole constraint is taken, as a part of a substep.
    pub const fn behind(self) -> f64 {
        match self {
            GradientPoint::Early => 0.7,
            GradientPoint::Start | GradientPoint::Predicted => 0.0,
        }
    }
}
