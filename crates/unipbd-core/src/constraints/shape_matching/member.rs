//! One body as particles, and the best rigid fit of its shape.

use crate::math::Vector64;
use crate::rigid::{CollisionFilter, Elasticity, Surface};
use crate::shapes::{Nearest, Shape};
use std::ops::Range;

/// The time in which a body loses the part of its wobble that is its damping [s].
const DAMPING_TIME: f64 = 1.0 / 60.0;

/// A body as particles: one whose shape is matched, or a rigid one that such bodies touch.
pub struct Member {
    /// Id of its first sample.
    first: u32,
    /// Samples in body coordinates [m]; their mean is the centre of mass.
    rest: Vec<Vector64>,
    /// Signed distance to the outline and its gradient, at each sample.
    pub(super) distances: Vec<Nearest>,
    /// Inverse mass of a sample [1/kg]; 0 where nothing moves the body.
    pub(super) inverse_mass: f64,
    /// Sum of the squared distances of the samples from the centre of mass [m^2].
    pub(super) spread: f64,
    /// Compliance times mass, the inverse square of the frequency with which samples swing about the shape [s^2]; none
    /// where a pose moves it.
    softness: Option<f64>,
    /// Part of its wobble that it loses in a 60th of a second.
    damping: f64,
    pub(super) surface: Surface,
    pub(super) filter: CollisionFilter,
}

/// The place of a shape that fits particles best.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fit {
    /// Centre of mass [m].
    pub center: Vector64,
    /// Cosine and sine of the angle.
    pub rotation: Vector64,
}

impl Member {
    /// A body of this shape whose samples have the ids from `first` on.
    pub fn new(
        first: u32,
        rest: Vec<Vector64>,
        shape: &Shape,
        mass: f64,
        elasticity: Option<Elasticity>,
        surface: Surface,
        filter: CollisionFilter,
    ) -> Member {
        let distances = rest.iter().map(|&sample| shape.nearest(sample)).collect();
        let inverse_mass = rest.len() as f64 / mass;
        let softness = elasticity.map(|how| how.compliance * mass);
        let damping = elasticity.map_or(0.0, |how| how.damping);
        let spread = rest.iter().map(|r| r.length_squared()).sum::<f64>().max(f64::MIN_POSITIVE);
        Member { first, rest, damping, distances, spread, inverse_mass, softness, surface, filter }
    }

    pub(super) fn ids(&self) -> Range<u32> {
        self.first..self.first + self.rest.len() as u32
    }

    pub(super) fn is_matched(&self) -> bool {
        self.softness.is_some()
    }

    /// theta = atan2(A21 - A12, A11 + A22), A = sum m (x - c) r^T.
    pub(super) fn fit(&self, places: &[Vector64]) -> Fit {
        let center = places.iter().sum::<Vector64>() / places.len().max(1) as f64;
        let turned = places.iter().zip(&self.rest).fold(Vector64::ZERO, |sum, (x, r)| {
            let arm = *x - center;
            sum + Vector64::new(r.dot(arm), r.perp_dot(arm))
        });
        let rotation = turned.normalize_or_zero();
        Fit { center, rotation: if rotation == Vector64::ZERO { Vector64::X } else { rotation } }
    }

    /// Part of the way to the fit that one of so many rounds goes in a substep of this length [s]; all of it where a
    /// pose moves the body.
    ///
    /// A substep leaves a/(1 + a) of the way with a = compliance mass / dt^2 (implicit Euler; Macklin et al. 2016): at
    /// rest the samples lie where the spring balances gravity, whatever the length of the substep.
    pub(super) fn part(&self, dt: f64, rounds: f64) -> f64 {
        let soft = self.softness.unwrap_or(0.0) / (dt * dt);
        1.0 - (soft / (1.0 + soft)).powf(1.0 / rounds)
    }

    /// Part of its wobble that it loses in a substep of this length [s].
    pub(super) fn damped(&self, dt: f64) -> f64 {
        1.0 - (1.0 - self.damping).powf(dt / DAMPING_TIME)
    }

    /// Moves the samples towards the fit, a part of the way.
    pub(super) fn pull_to_shape(&self, places: &mut [Vector64], part: f64) {
        let Fit { center, rotation } = self.fit(places);
        for (place, r) in places.iter_mut().zip(&self.rest) {
            *place += (center + rotation.rotate(*r) - *place) * part;
        }
    }
}
