use crate::constraints::Substep;
use crate::kernel::Kernel;
use crate::math::{Real, Vector};
use crate::scene::Scene;

/// Smoke moves with the carrier around it (Macklin et al. 2014, equation 28):
/// v_s = sum_j v_j W_sj / sum_j W_sj over the dense particles; without any, it keeps its velocity.
///
/// Positions follow the second-order Adams-Bashforth rule, so one evaluation per substep keeps a
/// marker on its circle, and the stored velocity is (28) at the stored position.
pub struct SmokeAdvection {
    kernel: Kernel,
    last_dt: Real,
}

/// A marker at the end of a substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advected {
    /// Position [m].
    pub position: Vector,
    /// Velocity of the carrier there [m/s].
    pub velocity: Vector,
}

impl SmokeAdvection {
    /// For the kernel of a scene.
    pub fn new(scene: &Scene) -> Self {
        SmokeAdvection { kernel: Kernel::new(scene.solver.kernel_radius * scene.spacing), last_dt: 0.0 }
    }

    /// Length of the last substep [s], 0 before the first: part of a saved state.
    pub fn last_dt(&self) -> Real {
        self.last_dt
    }

    /// Sets the length of the last substep [s].
    pub fn set_last_dt(&mut self, last_dt: Real) {
        self.last_dt = last_dt;
    }

    /// Moves a marker by its velocities now and `before`, one substep ago.
    pub fn advect(&self, now: Substep<'_>, position: Vector, velocity: Vector, before: Vector) -> Advected {
        let ratio = if self.last_dt > 0.0 { 0.5 * now.dt / self.last_dt } else { 0.0 };
        let moved = position + (velocity + (velocity - before) * ratio) * now.dt;
        let position = now.neighbors.periodic().wrap(now.walls.clamp(moved));
        Advected { position, velocity: self.carrier_velocity(now, position).unwrap_or(velocity) }
    }

    /// Velocity of the carrier at a point [m/s]; `None` without carrier in reach.
    pub fn carrier_velocity(&self, now: Substep<'_>, point: Vector) -> Option<Vector> {
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let periodic = now.neighbors.periodic();
        let (mut sum, mut weights) = (Vector::ZERO, 0.0);
        now.neighbors.for_each_near(point, self.kernel.radius(), |j| {
            let weight = self.kernel.value(periodic.min_image(point - positions[j]).length());
            sum += velocities[j] * weight;
            weights += weight;
        });
        (weights > 0.0).then(|| sum / weights)
    }
}
