//! Gravity of a run, and the acceleration of its frame of reference.

use super::integrate::BodyForce;
use super::world::World;
use crate::math::{Vector64, vector};
use crate::rigid::along_curve;

impl World {
    /// Changes gravity [m/s^2]; everything wakes.
    pub fn set_gravity(&mut self, gravity: Vector64) {
        self.parts.exact_gravity = gravity;
        self.feel(gravity + self.shaking_at(self.clock.time));
    }

    /// Takes over the acceleration of a scene that is shaken at a time \[s]. Sleeping particles would not feel it change.
    pub fn shake(&mut self, time: f64) {
        if !self.parts.shaking.is_empty() {
            self.feel(self.parts.exact_gravity + self.shaking_at(time));
        }
    }

    /// Wakes what sleeps where the acceleration changes in the coming frame.
    pub(super) fn wake_shaken(&mut self) {
        let [now, then] = [0.0, self.parts.frame_time].map(|later| self.shaking_at(self.clock.time + later));
        if now != then {
            self.wake_all();
        }
    }

    /// The acceleration that is added to gravity [m/s^2].
    fn shaking_at(&self, time: f64) -> Vector64 {
        along_curve(&self.parts.shaking, time).0.linear
    }

    fn feel(&mut self, gravity: Vector64) {
        let parts = &mut self.parts;
        parts.gravity = vector(gravity);
        for force in parts.forces.iter_mut().filter(|force| force.factor != 0.0) {
            *force = BodyForce::new(gravity, force.factor, force.thermal);
        }
        parts.effects.iter_mut().for_each(|effect| effect.set_gravity(vector(gravity)));
    }
}
