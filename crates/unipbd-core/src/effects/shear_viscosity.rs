use super::{Changes, Effect, any};
use crate::bytes::held;
use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::kernel::SlopeAsValue;
use crate::math::{Real, Vector, real};
use crate::passes::{self, Records, Weights};
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};
use crate::walls::Coverage;

/// Most stages of one substep: stable up to 136 times the step of the explicit rule.
const MOST_STAGES: u32 = 16;
/// Disordered particles have larger eigenvalues than the lattice.
const DISORDER: f64 = 1.3;
/// Distances to a wall count as at least this many spacings.
const LEAST_DISTANCE: f64 = 0.25;

/// Physical viscosity nu: the Laplacian of Brookshaw 1985 and Morris et al. 1997,
/// rho_i dv_i/dt = sum_j 2 V mu_ij (v_i - v_j) g_ij with grad W = g x and mu_ij the geometric mean of
/// both, which keeps momentum; walls without slip add their share. Bodies slip.
///
/// Large nu dt/dx^2 takes the stages of the Runge-Kutta-Legendre rule of first order (Meyer et al.
/// 2014): s of them are stable for (s^2 + s)/2 explicit steps, and each keeps momentum. Beyond the
/// last stage the viscosity is cut to the stable value: see [`stable_fraction`](Effect::stable_fraction).
pub struct ShearViscosity {
    kernel: Kernel,
    coverage: Coverage,
    volume: Real,
    least_distance: Real,
    /// Square root of the dynamic viscosity by material [(kg/s)^1/2].
    root: Vec<Real>,
    inverse_density: Vec<Real>,
    /// Largest rate at which a velocity difference decays [1/s].
    fastest: f64,
    /// Part of the viscosity that was stable in the last substep.
    stable_fraction: f64,
    weights: Vec<Real>,
    sums: Vec<Vector>,
    now: Vec<Vector>,
    before: Vec<Vector>,
    records: Records,
}

impl ShearViscosity {
    /// The viscosities of a scene; `None` where all are 0.
    pub fn new(scene: &Scene) -> Option<Self> {
        let dynamic = |material: MaterialRef<'_>| material.kinematic_viscosity() * material.density();
        let root: Vec<Real> = scene.materials().map(|material| real(dynamic(material).sqrt())).collect();
        any(&root).then(|| {
            let kernel = Kernel::new(scene.solver.kernel_radius * scene.spacing);
            ShearViscosity {
                kernel,
                coverage: Coverage::new(&kernel),
                volume: real(scene.spacing * scene.spacing),
                least_distance: real(LEAST_DISTANCE * scene.spacing),
                inverse_density: scene.materials().map(|m| real(1.0 / m.density().max(1e-30))).collect(),
                fastest: fastest_decay(scene, &kernel),
                stable_fraction: 1.0,
                root,
                weights: Vec::new(),
                sums: Vec::new(),
                now: Vec::new(),
                before: Vec::new(),
                records: Records::default(),
            }
        })
    }

    /// dt times the Laplacian of a velocity field, times `factor`.
    fn laplacian(&mut self, now: Substep<'_>, factor: Real) {
        let particles = now.particles;
        let shape = SlopeAsValue(self.kernel.shape());
        let weights = Weights::Column(&self.weights);
        passes::xsph(now.pairs(), shape, particles.positions(), &self.now, weights, &mut self.records, &mut self.sums);
        let shear = now.walls.any_without_slip();
        let (weights, velocities, coverage) = (&self.weights, &self.now, &self.coverage);
        let (inverse_density, materials) = (&self.inverse_density, particles.materials());
        let (positions, inverse_masses) = (particles.positions(), particles.inverse_masses());
        let (least, scale) = (self.least_distance, -2.0 * self.volume);
        now.parallelism.update(&mut self.sums, |row, sum| {
            let root = weights[row];
            if root == 0.0 || inverse_masses[row] == 0.0 {
                *sum = Vector::ZERO;
                return;
            }
            let inverse = inverse_density[usize::from(materials[row])];
            *sum *= scale * root * inverse * factor;
            if shear {
                let nu = root * root * inverse * factor;
                for wall in now.walls.shears(positions[row], least, coverage) {
                    *sum += (wall.velocity - velocities[row]) * (nu * wall.rate);
                }
            }
        });
    }
}

