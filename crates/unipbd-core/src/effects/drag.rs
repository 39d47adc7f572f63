use super::{Changes, Effect, Wind, any, per_gas};
use crate::constraints::{Needs, Substep};
use crate::math::{Real, real};
use crate::scene::{MaterialRef, Scene};

/// Drag towards the air around, implicit in the velocity, once per substep.
pub struct Drag {
    law: DragLaw,
    /// Coefficient of the law, by material.
    coefficient: Vec<Real>,
    wind: Wind,
}

/// How drag grows with the speed against the air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DragLaw {
    /// Drag of thin gas (Macklin et al. 2014, equation 29): dv/dt = -k (v - v_env) (1 - rho/rho0).
    Thin,
    /// dv/dt = -c |v - v_env| (v - v_env): a particle alone falls at sqrt(g/c) at last.
    Quadratic,
}

impl Drag {
    /// The drag of a scene by this law; `None` where no material has one.
    pub fn new(scene: &Scene, law: DragLaw, seed: u64) -> Option<Self> {
        let coefficient = match law {
            DragLaw::Thin => per_gas(scene, |gas| gas.drag),
            DragLaw::Quadratic => scene.materials().map(quadratic).collect(),
        };
        any(&coefficient).then(|| Drag { law, coefficient, wind: Wind::new(&scene.environment, scene.spacing, seed) })
    }
}

fn quadratic(material: MaterialRef<'_>) -> Real {
    match material {
        MaterialRef::Liquid(liquid) => real(liquid.quadratic_drag),
        MaterialRef::Gas(gas) => real(gas.quadratic_drag),
        _ => 0.0,
    }
}

impl Effect for Drag {
    fn name(&self) -> &'static str {
        match self.law {
            DragLaw::Thin => "drag",
            DragLaw::Quadratic => "quadratic_drag",
        }
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
                let size = match self.law {
                    DragLaw::Thin => (-particles.density_errors()[i]).max(0.0),
                    DragLaw::Quadratic => against.length(),
                };
                let pull = coefficient * size * now.dt;
                *change += against * (pull / (1.0 + pull));
            }
        });
    }
}
