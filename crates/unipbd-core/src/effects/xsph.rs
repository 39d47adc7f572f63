use super::{Changes, Effect, any};
use crate::bytes::held;
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::passes::{self, Records, Weights};
use crate::scene::{MaterialRef, Scene};

/// XSPH viscosity (Schechter & Bridson 2012; Macklin & Müller 2013, equation 17):
/// v_i += c sum_j V (v_j - v_i) W_ij, with the reduced mass of each pair so that momentum is kept.
pub struct Xsph {
    kernel: Kernel,
    volume: Real,
    strength: Vec<Real>,
    /// The strength of all dense particles, where they are of one material.
    uniform: Option<Real>,
    /// Strength times volume, and inverse mass, by row.
    traits: Vec<Vector>,
    records: Records,
}

impl Xsph {
    /// The XSPH of a scene; `None` where all are 0.
    pub fn new(scene: &Scene) -> Option<Self> {
        let of = |material: MaterialRef<'_>| match material {
            MaterialRef::Liquid(liquid) => real(liquid.xsph),
            MaterialRef::Gas(gas) => real(gas.xsph),
            MaterialRef::Smoke(_) | MaterialRef::Solid(_) | MaterialRef::Rigid => 0.0,
        };
        let strength: Vec<Real> = scene.materials().map(of).collect();
        any(&strength).then(|| Xsph {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            uniform: uniform(scene, &strength),
            strength,
            traits: Vec::new(),
            records: Records::default(),
        })
    }
}

fn uniform(scene: &Scene, strength: &[Real]) -> Option<Real> {
    let mut dense = scene.materials().zip(strength).filter(|(material, _)| material.phase().is_dense());
    let (_, &first) = dense.next()?;
    (dense.next().is_none() && scene.emitter.is_empty() && scene.body.is_empty()).then_some(first)
}

impl Effect for Xsph {
    fn name(&self) -> &'static str {
        "xsph"
    }

    fn memory_bytes(&self) -> usize {
        held(&self.traits) + self.records.memory_bytes()
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        match self.uniform {
            Some(strength) if !now.particles.any_kinematic() => self.apply_uniform(now, strength, out),
            _ => self.apply_mixed(now, out),
        }
    }
}

impl Xsph {
    /// All dense particles have one mass and one strength.
    fn apply_uniform(&mut self, now: Substep<'_>, strength: Real, out: &mut Changes) {
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let weights = Weights::Uniform(self.volume * strength);
        passes::xsph(
            now.pairs(),
            self.kernel.shape(),
            positions,
            velocities,
            weights,
            &mut self.records,
            &mut out.velocity,
        );
    }

    fn apply_mixed(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let (inverse_masses, materials) = (particles.inverse_masses(), particles.materials());
        let (strength, traits) = (&self.strength, &mut self.traits);
        traits.resize(particles.dense(), Vector::ZERO);
        now.parallelism
            .fill(traits, |row| Vector::new(self.volume * strength[usize::from(materials[row])], inverse_masses[row]));
        let (positions, velocities) = (particles.positions(), particles.velocities());
        let (traits, records) = (&self.traits, &mut self.records);
        passes::xsph_mixed(now.pairs(), self.kernel.shape(), positions, velocities, traits, records, &mut out.velocity);
    }
}
