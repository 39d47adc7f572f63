use serde::{Deserialize, Serialize};

/// How contacts of bodies are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct ContactDescription {
    /// How their pushes are found.
    pub method: ContactMethod,
    /// Over-relaxation omega, 1 to 2; left out, 1.8 for `split` and 1 for `averaged`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relaxation: Option<f64>,
    /// Mass scaling k of Macklin et al. 2014 (equation 21) [1/m]; 0 for none. Contacts see masses m exp(-k h), h the
    /// height above the lowest support of a heap: upper bodies weigh less on lower ones, and fewer substeps carry a
    /// heap. Loads of contacts are then those of the scaled masses, and an impact loses momentum.
    pub mass_scaling: f64,
    /// Iterations in a substep, as many before the liquid pushes the bodies as after; left out, 1. In a high heap a
    /// second one costs less than another substep and calms it sooner.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iterations: Option<u32>,
}

/// How the pushes of contacts are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ContactMethod {
    /// Split Jacobi (Tonge et al. 2012): impulses last from substep to substep, friction holds without creep.
    #[default]
    Split,
    /// Averaged Jacobi with over-relaxation, as in Macklin et al. 2014 (section 4.2): nothing lasts, and
    /// friction is that of positions (equations 23 to 25). Simple; stacks sink and creep. Where both bodies have
    /// n contacts each moves by (omega/n) times the sum of its corrections, as there; where they have not,
    /// masses are split instead, so that momentum is kept.
    Averaged,
}

impl ContactDescription {
    /// Over-relaxation omega, given or by default.
    pub fn relaxation(&self) -> f64 {
        self.relaxation.unwrap_or(match self.method {
            ContactMethod::Split => 1.8,
            ContactMethod::Averaged => 1.0,
        })
    }

    /// Iterations, given or by default.
    pub fn iterations(&self) -> u32 {
        self.iterations.unwrap_or(1)
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == ContactDescription::default()
    }
}
