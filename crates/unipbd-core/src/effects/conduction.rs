use super::{Changes, Effect, any, per_gas};
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, real};
use crate::scene::Scene;

/// Conduction of heat between gas particles, the SPH Laplacian of Brookshaw 1985:
/// dT_i/dt = kappa sum_j 2 V (T_i - T_j) g_ij, with grad W = g x.
pub struct Conduction {
    kernel: Kernel,
    volume: Real,
    diffusivity: Vec<Real>,
}

impl Conduction {
    /// The conduction of a scene, or nothing where no gas conducts.
    pub fn new(scene: &Scene) -> Option<Self> {
        let diffusivity = per_gas(scene, |gas| gas.conductivity);
        any(&diffusivity).then(|| Conduction {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            diffusivity,
        })
    }
}

impl Effect for Conduction {
    fn name(&self) -> &'static str {
        "conduction"
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let (positions, temperatures) = (particles.positions(), particles.temperatures());
        let diffusivity = |row: usize| self.diffusivity[usize::from(particles.materials()[row])];
        now.parallelism.update(&mut out.temperature, |i, change| {
            let mut sum = 0.0;
            now.neighbors.for_each(i, |j| {
                let pair = diffusivity(i).min(diffusivity(j));
                if pair > 0.0 {
                    let slope = self.kernel.slope((positions[i] - positions[j]).length());
                    sum += pair * (temperatures[i] - temperatures[j]) * slope;
                }
            });
            *change += now.dt * 2.0 * self.volume * sum;
        });
    }
}
