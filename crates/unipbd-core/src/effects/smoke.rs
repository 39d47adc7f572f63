use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::kernel::WendlandC2;
use crate::math::{Real, Vector};
use crate::neighbors::near::{self, Near, Work};
use crate::neighbors::weigh::{At, Weighed};
use crate::scene::Scene;
use crate::simd::Level;
use crate::simd::space::{Open, Space, Wrapped};

/// Smoke moves with the carrier around it (Macklin et al. 2014, equation 28):
/// v_s = sum_j v_j W_sj / sum_j W_sj over the dense particles; without any, it keeps its velocity.
///
/// Positions follow the second-order Adams-Bashforth rule, so one evaluation per substep keeps a
/// marker on its circle, and the stored velocity is (28) at the stored position.
pub struct SmokeAdvection {
    kernel: Kernel,
    last_dt: Real,
    advected: Vec<Advected>,
}

/// A marker at the end of a substep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advected {
    /// Position \[m].
    pub position: Vector,
    /// Velocity of the carrier there [m/s].
    pub velocity: Vector,
}

impl SmokeAdvection {
    /// For the kernel of a scene.
    pub fn new(scene: &Scene) -> Self {
        let kernel = Kernel::new(scene.solver.kernel_radius * scene.spacing);
        SmokeAdvection { kernel, last_dt: 0.0, advected: Vec::new() }
    }

    /// Length of the last substep \[s], 0 before the first: part of a saved state.
    pub fn last_dt(&self) -> Real {
        self.last_dt
    }

    /// Sets the length of the last substep \[s].
    pub fn set_last_dt(&mut self, last_dt: Real) {
        self.last_dt = last_dt;
    }

    /// Where the loose rows are at the end of the substep, in order; right for smoke only.
    pub fn advect(&mut self, now: Substep<'_>) -> &[Advected] {
        let mut advected = std::mem::take(&mut self.advected);
        let dense = now.particles.dense();
        advected.resize(now.particles.len() - dense, Advected::default());
        let periodic = now.neighbors.periodic();
        now.parallelism.chunks(&mut advected, |first, out| {
            let (smoke, first) = (&*self, dense + first);
            if periodic.any() {
                near::dispatch(Level::best(), Chunk { smoke, now, space: Wrapped::new(periodic), first, out });
            } else {
                near::dispatch(Level::best(), Chunk { smoke, now, space: Open, first, out });
            }
        });
        self.advected = advected;
        &self.advected
    }

    /// Moves a marker by its velocities now and `before`, one substep ago.
    fn moved(&self, now: Substep<'_>, position: Vector, velocity: Vector, before: Vector) -> Vector {
        let ratio = if self.last_dt > 0.0 { 0.5 * now.dt / self.last_dt } else { 0.0 };
        let moved = position + (velocity + (velocity - before) * ratio) * now.dt;
        now.neighbors.periodic().wrap(now.walls.clamp(position, moved))
    }
}

/// Loose rows from `first` on, to be advected by one task.
struct Chunk<'a, S> {
    smoke: &'a SmokeAdvection,
    now: Substep<'a>,
    space: S,
    first: usize,
    out: &'a mut [Advected],
}

impl<S: Space> Work for Chunk<'_, S> {
    #[inline(always)]
    fn run<N: Near>(self, near: N) {
        let Chunk { smoke, now, space, first, out } = self;
        let particles = now.particles;
        let dense = particles.dense();
        let (positions, vectors) = (&particles.position[..dense], &particles.velocity[..dense]);
        let kernel: WendlandC2 = smoke.kernel.shape();
        for (row, out) in (first..).zip(out) {
            let velocity = particles.velocity[row];
            let point = smoke.moved(now, particles.position[row], velocity, particles.displacement[row]);
            let at = At { space, kernel, point, positions, vectors };
            let mut sums = Weighed::default();
            // No closure here: it would miss the instruction set.
            for run in now.neighbors.runs_near(point).iter() {
                near.weigh(&at, run, &mut sums);
            }
            let weight = sums.weight();
            let carried = if weight > 0.0 { sums.vector() / weight } else { velocity };
            *out = Advected { position: point, velocity: carried };
        }
    }
}
