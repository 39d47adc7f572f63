//! Physical viscosity, at any strength.

mod grips;

use super::{ConstraintGroup, Corrections, Needs, OutlineLoad, Substep};
use crate::bytes::held;
use crate::kernel::{Kernel, SlopeAsValue};
use crate::math::{Real, Vector, real, wide};
use crate::passes::{self, Records, Weights};
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};
use crate::walls::Coverage;
use grips::Grips;

/// Distances to a wall count as at least this many spacings.
const LEAST_DISTANCE: f64 = 0.25;
/// One explicit step is taken while the fastest decay of the lattice is at most this part of the stable one:
/// disordered particles have larger eigenvalues.
const EXPLICIT: f64 = 0.5;
/// The implicit step ends at this part of the residual at its start...
const TOLERANCE: f64 = 1e-3;
/// ...and after this many iterations.
const MOST_ITERATIONS: u32 = 1000;

/// Physical viscosity nu: the Laplacian of Brookshaw 1985 and Morris et al. 1997,
/// rho_i dv_i/dt = sum_j 2 V mu_ij (v_i - v_j) g_ij with grad W = g x and mu_ij the geometric mean of
/// both, which keeps momentum; walls and bodies without slip add their share.
///
/// It acts on the predicted velocities, gravity and others included, so that particles move as they would between
/// viscosity and load. Short steps are explicit; long ones are implicit, v - dt L v = v', by conjugate gradients: L is
/// symmetric with densities as weights, and every iterate keeps momentum.
///
/// A group, not an effect: walls and bodies feel the opposite force, and bodies answer to it within the step.
pub struct Viscosity {
    kernel: Kernel,
    coverage: Coverage,
    volume: Real,
    least_distance: Real,
    /// Square root of the dynamic viscosity by material [(kg/s)^1/2].
    root: Vec<Real>,
    density: Vec<Real>,
    /// Largest rate at which a velocity difference decays [1/s].
    fastest: f64,
    /// Whether this substep's step has been taken: more iterations do not thicken.
    applied: bool,
    weights: Vec<Real>,
    /// Velocities [m/s].
    velocity: Vec<Vector>,
    residual: Vec<Vector>,
    direction: Vec<Vector>,
    sums: Vec<Vector>,
    records: Records,
    grips: Grips,
}

/// Velocities of walls as they are, or all zero: of a difference of two fields.
#[derive(Clone, Copy, PartialEq)]
enum AtWalls {
    Velocity,
    Zero,
}

impl Viscosity {
    /// The viscosities of a scene; `None` where all are 0.
    pub fn new(scene: &Scene) -> Option<Self> {
        let dynamic = |material: MaterialRef<'_>| material.kinematic_viscosity() * material.density();
        let root: Vec<Real> = scene.materials().map(|material| real(dynamic(material).sqrt())).collect();
        root.iter().any(|&root| root > 0.0).then(|| {
            let kernel = Kernel::new(scene.solver.kernel_radius * scene.spacing);
            Viscosity {
                kernel,
                coverage: Coverage::new(&kernel),
                volume: real(scene.spacing * scene.spacing),
                least_distance: real(LEAST_DISTANCE * scene.spacing),
                density: scene.materials().map(|material| real(material.density().max(1e-30))).collect(),
                fastest: fastest_decay(scene, &kernel),
                root,
                applied: false,
                weights: Vec::new(),
                velocity: Vec::new(),
                residual: Vec::new(),
                direction: Vec::new(),
                sums: Vec::new(),
                records: Records::default(),
                grips: Grips::default(),
            }
        })
    }

    /// Predicted velocities and weights of all rows.
    fn begin(&mut self, now: Substep<'_>) {
        let particles = now.particles;
        let rows = particles.dense();
        let (materials, phases) = (particles.materials(), particles.phases());
        let (inverse_masses, velocities) = (particles.inverse_masses(), particles.velocities());
        self.weights.resize(rows, 0.0);
        self.velocity.resize(rows, Vector::ZERO);
        self.direction.resize(rows, Vector::ZERO);
        self.residual.resize(particles.listed(), Vector::ZERO);
        self.sums.resize(particles.listed(), Vector::ZERO);
        let root = &self.root;
        now.parallelism.fill(&mut self.weights, |row| match phases[row] {
            Phase::Rigid => 0.0,
            _ => root[usize::from(materials[row])],
        });
        let inverse_dt = 1.0 / now.dt;
        now.parallelism.fill(&mut self.velocity, |row| {
            let predicted = inverse_masses[row] > 0.0 || phases[row] == Phase::Rigid;
            if predicted { particles.displacement[row] * inverse_dt } else { velocities[row] }
        });
        let (weights, volume) = (&self.weights, f64::from(self.volume));
        self.grips.find(now, self.least_distance, |row| {
            let (root, inverse_mass) = (f64::from(weights[row]), f64::from(inverse_masses[row]));
            (root > 0.0 && inverse_mass > 0.0).then(|| (root * root * volume, 1.0 / inverse_mass))
        });
    }

