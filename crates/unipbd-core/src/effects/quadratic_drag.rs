use super::{Changes, Effect, Wind, any};
use crate::constraints::{Needs, Substep};
use crate::math::{Real, real};
use crate::scene::{MaterialRef, Scene};

/// Drag that grows with the square of the speed against the air, dv/dt = -c |v - v_env| (v - v_env),
/// implicit in the direction: a particle alone falls at sqrt(g/c) at last.
pub struct QuadraticDrag {
    coefficient: Vec<Real>,
    wind: Wind,
}

impl QuadraticDrag {
    /// The drag of a scene, or nothing where no material has one.
    pub fn new(scene: &Scene, seed: u64) -> Option<Self> {
        let of = |material: MaterialRef<'_>| match material {
            MaterialRef::Liquid(liquid) => real(liquid.quadratic_drag),
            MaterialRef::Gas(gas) => real(gas.quadratic_drag),
            _ => 0.0,
        };
        let coefficient: Vec<Real> = scene.materials().map(of).collect();
        any(&coefficient)
            .then(|| QuadraticDrag { coefficient, wind: Wind::new(&scene.environment, scene.spacing, seed) })
    }
}

impl Effect for QuadraticDrag {
    fn name(&self) -> &'static str {
        "quadratic_drag"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let (positions, velocities) = (particles.positions(), particles.velocities());
        let wind = self.wind.at(now.time);
        now.parallelism.update(&mut out.velocity, |i, change| {
            let coefficient = self.coefficient[usize::from(particles.materials()[i])];
            if coefficient > 0.0 {
                let against = wind.velocity(positions[i]) - velocities[i];
                let pull = coefficient * against.length() * now.dt;
                *change += against * (pull / (1.0 + pull));
            }
        });
    }
}
