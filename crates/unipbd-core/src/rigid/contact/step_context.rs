//! The substep of a search.

use crate::math::Vector64;

/// Parameters of a substep for the search.
#[derive(Clone, Copy, Default)]
pub(super) struct StepContext {
    /// Its length, and that of the substep before, whose impulses are kept; its own, if there was none \[s].
    pub dt: f64,
    pub last_dt: f64,
    /// Gravity [m/s^2].
    pub gravity: Vector64,
    /// Sliding speed below which a contact sticks [m/s].
    pub slow: f64,
}

impl StepContext {
    /// Displacement by gravity in a substep \[m].
    pub fn fall(&self) -> f64 {
        self.gravity.length() * self.dt * self.dt
    }
}