    /// dt times the Laplacian of a field into the sums; zero in rows that viscosity does not move.
    fn laplacian(&mut self, now: Substep<'_>, of: Field, walls: AtWalls) {
        let particles = now.particles;
        let shape = SlopeAsValue(self.kernel.shape());
        let field = match of {
            Field::Velocity => &self.velocity,
            Field::Direction => &self.direction,
        };
        let weights = Weights::Column(&self.weights);
        passes::xsph(now.pairs(), shape, particles.positions(), field, weights, &mut self.records, &mut self.sums);
        let shear = now.walls.any_without_slip();
        let (weights, coverage, density) = (&self.weights, &self.coverage, &self.density);
        let (positions, inverse_masses) = (particles.positions(), particles.inverse_masses());
        let materials = particles.materials();
        let (least, scale, dt) = (self.least_distance, -2.0 * self.volume, now.dt);
        now.parallelism.update(&mut self.sums, |row, sum| {
            let root = weights[row];
            if root == 0.0 || inverse_masses[row] == 0.0 {
                *sum = Vector::ZERO;
                return;
            }
            let per_density = dt * root / density[usize::from(materials[row])];
            *sum *= scale * per_density;
            if shear {
                for wall in now.walls.shears(positions[row], least, coverage) {
                    let velocity = if walls == AtWalls::Velocity { wall.velocity } else { Vector::ZERO };
                    *sum += (velocity - field[row]) * (root * per_density * wall.rate);
                }
            }
        });
        if self.grips.any() {
            match of {
                Field::Velocity => self.grips.pull_at_start(field, &mut self.sums, f64::from(now.dt)),
                Field::Direction => self.grips.pull_along(field, &mut self.sums, f64::from(now.dt)),
            }
        }
    }

    /// One explicit step; no speed rises above the largest one (maximum principle), in crushed heaps neither.
    fn step_explicit(&mut self, now: Substep<'_>) {
        self.laplacian(now, Field::Velocity, AtWalls::Velocity);
        let (velocity, sums) = (&mut self.velocity, &self.sums);
        let square = now.parallelism.max(velocity.len(), |row| velocity[row].length_squared());
        let fastest = square.max(now.walls.fastest_squared()).max(self.grips.fastest_squared() as Real).sqrt();
        now.parallelism.update(&mut velocity[..sums.len()], |row, velocity| {
            *velocity = (*velocity + sums[row]).clamp_length_max(fastest);
        });
        self.grips.impulse.clone_from(&self.grips.sums);
    }

    /// One implicit step by conjugate gradients.
    fn step_implicit(&mut self, now: Substep<'_>) {
        self.laplacian(now, Field::Velocity, AtWalls::Velocity);
        self.residual.copy_from_slice(&self.sums);
        self.direction.fill(Vector::ZERO);
        self.direction[..self.residual.len()].copy_from_slice(&self.residual);
        self.grips.residual.clone_from(&self.grips.sums);
        self.grips.direction.clone_from(&self.grips.sums);
        let mut square = self.square_of_residual(now);
        let enough = TOLERANCE * TOLERANCE * square;
        for _ in 0..MOST_ITERATIONS {
            if square <= enough || square == 0.0 {
                break;
            }
            self.laplacian(now, Field::Direction, AtWalls::Zero);
            // A p = p - dt L p.
            let direction = &self.direction;
            now.parallelism.update(&mut self.sums, |row, sum| *sum = direction[row] - *sum);
            self.grips.take_from_direction();
            let step = square / self.along_direction(now);
            self.grips.go(step);
            let (step, direction, sums) = (real(step), &self.direction, &self.sums);
            let velocity = &mut self.velocity[..sums.len()];
            now.parallelism.chunks2(velocity, &mut self.residual, |first, velocity, residual| {
                for (k, (velocity, residual)) in velocity.iter_mut().zip(residual).enumerate() {
                    *velocity += direction[first + k] * step;
                    *residual -= sums[first + k] * step;
                }
            });
            let before = std::mem::replace(&mut square, self.square_of_residual(now));
            let kept = square / before;
            self.grips.turn(kept);
            let (kept, residual) = (real(kept), &self.residual);
            now.parallelism.update(&mut self.direction[..residual.len()], |row, direction| {
                *direction = residual[row] + *direction * kept;
            });
        }
    }

