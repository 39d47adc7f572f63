use super::{Changes, Effect, any, per_gas};
use crate::bytes::held;
use crate::constraints::{Needs, Substep};
use crate::math::{Real, Vector, real, vector};
use crate::scene::Scene;

/// Baroclinic turbulence of gas: vorticity from density gradients across gravity,
/// d omega/dt = beta grad(rho/rho0) x g (Macklin et al. 2014, section 7.2).
///
/// Applied as the acceleration beta (rho/rho0 - mean) g, whose curl is that source; its gradient part is
/// taken up by the pressure. With the mean over all gas it turns and does not lift: momentum is kept.
/// rho/rho0 = 1 + gravity_factor T as for the buoyancy, and less where the gas is thin.
pub struct Baroclinic {
    strength: Vec<Real>,
    /// Density lost per temperature, by material.
    expansion: Vec<Real>,
    gravity: Vector,
    lightness: Vec<Real>,
}

impl Baroclinic {
    /// The baroclinic effect of a scene; `None` where no gas has it.
    pub fn new(scene: &Scene) -> Option<Self> {
        let strength = per_gas(scene, |gas| gas.baroclinic);
        any(&strength).then(|| Baroclinic {
            strength,
            expansion: per_gas(scene, |gas| gas.gravity_factor),
            gravity: vector(scene.gravity.into()),
            lightness: Vec::new(),
        })
    }
}

impl Effect for Baroclinic {
    fn set_gravity(&mut self, gravity: Vector) {
        self.gravity = gravity;
    }

    fn name(&self) -> &'static str {
        "baroclinic"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn memory_bytes(&self) -> usize {
        held(&self.lightness)
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let (materials, inverse_masses) = (particles.materials(), particles.inverse_masses());
        let (temperatures, errors) = (particles.temperatures(), particles.density_errors());
        let (strength, expansion) = (&self.strength, &self.expansion);
        self.lightness.resize(particles.dense(), 0.0);
        now.parallelism.fill(&mut self.lightness, |row| {
            let material = usize::from(materials[row]);
            expansion[material] * temperatures[row] + errors[row].min(0.0)
        });
        let lightness = &self.lightness;
        let weight = |row: usize| match inverse_masses[row] {
            0.0 => 0.0,
            inverse_mass => f64::from(strength[usize::from(materials[row])] / inverse_mass),
        };
        let whole = now.parallelism.sum(lightness.len(), weight);
        if whole == 0.0 {
            return;
        }
        let sum = now.parallelism.sum(lightness.len(), |row| weight(row) * f64::from(lightness[row]));
        let (mean, gravity) = (real(sum / whole), self.gravity * now.dt);
        now.parallelism.update(&mut out.velocity, |row, change| {
            *change += gravity * (strength[usize::from(materials[row])] * (lightness[row] - mean));
        });
    }
}
