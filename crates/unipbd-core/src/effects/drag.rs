use super::{Changes, Effect, Wind, any, per_gas};
use crate::constraints::{Needs, Substep};
use crate::math::Real;
use crate::scene::Scene;

/// Drag of thin gas towards the air around it (Macklin et al. 2014, equation 29):
/// f = -k (v - v_env) (1 - rho/rho0), implicit, once per substep.
pub struct Drag {
    rate: Vec<Real>,
    wind: Wind,
}

impl Drag {
    /// The drag of a scene, or nothing where no gas has one.
    pub fn new(scene: &Scene, seed: u64) -> Option<Self> {
        let rate = per_gas(scene, |gas| gas.drag);
        any(&rate).then(|| Drag { rate, wind: Wind::new(&scene.environment, scene.spacing, seed) })
    }
}

impl Effect for Drag {
    fn name(&self) -> &'static str {
        "drag"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let (positions, velocities) = (particles.positions(), particles.velocities());
        let wind = self.wind.at(now.time);
        now.parallelism.update(&mut out.velocity, |i, change| {
            let thin = (-particles.density_errors()[i]).max(0.0);
            let pull = self.rate[usize::from(particles.materials()[i])] * thin * now.dt;
            if pull > 0.0 {
                *change += (wind.velocity(positions[i]) - velocities[i]) * (pull / (1.0 + pull));
            }
        });
    }
}