    /// The product of the residual with itself.
    fn square_of_residual(&self, now: Substep<'_>) -> f64 {
        let of_bodies = self.grips.product(&self.grips.residual, &self.grips.residual);
        self.product(now, &self.residual, &self.residual) + of_bodies / f64::from(self.volume)
    }

    /// The product of the direction with the sums.
    fn along_direction(&self, now: Substep<'_>) -> f64 {
        let of_bodies = self.grips.product(&self.grips.direction, &self.grips.sums);
        self.product(now, &self.direction, &self.sums) + of_bodies / f64::from(self.volume)
    }

    /// sum_i rho_i a_i b_i.
    fn product(&self, now: Substep<'_>, a: &[Vector], b: &[Vector]) -> f64 {
        let (materials, density) = (now.particles.materials(), &self.density);
        now.parallelism.sum(self.residual.len(), |row| {
            f64::from(density[usize::from(materials[row])]) * wide(a[row]).dot(wide(b[row]))
        })
    }

    /// The impulses that bodies got.
    fn load_bodies(&self, now: Substep<'_>, out: &mut Corrections) {
        let dt = f64::from(now.dt);
        for (load, impulse) in out.shear_loads_mut().iter_mut().zip(self.grips.impulses()) {
            *load = OutlineLoad { force: impulse.linear * dt, torque: impulse.angular * dt };
        }
    }

    /// The shear of the new velocities on the measured walls.
    fn load_walls(&self, now: Substep<'_>, out: &mut Corrections) {
        if out.wall_loads().is_empty() || !now.walls.any_without_slip() {
            return;
        }
        let particles = now.particles;
        for row in 0..particles.listed() {
            let (root, inverse_mass) = (self.weights[row], particles.inverse_masses()[row]);
            if root == 0.0 || inverse_mass == 0.0 {
                continue;
            }
            let nu = root * root / self.density[usize::from(particles.materials()[row])];
            for wall in now.walls.shears(particles.positions()[row], self.least_distance, &self.coverage) {
                if let Some(number) = wall.measured {
                    let pull = (self.velocity[row] - wall.velocity) * (nu * wall.rate * now.dt * now.dt);
                    out.wall_loads_mut()[usize::from(number)] += wide(pull) / f64::from(inverse_mass);
                }
            }
        }
    }
}

/// The field whose Laplacian is taken.
#[derive(Clone, Copy)]
enum Field {
    Velocity,
    Direction,
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
    2.0 * nu * 2.0 * scene.spacing * scene.spacing * slopes
}

impl ConstraintGroup for Viscosity {
    fn name(&self) -> &str {
        "viscosity"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS | Needs::WITHOUT_SLIP
    }

    fn memory_bytes(&self) -> usize {
        let columns = [&self.velocity, &self.residual, &self.direction, &self.sums];
        columns.map(held).iter().sum::<usize>()
            + held(&self.weights)
            + self.records.memory_bytes()
            + self.grips.memory_bytes()
    }

    fn begin_substep(&mut self, _: Substep<'_>) {
        self.applied = false;
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        // A start is settled for its density alone.
        if std::mem::replace(&mut self.applied, true) || now.settling {
            return;
        }
        self.begin(now);
        // An explicit step is stable while its fastest decay stays below 2.
        let fastest = self.fastest.max(2.0 * self.grips.fastest_decay());
        if f64::from(now.dt) * fastest <= 2.0 * EXPLICIT {
            self.step_explicit(now);
        } else {
            self.step_implicit(now);
        }
        let (velocity, particles) = (&self.velocity, now.particles);
        now.parallelism.update(&mut out.displacements_mut()[..self.sums.len()], |row, displacement| {
            if particles.inverse_masses()[row] > 0.0 && self.weights[row] > 0.0 {
                *displacement += velocity[row] * now.dt - particles.displacement[row];
            }
        });
        self.load_bodies(now, out);
        self.load_walls(now, out);
    }
}
