//! Settings of the contact solver.

use super::SleepSettings;
use crate::scene::{ContactDescription, ContactMethod, FrictionRule};

/// Settings of the contact solver.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactSettings {
    /// The order of contacts and joints in an iteration.
    pub method: ContactMethod,
    /// Factor that reduces the mass splitting: over-relaxation of the split Jacobi sweep, below 2.
    /// With an odd number of iterations in a substep warm starting is stable only up to 4/3 (one) or 1.69 (three).
    pub relaxation: f64,
    /// Iterations in a call of [`Contacts::iterate`](super::Contacts::iterate). A substep has two calls.
    pub iterations: u32,
    /// Settings of the overlap removal.
    pub depenetration: Depenetration,
    /// Velocity iterations of the restitution pass.
    pub restitution_iterations: u32,
    /// How friction coefficients combine.
    pub friction_rule: FrictionRule,
    /// Sleep thresholds of bodies; `None` disables sleep.
    pub sleep: Option<SleepSettings>,
}

impl Default for ContactSettings {
    fn default() -> Self {
        let ContactDescription { method, relaxation, iterations, .. } = ContactDescription::default();
        ContactSettings {
            method,
            relaxation,
            iterations,
            depenetration: Depenetration::default(),
            restitution_iterations: 6,
            friction_rule: FrictionRule::default(),
            sleep: Some(SleepSettings::default()),
        }
    }
}

/// Settings of the overlap removal. Small overlap is removed slowly: immediate removal of the overlap of an impact
/// adds energy to rocking stacks. Large overlap of bodies that started inside each other is removed fast.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Depenetration {
    /// Overlap that is not removed, relative to the size of the smaller body.
    pub slop: f64,
    /// Fraction of the overlap removed in a substep.
    pub fraction: f64,
    /// Overlap above which the second fraction applies, relative to the size of the smaller body.
    pub deep: f64,
    /// Fraction of the deeper overlap removed in a substep.
    pub deep_fraction: f64,
    /// Maximum speed of the overlap removal, relative to that of a fall from the size of the smaller body. Without
    /// gravity there is no limit.
    pub speed: f64,
}

impl Default for Depenetration {
    fn default() -> Self {
        Depenetration { slop: 1e-4, fraction: 0.1, deep: 0.01, deep_fraction: 0.4, speed: 1.0 }
    }
}

impl Depenetration {
    /// Minus the part of an overlap that a substep removes between bodies of this size \[m]. `fall` is twice the
    /// gravity times the square of the substep \[m].
    pub(super) fn lacking(&self, overlap: f64, size: f64, fall: f64) -> f64 {
        let overlap = overlap - self.slop * size;
        if overlap <= 0.0 {
            return 0.0;
        }
        let farthest = if fall > 0.0 { self.speed * (fall * size).sqrt() } else { f64::INFINITY };
        let deep = (overlap - self.deep * size).max(0.0);
        -(self.fraction * overlap + (self.deep_fraction - self.fraction) * deep).clamp(0.0, farthest)
    }
}
