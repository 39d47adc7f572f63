use super::{Changes, Effect, any, per_gas};
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::scene::Scene;

/// Part of the mean vorticity per spacing below which its gradient has no clear direction.
const SOFTENING: Real = 0.02;

/// Vorticity confinement (Fedkiw et al. 2001; Macklin & Müller 2013, section 4) in two dimensions:
/// a = eps dx omega (N_y, -N_x), N = grad|omega| / |grad|omega||.
pub struct VorticityConfinement {
    kernel: Kernel,
    volume: Real,
    spacing: Real,
    strength: Vec<Real>,
    vorticity: Vec<Real>,
}

impl VorticityConfinement {
    /// The confinement of a scene, or nothing where no gas asks for it.
    pub fn new(scene: &Scene) -> Option<Self> {
        let strength = per_gas(scene, |gas| gas.vorticity);
        any(&strength).then(|| VorticityConfinement {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            spacing: real(scene.spacing),
            strength,
            vorticity: Vec::new(),
        })
    }

    /// omega_i = sum_j V x_ij x (v_j - v_i) g_ij [1/s].
    fn measure(&mut self, now: Substep<'_>) {
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let (kernel, volume) = (self.kernel, self.volume);
        self.vorticity.resize(now.particles.dense(), 0.0);
        now.parallelism.update(&mut self.vorticity, |i, vorticity| {
            let mut sum = 0.0;
            now.neighbors.for_each(i, |j| {
                let difference = positions[i] - positions[j];
                sum += difference.perp_dot(velocities[j] - velocities[i]) * kernel.slope(difference.length());
            });
            *vorticity = sum * volume;
        });
    }
}

impl Effect for VorticityConfinement {
    fn name(&self) -> &'static str {
        "vorticity"
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        self.measure(now);
        let rows = self.vorticity.len();
        let square = |i: usize| f64::from(self.vorticity[i]) * f64::from(self.vorticity[i]);
        let mean_square = now.parallelism.sum(rows, square) / rows.max(1) as f64;
        let floor = SOFTENING * real(mean_square.sqrt()) / self.spacing;
        if floor == 0.0 {
            return;
        }
        let positions = now.particles.positions();
        let materials = now.particles.materials();
        now.parallelism.update(&mut out.velocity, |i, change| {
            let strength = self.strength[usize::from(materials[i])];
            if strength == 0.0 {
                return;
            }
            let own = self.vorticity[i];
            let mut gradient = Vector::ZERO;
            now.neighbors.for_each(i, |j| {
                let difference = positions[i] - positions[j];
                let slope = self.kernel.slope(difference.length());
                gradient += difference * (slope * (self.vorticity[j].abs() - own.abs()));
            });
            gradient *= self.volume;
            let direction = gradient / (gradient.length() + floor);
            *change += Vector::new(direction.y, -direction.x) * (now.dt * strength * self.spacing * own);
        });
    }
}
