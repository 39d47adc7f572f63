//! A point of a contact, and what is read once or seldom of it.

use super::collide::FeaturePair;
use crate::rigid::Surface;

/// One point of a contact, as the sweeps see it.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Point {
    /// Distance of the surfaces at the start of the substep [m].
    pub gap: f64,
    /// Impulses of this substep, the start of the next.
    pub normal_impulse: f64,
    pub tangent_impulse: f64,
    /// Moments about both centres of mass of unit impulses along normal and tangent [m].
    pub normal_a: f64,
    pub normal_b: f64,
    pub tangent_a: f64,
    pub tangent_b: f64,
}

impl Point {
    /// Takes over the impulses of a point in an earlier substep, times a factor.
    pub fn keep(&mut self, old: &Point, factor: f64) {
        self.normal_impulse = old.normal_impulse * factor;
        self.tangent_impulse = old.tangent_impulse * factor;
    }
}

/// What else belongs to a contact.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactCache {
    pub pair: u32,
    /// The wall touched, or `NONE`.
    pub wall: u32,
    pub surface: Surface,
    /// Which vertices and faces touch at each point.
    pub(super) features: [FeaturePair; 2],
    /// Normal velocities at the start of the substep [m/s].
    pub approach: [f64; 2],
    /// Impulses of the rebound [kg m/s]; 0 where nothing rebounded.
    pub rebound: [f64; 2],
}

impl ContactCache {
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
