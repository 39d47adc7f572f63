//! What the fluids of a run know of bodies: made when the first body comes to a scene that has none.

use super::integrate::BodyForce;
use super::substeps::SubstepRule;
use super::world::{Measured, World};
use crate::constraints::ConstraintGroup;
use crate::effects::Effect;
use crate::neighbors::SearchPositions;
use crate::observe::Material;
use crate::phase::MaterialIndex;
use crate::pressure_grid::PressureGrid;
use crate::sources::RemovalRules;

/// Makes the parts of a scene of fluids with bodies, or without.
pub(crate) type Remake = Box<dyn Fn(bool) -> FluidParts + Send + Sync>;

/// The parts of a scene of fluids that depend on whether there are bodies.
pub(crate) struct FluidParts {
    pub materials: Vec<Material>,
    pub forces: Vec<BodyForce>,
    pub search_positions: SearchPositions,
    pub pressure_grid: Option<PressureGrid>,
    /// Groups of the fluids, without ropes and groups from outside.
    pub groups: Vec<Box<dyn ConstraintGroup>>,
    pub effects: Vec<Box<dyn Effect>>,
    pub removal: Option<RemovalRules>,
    pub substeps: SubstepRule,
    pub sample_material: Option<MaterialIndex>,
}

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
