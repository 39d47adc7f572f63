use super::{Changes, Effect, any, per_gas};
use crate::bytes::held;
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real};
use crate::passes::{self, Records};
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
    size: Vec<Real>,
    gradient: Vec<Vector>,
    records: Records,
}

impl VorticityConfinement {
    /// The confinement of a scene; `None` where no gas asks for it.
    pub fn new(scene: &Scene) -> Option<Self> {
        let strength = per_gas(scene, |gas| gas.vorticity);
        any(&strength).then(|| VorticityConfinement {
            kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing),
            volume: real(scene.spacing * scene.spacing),
            spacing: real(scene.spacing),
            strength,
            vorticity: Vec::new(),
            size: Vec::new(),
            gradient: Vec::new(),
            records: Records::default(),
        })
    }

    /// omega_i = sum_j V x_ij x (v_j - v_i) g_ij [1/s], and its size.
    fn measure(&mut self, now: Substep<'_>) {
        let rows = now.particles.listed();
        self.vorticity.resize(rows, 0.0);
        // Sleeping rows, behind the others, do not turn.
        self.size.resize(now.particles.dense(), 0.0);
        self.size[rows..].fill(0.0);
        self.gradient.resize(rows, Vector::ZERO);
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let (shape, records) = (self.kernel.shape(), &mut self.records);
        passes::vorticity(now.pairs(), shape, positions, velocities, records, &mut self.vorticity);
        let (vorticity, volume) = (&mut self.vorticity, self.volume);
        now.parallelism.update(vorticity, |_, vorticity| *vorticity *= volume);
        let vorticity = &self.vorticity;
        now.parallelism.fill(&mut self.size[..rows], |row| vorticity[row].abs());
    }
}

impl Effect for VorticityConfinement {
    fn name(&self) -> &'static str {
        "vorticity"
    }

    fn memory_bytes(&self) -> usize {
        held(&self.vorticity) + held(&self.size) + held(&self.gradient) + self.records.memory_bytes()
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
        passes::difference_gradient(now.pairs(), self.kernel.shape(), positions, &self.size, &mut self.gradient);
        let (materials, gradients) = (now.particles.materials(), &self.gradient);
        now.parallelism.update(&mut out.velocity, |row, change| {
            let strength = self.strength[usize::from(materials[row])];
            let gradient = gradients[row] * self.volume;
            let direction = gradient / (gradient.length() + floor);
            let push = now.dt * strength * self.spacing * self.vorticity[row];
            *change += Vector::new(direction.y, -direction.x) * push;
        });
    }
}
