//! Fluids are made ready for bodies when the first comes to a scene that has none.

use super::fluid_parts::FluidParts;
use super::world::{Measured, World};

impl World {
    /// Makes fluids ready for the first body.
    pub fn await_bodies(&mut self) {
        if self.parts.sample_material.is_none()
            && let Some(remake) = &self.parts.remake
        {
            let with_bodies = remake(true);
            self.set_fluid_parts(with_bodies);
        }
    }

    /// Takes these parts in place of those that there are; groups and effects from outside stay.
    pub fn set_fluid_parts(&mut self, new: FluidParts) {
        let parts = &mut self.parts;
        (parts.materials, parts.forces) = (new.materials, new.forces);
        (parts.search_positions, parts.pressure_grid) = (new.search_positions, new.pressure_grid);
        (parts.removal, parts.substeps, parts.sample_material) = (new.removal, new.substeps, new.sample_material);
        for mut group in new.groups {
            // Those of the scene come first.
            if let Some(old) = parts.groups.iter_mut().find(|old| old.name() == group.name()) {
                group.restore(&old.save());
                *old = group;
            }
        }
        parts.effects.iter_mut().zip(new.effects).for_each(|(old, effect)| *old = effect);
        self.measured = Measured::default();
        self.set_gravity(self.parts.exact_gravity);
    }
}
