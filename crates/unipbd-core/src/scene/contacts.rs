use serde::{Deserialize, Serialize};

/// Over-relaxation omega of split Jacobi (Tonge et al. 2012) by default, for contacts of rigid bodies and of bodies of
/// particles. It must lie below 2.
pub(crate) const OVER_RELAXATION: f64 = 1.8;

/// How contacts of bodies are solved.
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

impl Default for ContactDescription {
    fn default() -> Self {
        ContactDescription { method: ContactMethod::GaussSeidel, relaxation: OVER_RELAXATION, iterations: 2 }
    }
}

impl ContactDescription {
    pub(crate) fn is_default(&self) -> bool {
        *self == ContactDescription::default()
    }
}
