//! Removal of particles at the start of a frame.

use super::world::World;

impl World {
    /// Removes the particles that the rules of the scene name.
    pub(super) fn remove(&mut self) {
        let Some(rules) = &mut self.parts.removal else { return };
        rules.find(&self.parts.particles, self.clock.time, self.parts.parallelism, &mut self.removed);
        if !self.removed.is_empty() {
            let places = self.places(&self.removed);
            self.parts.particles.remove_rows(&self.removed);
            self.population_changed();
            self.wake_near(&places);
        }
    }
}
