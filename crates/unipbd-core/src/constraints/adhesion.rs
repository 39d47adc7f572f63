//! Adhesion: liquids are drawn to walls and bodies.

use super::{ConstraintGroup, Corrections, Needs, Substep};
use crate::kernel::Kernel;
use crate::math::{Real, Vector, real, wide};
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};
use crate::walls::Coverage;

/// a = strength (3 pi/14) h grad s, where s is the part of the kernel around a particle that lies in walls
/// and bodies, scaled so that the strength is the acceleration on a flat wall: the pull of solids on a liquid (Akinci, Akinci & Teschner 2013, section 3.3), from the
/// potential of what covers the kernel, so that walls and samples of bodies pull alike.
///
/// A group, not an effect: bodies and walls feel the opposite force, as they do that of the density.
pub struct Adhesion {
    kernel: Kernel,
    coverage: Coverage,
    volume: Real,
    /// Strength times kernel radius and scale, by material [m^2/s^2].
    pull: Vec<Real>,
    /// Whether this substep's force has been applied: more iterations do not pull harder.
    applied: bool,
}

/// One over h times the marginal of Wendland C2 on a wall.
const WALL_SCALE: f64 = 3.0 * std::f64::consts::PI / 14.0;

impl Adhesion {
    /// The adhesion of a scene; `None` where no liquid has any.
    pub fn new(scene: &Scene) -> Option<Self> {
        let radius = scene.solver.kernel_radius * scene.spacing;
        let of = |material: MaterialRef<'_>| match material {
            MaterialRef::Liquid(liquid) => real(liquid.adhesion * radius * WALL_SCALE),
            _ => 0.0,
        };
        let pull: Vec<Real> = scene.materials().map(of).collect();
        let kernel = Kernel::new(radius);
        let volume = real(scene.spacing * scene.spacing);
        pull.iter().any(|&pull| pull > 0.0).then(|| Adhesion {
            coverage: Coverage::new(&kernel),
            kernel,
            volume,
            pull,
            applied: false,
        })
    }

    /// The displacement by the pull of walls and bodies, over dt^2 [m/s^2].
    fn acceleration(&self, now: Substep<'_>, row: usize) -> Vector {
        let particles = now.particles;
        let pull = self.pull[usize::from(particles.materials()[row])];
        if pull == 0.0 || particles.inverse_masses()[row] == 0.0 {
            return Vector::ZERO;
        }
        let x = particles.positions()[row];
        let mut sum = now.walls.coverage(x, &self.coverage).1;
        now.neighbors.for_each(row, |other| {
            if particles.phases()[other] == Phase::Rigid {
                let apart = now.neighbors.periodic().min_image(x - particles.positions()[other]);
                sum += apart * (self.kernel.slope(apart.length()) * self.volume);
            }
        });
        sum * pull
    }

    /// The pull of the liquid around it on a sample of a body [N].
    fn reaction(&self, now: Substep<'_>, row: usize) -> Vector {
        let particles = now.particles;
        let (x, mut sum) = (particles.positions()[row], Vector::ZERO);
        now.neighbors.for_each(row, |other| {
            let pull = self.pull[usize::from(particles.materials()[other])];
            let inverse_mass = particles.inverse_masses()[other];
            if pull > 0.0 && inverse_mass > 0.0 {
                let apart = now.neighbors.periodic().min_image(x - particles.positions()[other]);
                sum += apart * (self.kernel.slope(apart.length()) * self.volume * pull / inverse_mass);
            }
        });
        sum
    }

    fn load_walls(&self, now: Substep<'_>, out: &mut Corrections) {
        if out.wall_loads().is_empty() {
            return;
        }
        let particles = now.particles;
        for row in 0..particles.dense() {
            let inverse_mass = particles.inverse_masses()[row];
            let pull = self.pull[usize::from(particles.materials()[row])];
            if pull > 0.0 && inverse_mass > 0.0 {
                let scale = -pull * now.dt * now.dt / inverse_mass;
                now.walls.shares(particles.positions()[row], &self.coverage, |wall, slope| {
                    out.wall_loads_mut()[usize::from(wall)] += wide(slope * scale);
                });
            }
        }
    }
}

impl ConstraintGroup for Adhesion {
    fn name(&self) -> &str {
        "adhesion"
    }

    fn needs(&self) -> Needs {
        Needs::NEIGHBORS
    }

    fn begin_substep(&mut self, _: Substep<'_>) {
        self.applied = false;
    }

    fn project(&mut self, now: Substep<'_>, out: &mut Corrections) {
        if std::mem::replace(&mut self.applied, true) {
            return;
        }
        let (square, rows, phases) = (now.dt * now.dt, now.particles.dense(), now.particles.phases());
        now.parallelism.update(&mut out.displacements_mut()[..rows], |row, displacement| {
            *displacement += self.acceleration(now, row) * square;
        });
        now.parallelism.update(out.loads_mut(), |row, load| {
            if phases[row] == Phase::Rigid {
                *load += self.reaction(now, row) * square;
            }
        });
        self.load_walls(now, out);
    }
}
