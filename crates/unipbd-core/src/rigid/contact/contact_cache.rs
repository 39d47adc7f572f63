//! A contact point, and the rarely read data of a contact.

use super::collide::FeaturePair;
use crate::rigid::Surface;

/// One contact point in the sweeps.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Point {
    /// Distance of the surfaces at the start of the substep [m].
    pub gap: f64,
    /// Impulses of this substep, the initial values of the next.
    pub normal_impulse: f64,
    pub tangent_impulse: f64,
    /// Moments about both centres of mass of unit impulses along normal and tangent [m].
    pub normal_a: f64,
    pub normal_b: f64,
    pub tangent_a: f64,
    pub tangent_b: f64,
}

impl Point {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let moments = [self.normal_a, self.normal_b, self.tangent_a, self.tangent_b];
        [self.gap, self.normal_impulse, self.tangent_impulse].into_iter().chain(moments).all(f64::is_finite)
    }

    /// Copies the impulses of a point in an earlier substep, times a factor.
    pub fn keep(&mut self, old: &Point, factor: f64) {
        self.normal_impulse = old.normal_impulse * factor;
        self.tangent_impulse = old.tangent_impulse * factor;
    }
}

/// Rarely read data of a contact.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactCache {
    pub pair: u32,
    /// The wall, or `NONE`.
    pub wall: u32,
    pub surface: Surface,
    /// The vertex and face of each point.
    pub(super) features: [FeaturePair; 2],
    /// Normal velocities at the start of the substep [m/s].
    pub approach: [f64; 2],
    /// Impulses of the rebound [kg m/s]; 0 without a rebound.
    pub rebound: [f64; 2],
}

impl ContactCache {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.approach.into_iter().chain(self.rebound).all(f64::is_finite)
    }

    pub fn new(pair: u32, wall: u32, surface: Surface) -> ContactCache {
        ContactCache {
            pair,
            wall,
            surface,
            features: [FeaturePair::default(); 2],
            approach: [0.0; 2],
            rebound: [0.0; 2],
        }
    }
}
