//! The clock of a run.

use crate::math::Vector64;

/// Clock of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Clock {
    pub frame: u64,
    pub step: u64,
    pub time: f64,
    /// Length of the last substep \[s].
    pub dt: f64,
    pub substeps: u32,
    /// Substeps done of a frame that was interrupted by an error.
    pub done: u32,
    pub list_builds: u32,
    /// Limit of the pressure over density of a fluid [m^2/s^2].
    pub pressure_limit: f64,
    /// Fraction of the full stiffness of the fluids.
    pub stiffness: f64,
    /// Whether the start of the run is being settled.
    pub settling: bool,
    /// Whether the last frame took fewer substeps than demanded.
    pub capped: bool,
    /// Fastest dense particle after the last substep [m/s].
    pub speed: f64,
    /// Acceleration by hooks in the last substep.
    pub push: Push,
    /// Advances whenever particles are added or removed.
    pub generation: u64,
}

/// Acceleration of the fluids by hooks: its mean, and the root mean square of the rest [m/s^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Push {
    pub mean: Vector64,
    pub spread: f64,
}

impl Push {
    /// The root mean square of the whole [m/s^2].
    pub fn size(&self) -> f64 {
        libm::hypot(self.mean.length(), self.spread)
    }
}
