use super::{Changes, Effect, any, per_gas};
use crate::bytes::held;
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, real};
use crate::passes::{self, Weights};
use crate::scene::Scene;

/// Conduction of heat between gas particles, the SPH Laplacian of Brookshaw 1985:
/// dT_i/dt = sum_j 2 V kappa_ij (T_i - T_j) g_ij, with grad W = g x and kappa_ij the geometric mean of
/// the two diffusivities, so that heat is kept.
pub struct Conduction {
    kernel: Kernel,
    volume: Real,
    /// Square root of the diffusivity, per material.
    root: Vec<Real>,
    weights: Vec<Real>,
    sums: Vec<Real>,
}

impl Conduction {
    /// The conduction of a scene; `None` where no gas conducts.
    pub fn new(scene: &Scene) -> Option<Self> {
        let diffusivity = per_gas(scene, |gas| gas.conductivity);
        any(&diffusivity).then(|| Conduction {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            root: diffusivity.iter().map(|value| value.sqrt()).collect(),
            weights: Vec::new(),
            sums: Vec::new(),
        })
    }
}

impl Effect for Conduction {
    fn name(&self) -> &'static str {
        "conduction"
    }

    fn memory_bytes(&self) -> usize {
        held(&self.weights) + held(&self.sums)
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let rows = particles.dense();
        let root = |row: usize| self.root[usize::from(particles.materials()[row])];
        self.weights.resize(rows, 0.0);
        self.sums.resize(particles.listed(), 0.0);
        let weights = &mut self.weights;
        now.parallelism.fill(weights, root);
        let weights = Weights::Column(&self.weights);
        let (shape, temperatures) = (self.kernel.shape(), particles.temperatures());
        passes::laplacian(now.pairs(), shape, particles.positions(), temperatures, weights, &mut self.sums);
        let (sums, factor) = (&self.sums, now.dt * 2.0 * self.volume);
        now.parallelism.update(&mut out.temperature, |row, change| *change += factor * root(row) * sums[row]);
    }
}
