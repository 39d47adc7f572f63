use serde::{Deserialize, Serialize};

/// Over-relaxation omega of split Jacobi (Tonge et al. 2012) by default, for contacts of rigid bodies and of bodies of
/// particles. It must lie below 2.
pub(crate) const OVER_RELAXATION: f64 = 1.8;

/// How contacts of bodies are solved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct ContactDescription {
    /// Over-relaxation omega, 1 to 2.
    pub relaxation: f64,
    /// Iterations in a substep, as many before the liquid pushes the bodies as after. In a high heap a second one costs
    /// less than another substep and calms it sooner.
    pub iterations: u32,
}

impl Default for ContactDescription {
    fn default() -> Self {
        ContactDescription { relaxation: OVER_RELAXATION, iterations: 1 }
    }
}

impl ContactDescription {
    pub(crate) fn is_default(&self) -> bool {
        *self == ContactDescription::default()
    }
}
