use super::{Changes, Effect, any};
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::scene::{MaterialRef, Scene};
use crate::simd::{self, Weights};

/// XSPH viscosity (Schechter & Bridson 2012; Macklin & Müller 2013, equation 17):
/// v_i += c sum_j V (v_j - v_i) W_ij, with the reduced mass of each pair so that momentum is kept.
pub struct Viscosity {
    kernel: Kernel,
    volume: Real,
    strength: Vec<Real>,
    /// The viscosity of all dense particles, where they are of one material.
    uniform: Option<Real>,
}

impl Viscosity {
    /// The viscosities of a scene, or nothing where all are 0.
    pub fn new(scene: &Scene) -> Option<Self> {
        let of = |material: MaterialRef<'_>| match material {
            MaterialRef::Liquid(liquid) => real(liquid.viscosity),
            MaterialRef::Gas(gas) => real(gas.viscosity),
            MaterialRef::Smoke(_) | MaterialRef::Solid(_) | MaterialRef::Rigid => 0.0,
        };
        let strength: Vec<Real> = scene.materials().map(of).collect();
        any(&strength).then(|| Viscosity {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            uniform: uniform(scene, &strength),
            strength,
        })
    }
}

fn uniform(scene: &Scene, strength: &[Real]) -> Option<Real> {
    let mut dense = scene.materials().zip(strength).filter(|(material, _)| material.phase().is_dense());
    let (_, &first) = dense.next()?;
    (dense.next().is_none() && scene.emitter.is_empty() && scene.body.is_empty()).then_some(first)
}

impl Effect for Viscosity {
    fn name(&self) -> &'static str {
        "viscosity"
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        match self.uniform {
            Some(strength) if !now.particles.any_scripted() => self.apply_uniform(now, strength, out),
            _ => self.apply_mixed(now, out),
        }
    }
}

impl Viscosity {
    /// All dense particles have one mass and one viscosity.
    fn apply_uniform(&mut self, now: Substep<'_>, strength: Real, out: &mut Changes) {
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let weights = Weights::Uniform(self.volume * strength);
        simd::xsph(now.pairs(), self.kernel.shape(), positions, velocities, weights, &mut out.velocity);
    }

    fn apply_mixed(&self, now: Substep<'_>, out: &mut Changes) {
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let (inverse_masses, materials) = (now.particles.inverse_masses(), now.particles.materials());
        let periodic = now.neighbors.periodic();
        let strength = |row: usize| self.strength[usize::from(materials[row])];
        now.parallelism.update(&mut out.velocity, |i, change| {
            let mut sum = Vector::ZERO;
            now.neighbors.for_each(i, |j| {
                let pair = 0.5 * (strength(i) + strength(j));
                let masses = inverse_masses[i] + inverse_masses[j];
                if pair > 0.0 && masses > 0.0 {
                    let apart = periodic.min_image(positions[i] - positions[j]);
                    let weight = self.kernel.value(apart.length());
                    sum += (velocities[j] - velocities[i]) * (weight * pair * 2.0 * inverse_masses[i] / masses);
                }
            });
            *change += sum * self.volume;
        });
    }
}
