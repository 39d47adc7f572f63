use serde::{Deserialize, Serialize};

/// Over-relaxation omega of split Jacobi (Tonge et al. 2012) by default, for contacts of rigid bodies and of bodies of
/// particles. It must lie below 2.
pub(crate) const OVER_RELAXATION: f64 = 1.8;

/// Speed below which bodies may sleep, relative to sqrt(gravity x size).
pub(crate) const SLEEP_SPEED: f64 = 0.02;
/// Frames at rest before bodies sleep.
const SLEEP_FRAMES: f64 = 30.0;

/// How contacts of bodies are solved, and when bodies sleep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct ContactDescription {
    /// The order of contacts and joints in an iteration.
    pub method: ContactMethod,
    /// Over-relaxation omega of split Jacobi, 1 to 2.
    pub relaxation: f64,
    /// Iterations in a substep, as many before the liquid pushes the bodies as after. In a high heap one more costs
    /// less than another substep and calms it sooner.
    pub iterations: u32,
    /// How the friction coefficients of two surfaces combine.
    pub friction_rule: FrictionRule,
    /// Whether bodies at rest sleep: they are held still until something touches or pushes them.
    pub sleep: bool,
    /// Speed of the fastest point of a body below which it may sleep, relative to sqrt(gravity x size of the body).
    /// Nothing sleeps without gravity, while it drifts, while its speed grows, or while a motor turns it.
    pub sleep_speed: f64,
    /// Time at rest before bodies that touch each other sleep; left out, 30 frames \[s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sleep_delay: Option<f64>,
}

/// The order of contacts and joints in an iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ContactMethod {
    /// One after the other: stacks and unequal masses need fewer substeps.
    #[default]
    GaussSeidel,
    /// All from one state, with the mass of a body split among its contacts (Tonge et al. 2012): a mirrored scene stays
    /// mirrored.
    SplitJacobi,
}

/// How the friction coefficients of two surfaces combine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum FrictionRule {
    /// The root of the product: one smooth side makes a smooth contact.
    #[default]
    GeometricMean,
    /// Half of the sum.
    Average,
    /// The product.
    Multiply,
    /// The smaller one.
    Minimum,
    /// The larger one.
    Maximum,
}

impl FrictionRule {
    /// The coefficient of two surfaces with these.
    pub fn combine(self, a: f64, b: f64) -> f64 {
        match self {
            FrictionRule::GeometricMean => (a * b).sqrt(),
            FrictionRule::Average => 0.5 * (a + b),
            FrictionRule::Multiply => a * b,
            FrictionRule::Minimum => a.min(b),
            FrictionRule::Maximum => a.max(b),
        }
    }
}

impl Default for ContactDescription {
    fn default() -> Self {
        ContactDescription {
            method: ContactMethod::GaussSeidel,
            relaxation: OVER_RELAXATION,
            iterations: 2,
            friction_rule: FrictionRule::default(),
            sleep: true,
            sleep_speed: SLEEP_SPEED,
            sleep_delay: None,
        }
    }
}

impl ContactDescription {
    /// Time at rest before bodies sleep, at this number of frames per second \[s].
    pub(crate) fn rest_time(&self, fps: f64) -> f64 {
        self.sleep_delay.unwrap_or(SLEEP_FRAMES / fps)
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == ContactDescription::default()
    }
}
