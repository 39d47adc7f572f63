//! The materials as the grid sees them: masses relative to the heaviest, and which of them have a free surface.

use crate::math::{Real, real};
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};

/// Density errors below these belong to a free surface or to the edge of a plume, not to a gap.
const SURFACE: Real = -0.04;
const PLUME: Real = -0.3;

/// How the particles of a material count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Role {
    /// Mass over that of the heaviest fluid particle.
    pub mass: Real,
    /// 1 for a fluid that fills its cell, -1 for one with a free surface.
    pub filling: Real,
    /// Lower density errors than this count as none.
    pub gate: Real,
}

impl Role {
    /// The density error that counts.
    #[inline(always)]
    pub fn error(&self, error: Real) -> Real {
        if error > self.gate { error } else { 0.0 }
    }
}

/// The roles of all materials.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mixture {
    pub(super) roles: Vec<Role>,
    /// Mass of the heaviest fluid particle \[kg].
    pub(super) heaviest: Real,
    /// Whether there is but one density, each fluid has a free surface, and there are no bodies.
    pub(super) simple: bool,
    /// Whether a fluid fills its domain.
    pub(super) fills: bool,
}

impl Mixture {
    /// Mass of the lightest fluid particle over that of the heaviest.
    pub(crate) fn lightest(&self) -> f64 {
        f64::from(self.roles.iter().map(|role| role.mass).fold(1.0, Real::min))
    }
}

impl Mixture {
    /// The materials of a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let mass = |material: &MaterialRef<'_>| material.particle_mass(scene.spacing);
        let fluids = || scene.materials().filter(|material| material.phase().is_fluid());
        let heaviest = fluids().map(|fluid| mass(&fluid)).fold(0.0, f64::max);
        let role = |material: MaterialRef<'_>| Role {
            mass: if material.phase().is_fluid() { real(mass(&material) / heaviest) } else { 1.0 },
            filling: if material.is_two_sided() { 1.0 } else { -1.0 },
            gate: match (material.is_two_sided(), material.phase()) {
                (false, _) => SURFACE,
                (true, Phase::Gas) => PLUME,
                (true, _) => Real::NEG_INFINITY,
            },
        };
        let roles: Vec<Role> = scene.materials().map(role).collect();
        let fills = fluids().any(|fluid| fluid.is_two_sided());
        let even = fluids().all(|fluid| mass(&fluid) == heaviest);
        Mixture { roles, heaviest: real(heaviest), simple: even && !fills && scene.body.is_empty(), fills }
    }
}
