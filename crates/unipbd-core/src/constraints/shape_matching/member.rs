//! One body as particles, and the best rigid fit of its shape.

use crate::math::Vector64;
use crate::rigid::{CollisionFilter, Elasticity, Surface};
use crate::shapes::{Nearest, Shape};
use std::ops::Range;

/// The time in which a body loses the part of its wobble that is its damping \[s].
const DAMPING_TIME: f64 = 1.0 / 60.0;

/// Stiffness times dt^2 over mass up to which springs act as at the start of a substep: beyond 1 that is unstable.
const STIFFEST: f64 = 0.8;

/// A body as particles: one whose shape is matched, or a rigid one that such bodies touch.
pub struct Member {
    /// Id of its first sample.
    first: u32,
    /// Samples in body coordinates \[m]; their mean is the centre of mass.
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
    /// Centre of mass \[m].
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

    /// Stiffness of a sample's spring to the shape times dt^2 over its mass, in a substep of this length \[s]; infinite
    /// for a rigid body, or where a pose moves it.
    pub(super) fn stiffness(&self, dt: f64) -> f64 {
        match self.softness {
            Some(softness) if softness > 0.0 => dt * dt / softness,
            _ => f64::INFINITY,
        }
    }

    /// Part of the way to the fit that a free sample goes in a substep of this length \[s].
    pub(super) fn part(&self, dt: f64) -> f64 {
        let stiffness = self.stiffness(dt);
        if stiffness.is_finite() { stiffness / (1.0 + stiffness) } else { 1.0 }
    }

    /// Part of its wobble that it loses in a substep of this length \[s].
    pub(super) fn damped(&self, dt: f64) -> f64 {
        1.0 - libm::pow(1.0 - self.damping, dt / DAMPING_TIME)
    }

    /// Displaces the samples of a soft body as their springs do in a substep of this length \[s] where nothing else moves
    /// them from `starts`. The iterations start there, so that at rest a body lies as its springs balance its weight,
    /// whatever the length of the substep.
    pub(super) fn begin(&self, places: &mut [Vector64], starts: &[Vector64], pulled: &mut [Vector64], dt: f64) {
        let stiffness = self.stiffness(dt);
        if !stiffness.is_finite() {
            return;
        }
        let (stiffness, Fit { center, rotation }) = (stiffness.min(STIFFEST), self.fit(starts));
        for (((place, start), r), pulled) in places.iter_mut().zip(starts).zip(&self.rest).zip(pulled) {
            *pulled = (center + rotation.rotate(*r) - *start) * stiffness;
            *place += *pulled;
        }
    }

    /// Moves the samples towards the fit. With k = stiffness and C = x - g, the displacement u of a sample by its spring
    /// becomes u = -k C at the end of the iterations (implicit Euler, as in Macklin et al. 2016).
    pub(super) fn pull_to_shape(&self, places: &mut [Vector64], pulled: &mut [Vector64], dt: f64) {
        let stiffness = self.stiffness(dt);
        let Fit { center, rotation } = self.fit(places);
        for ((place, r), pulled) in places.iter_mut().zip(&self.rest).zip(pulled) {
            let way = center + rotation.rotate(*r) - *place;
            let step = if stiffness.is_finite() { (way * stiffness - *pulled) / (1.0 + stiffness) } else { way };
            *pulled += step;
            *place += step;
        }
    }
}
