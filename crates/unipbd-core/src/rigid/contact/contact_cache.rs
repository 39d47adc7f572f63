//! A contact point, and the rarely read data of a contact.

use super::bounds::NONE;
use super::frames::Frame;
use super::touch::{Reference, Touch};
use crate::math::Vector64;
use crate::rigid::Surface;

/// One contact point in the sweeps.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Point {
    /// Distance of the surfaces at the start of the substep \[m].
    pub gap: f64,
    /// Impulses of this substep, the initial values of the next.
    pub normal_impulse: f64,
    pub tangent_impulse: f64,
    /// Moments about both centres of mass of unit impulses along normal and tangent \[m].
    pub normal_a: f64,
    pub normal_b: f64,
    pub tangent_a: f64,
    pub tangent_b: f64,
}

impl Point {
    /// In the place of a second point that is not there.
    pub fn absent() -> Point {
        Point { gap: f64::INFINITY, ..Point::default() }
    }

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
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactCache {
    /// The wall, or `NONE`.
    pub wall: u32,
    pub surface: Surface,
    /// The solid that the normal is fixed to, and the normal in its coordinates.
    pub(super) reference: Reference,
    pub(super) normal: Vector64,
    /// Radii of the discs, 0 for polygons \[m].
    pub(super) radii: [f64; 2],
    /// The points of each body, in its coordinates \[m].
    pub(super) anchors: [(Vector64, Vector64); 2],
    /// The vertices that identify each point.
    pub(super) features: [u32; 2],
    /// Normal velocities at the start of the substep [m/s].
    pub approach: [f64; 2],
    /// Normal part of gravity on the first body relative to the second [m/s^2].
    pub pull: f64,
    /// Rebound of each point in this substep.
    pub rebound: [Rebound; 2],
}

/// The rebound of a contact point in a substep; all 0 without one.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Rebound {
    /// Normal velocity after it [m/s].
    pub velocity: f64,
    /// Distance flown after it in the same substep \[m].
    pub flown: f64,
    /// Impulses along normal and tangent, in addition to those of the substep [kg m/s].
    pub normal: f64,
    pub tangent: f64,
}

impl ContactCache {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let of_rebound = |rebound: &Rebound| {
            [rebound.velocity, rebound.flown, rebound.normal, rebound.tangent].into_iter().all(f64::is_finite)
        };
        let numbers = self.approach.into_iter().chain(self.radii).chain([self.pull]);
        let anchors = self.anchors.iter().all(|(on_a, on_b)| on_a.is_finite() && on_b.is_finite());
        numbers.into_iter().all(f64::is_finite)
            && anchors
            && self.normal.is_finite()
            && self.rebound.iter().all(of_rebound)
    }

    pub(super) fn new(wall: u32, surface: Surface, touch: &Touch, frames: [Frame; 2]) -> ContactCache {
        ContactCache {
            wall,
            surface,
            reference: touch.reference,
            normal: touch.fixed_normal(frames),
            radii: touch.radii,
            anchors: Default::default(),
            features: [0; 2],
            approach: [0.0; 2],
            pull: 0.0,
            rebound: [Rebound::default(); 2],
        }
    }

    /// Beside a contact that is over.
    pub(super) fn over() -> ContactCache {
        let surface = Surface { no_slip: false, ..Surface::with_friction(0.0) };
        let touch = Touch {
            reference: Reference::Points,
            normal: Vector64::ZERO,
            on_a: Vector64::ZERO,
            on_b: Vector64::ZERO,
            radii: [0.0; 2],
            feature: 0,
        };
        ContactCache::new(NONE, surface, &touch, [Frame::WORLD; 2])
    }

    /// Whether a point rebounded in the last substep.
    pub fn rebounded(&self) -> bool {
        self.rebound != [Rebound::default(); 2]
    }
}
