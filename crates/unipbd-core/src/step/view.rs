use super::access::shared_access;
use super::world::World;
use crate::math::{Real, Vector, Vector64};
use crate::rigid::{Bodies, Pose, Twist};

/// A run at the start of a substep, as passed to a hook
/// (see [`Solver::step_frame_with`](crate::Solver::step_frame_with)).
pub struct SubstepView<'a> {
    world: &'a mut World,
}

shared_access!(SubstepView<'_>);

impl<'a> SubstepView<'a> {
    pub(super) fn new(world: &'a mut World) -> Self {
        SubstepView { world }
    }

    /// Length of the substep \[s].
    pub fn dt(&self) -> f64 {
        self.world.clock.dt
    }

    /// The speed from which on a run counts as diverged [m/s]: a million spacings in a frame.
    pub fn speed_limit(&self) -> f64 {
        self.world.speed_limit()
    }

    /// Adds to the acceleration of one row in this substep [m/s^2]. It has no effect on kinematic particles and
    /// smoke.
    pub fn add_acceleration(&mut self, row: usize, acceleration: Vector) {
        self.accelerations_mut()[row] += acceleration;
    }

    /// Accelerations by row in this substep, beside the gravity of the scene [m/s^2].
    pub fn accelerations_mut(&mut self) -> &mut [Vector] {
        self.world.parts.particles.accelerations_mut()
    }

    /// Sets the velocity of one row [m/s]: this moves a kinematic particle. The position
    /// follows in this substep.
    ///
    /// # Panics
    /// If the velocity is not finite.
    pub fn set_velocity(&mut self, row: usize, velocity: Vector) {
        assert!(velocity.is_finite(), "velocities are finite");
        self.world.parts.particles.velocity[row] = velocity;
    }

    /// Inverse mass of one row [1/kg]; 0 for a kinematic particle.
    pub fn inverse_mass(&self, row: usize) -> Real {
        self.particles().inverse_masses()[row]
    }

    /// Centre of mass and angle of a body, given by its index in [`SubstepView::bodies`].
    ///
    /// # Panics
    /// If there is no such body.
    pub fn body_pose(&self, body: u32) -> Pose {
        self.all_bodies().pose(body)
    }

    /// Velocity of the centre of mass and angular velocity of a body.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn body_velocity(&self, body: u32) -> Twist {
        self.all_bodies().velocity(body)
    }

    /// Applies a force \[N] and a torque about the centre of mass [N m] to a body in this substep. Only a
    /// dynamic body is moved.
    ///
    /// # Panics
    /// If there is no such body, or the load is not finite.
    pub fn push_body(&mut self, body: u32, force: Vector64, torque: f64) {
        assert!(force.is_finite() && torque.is_finite(), "loads are finite");
        let dt = self.dt();
        self.all_bodies_mut().accelerate(body, force, torque, dt);
    }

    /// Applies a force \[N] at a point of the world \[m] to a body in this substep. Only a dynamic body is moved.
    ///
    /// # Panics
    /// If there is no such body, or force or point are not finite.
    pub fn push_body_at(&mut self, body: u32, force: Vector64, point: Vector64) {
        assert!(point.is_finite(), "points are finite");
        let arm = point - self.body_pose(body).position;
        self.push_body(body, force, arm.perp_dot(force));
    }

    /// Sets the velocity of a body: this moves a kinematic body. It keeps this velocity until another one is set.
    ///
    /// # Panics
    /// If there is no such body, or the velocity is not finite.
    pub fn set_body_velocity(&mut self, body: u32, velocity: Twist) {
        assert!(velocity.linear.is_finite() && velocity.angular.is_finite(), "velocities are finite");
        self.all_bodies_mut().set_velocity(body, velocity);
    }

    fn all_bodies(&self) -> &Bodies {
        &self.world.parts.rigid.as_ref().expect("the scene has bodies").bodies
    }

    fn all_bodies_mut(&mut self) -> &mut Bodies {
        &mut self.world.parts.rigid.as_mut().expect("the scene has bodies").bodies
    }
}