/// Twice the diagonal of the Laplacian on the lattice bounds its eigenvalues (Gershgorin); a light
/// material beside a heavy one of the same nu feels the geometric mean of both.
fn fastest_decay(scene: &Scene, kernel: &Kernel) -> f64 {
    let reach = scene.solver.kernel_radius.ceil() as i64;
    let mut slopes = 0.0;
    for (row, column) in (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (row, column))) {
        if (row, column) != (0, 0) {
            let r = scene.spacing * ((row * row + column * column) as f64).sqrt();
            slopes -= f64::from(kernel.slope(real(r)));
        }
    }
    let viscous = || scene.materials().filter(|material| material.kinematic_viscosity() > 0.0);
    let dynamic = |material: MaterialRef<'_>| material.kinematic_viscosity() * material.density();
    let thickest = viscous().map(dynamic).fold(0.0, f64::max);
    let nu = viscous().map(|m| (thickest * dynamic(m)).sqrt() / m.density()).fold(0.0, f64::max);
    2.0 * DISORDER * nu * 2.0 * scene.spacing * scene.spacing * slopes
}

/// Stages that are stable for this many explicit steps, and the part of the step that they can take.
fn stages(steps: f64) -> (u32, f64) {
    let reach = |stages: u32| f64::from(stages * (stages + 1)) / 2.0;
    let wanted = (1..=MOST_STAGES).find(|&stages| reach(stages) >= steps);
    wanted.map_or((MOST_STAGES, reach(MOST_STAGES) / steps), |stages| (stages, 1.0))
}

impl Effect for ShearViscosity {
    fn name(&self) -> &'static str {
        "shear_viscosity"
    }

    fn memory_bytes(&self) -> usize {
        held(&self.weights) + held(&self.sums) + held(&self.now) + held(&self.before) + self.records.memory_bytes()
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let particles = now.particles;
        let rows = particles.dense();
        let velocities = &particles.velocities()[..rows];
        let (materials, phases) = (particles.materials(), particles.phases());
        self.weights.resize(rows, 0.0);
        self.sums.resize(particles.listed(), Vector::ZERO);
        let root = &self.root;
        now.parallelism.fill(&mut self.weights, |row| match phases[row] {
            Phase::Rigid => 0.0,
            _ => root[usize::from(materials[row])],
        });
        self.now.clear();
        self.now.extend_from_slice(velocities);
        self.before.clear();
        self.before.extend_from_slice(velocities);
        // One explicit step is stable while its fastest decay stays below 2.
        let (count, part) = stages(f64::from(now.dt) * self.fastest / 2.0);
        self.stable_fraction = part;
        let width = 2.0 / f64::from(count * (count + 1)) * part;
        for stage in 1..=count {
            let s = f64::from(stage);
            let (mu, nu) = if stage == 1 { (1.0, 0.0) } else { ((2.0 * s - 1.0) / s, (1.0 - s) / s) };
            self.laplacian(now, now.dt * real(mu * width));
            let (mu, nu, sums) = (real(mu), real(nu), &self.sums);
            let (last, before) = (&mut self.now[..sums.len()], &mut self.before[..sums.len()]);
            now.parallelism.chunks2(last, before, |first, last, before| {
                for (k, (last, before)) in last.iter_mut().zip(before).enumerate() {
                    let next = *last * mu + *before * nu + sums[first + k];
                    *before = std::mem::replace(last, next);
                }
            });
        }
        // Viscosity raises no speed above the largest one (maximum principle). A heap crushed to many times
        // its density has larger eigenvalues than the stages can bear, and would be thrown otherwise.
        let square = now.parallelism.max(rows, |row| velocities[row].length_squared());
        let fastest = square.max(now.walls.fastest_squared()).sqrt();
        let result = &self.now;
        now.parallelism.update(&mut out.velocity, |row, change| {
            *change += result[row].clamp_length_max(fastest) - velocities[row]
        });
    }

    fn stable_fraction(&self) -> f64 {
        self.stable_fraction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_grow_with_the_root_of_the_step_and_then_the_step_is_cut() {
        assert_eq!(stages(0.5), (1, 1.0));
        assert_eq!(stages(2.0), (2, 1.0));
        assert_eq!(stages(136.0), (16, 1.0));
        assert_eq!(stages(272.0), (16, 0.5));
    }
}
