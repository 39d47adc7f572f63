//! How contacts are solved: what a scene may choose.

use super::SleepSettings;
use crate::scene::ContactDescription;

/// How contacts are solved.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactSettings {
    /// Contacts that share a body count this much less: over-relaxation of the split Jacobi sweep, below 2.
    /// With an odd number of iterations in a substep warm starting is stable only up to 4/3 (one) or 1.69 (three).
    pub relaxation: f64,
    /// Iterations in a call of [`Contacts::iterate`](super::Contacts::iterate), two of which make a substep.
    pub iterations: u32,
    /// How overlap is taken out.
    pub depenetration: Depenetration,
    /// Velocity iterations of the restitution pass.
    pub restitution_iterations: u32,
    /// When bodies fall asleep; none, never.
    pub sleep: Option<SleepSettings>,
}

impl Default for ContactSettings {
    fn default() -> Self {
        let ContactDescription { relaxation, iterations } = ContactDescription::default();
        ContactSettings {
            relaxation,
            iterations,
            depenetration: Depenetration::default(),
            restitution_iterations: 6,
            sleep: Some(SleepSettings::default()),
        }
    }
}

/// How overlap is taken out of positions. Gently where it is small: lifting at once what an impact has
/// pressed in feeds rocking stacks with energy. Swiftly where bodies started inside each other.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Depenetration {
    /// Overlap that is left alone, over the size of the smaller body.
    pub slop: f64,
    /// Fraction of the overlap that a substep takes out.
    pub fraction: f64,
    /// Overlap from which on more is taken out, over the size of the smaller body.
    pub deep: f64,
    /// Fraction of what lies deeper that a substep takes out.
    pub deep_fraction: f64,
    /// Fastest that overlap is taken out [m/s].
    pub speed: f64,
}

impl Default for Depenetration {
    fn default() -> Self {
        Depenetration { slop: 1e-4, fraction: 0.1, deep: 0.01, deep_fraction: 0.4, speed: 3.0 }
    }
}
