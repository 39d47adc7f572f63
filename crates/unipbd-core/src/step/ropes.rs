//! Ropes that come, change and go.

use super::Solver;
use super::world::World;
use crate::coupling::{RopeReading, Ropes};

impl World {
    /// Takes these ropes in place of those that there are: their constraints stay before groups from outside.
    pub fn set_ropes(&mut self, ropes: Ropes) {
        let parts = &mut self.parts;
        let (groups, old) = (ropes.groups(), parts.rope_groups.clone());
        parts.rope_groups = old.start..old.start + groups.len();
        drop(parts.groups.splice(old, groups));
        parts.ropes = ropes;
    }
}

impl Solver {
    /// The ropes, in the order in which they came; those that were taken away too.
    pub fn ropes(&self) -> Vec<RopeReading> {
        self.world.parts.ropes.readings()
    }
}
