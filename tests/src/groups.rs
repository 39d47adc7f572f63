//! Constraint groups, written from outside as a user would, that set velocities.

use unipbd_core::Vector;
use unipbd_core::constraints::{ConstraintGroup, Corrections, Needs, Substep};
use unipbd_core::math::{Vector64, vector, wide};

/// Gives every dense particle the velocity of a field, in every substep.
pub struct Prescribed<F>(pub F);

impl<F: Fn(Vector64) -> Vector64 + Send + Sync> ConstraintGroup for Prescribed<F> {
    fn name(&self) -> &str {
        "prescribed"
    }

    fn needs(&self) -> Needs {
        Needs::VELOCITY_PASS
    }

    fn project(&mut self, _: Substep<'_>, _: &mut Corrections) {}

    fn finish_velocities(&mut self, now: Substep<'_>, velocities: &mut [Vector]) {
        let particles = now.particles;
        for (velocity, position) in velocities[..particles.dense()].iter_mut().zip(particles.positions()) {
            *velocity = vector(self.0(wide(*position)));
        }
    }
}

/// Gives every dense particle the velocity of a field once, at the end of the first substep.
pub struct Kick<F> {
    field: F,
    done: bool,
}

impl<F> Kick<F> {
    /// A kick by this field.
    pub fn new(field: F) -> Self {
        Kick { field, done: false }
    }
}

impl<F: Fn(Vector64) -> Vector64 + Send + Sync> ConstraintGroup for Kick<F> {
    fn name(&self) -> &str {
        "kick"
    }

    fn needs(&self) -> Needs {
        Needs::VELOCITY_PASS
    }

    fn project(&mut self, _: Substep<'_>, _: &mut Corrections) {}

    fn finish_velocities(&mut self, now: Substep<'_>, velocities: &mut [Vector]) {
        if !std::mem::replace(&mut self.done, true) {
            Prescribed(&self.field).finish_velocities(now, velocities);
        }
    }
}
