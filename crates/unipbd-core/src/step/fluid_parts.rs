//! The parts of the fluids of a run that depend on bodies.

use super::integrate::BodyForce;
use super::substeps::SubstepRule;
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
