use crate::bytes::held;
use crate::math::{Vector, Vector64};
use std::ops::Range;

/// The parts of corrections that a scene has beside displacements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CorrectionParts {
    /// Rows may also be samples of bodies, which carry loads.
    pub loads: bool,
    /// The pressure grid shifts rows before the groups do.
    pub grid_shifts: bool,
    /// Number of measured walls.
    pub walls: usize,
    /// Number of outlines of bodies.
    pub outlines: usize,
    /// Number of those that viscous fluids do not slip along.
    pub without_slip: usize,
}

/// Load of a fluid on a body through its outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlineLoad {
    /// Force times dt^2 [kg m].
    pub force: Vector64,
    /// Torque about the origin of the outline, times dt^2 [kg m^2].
    pub torque: f64,
}

impl OutlineLoad {
    /// Adds a force times dt^2 [kg m] with this arm \[m].
    pub fn add(&mut self, force: Vector64, arm: Vector64) {
        self.force += force;
        self.torque += arm.perp_dot(force);
    }
}

/// The displacements and forces that a group asks for. They are summed, then applied by the loop at once.
#[derive(Clone, Debug, Default)]
pub struct Corrections {
    displacement: Vec<Vector>,
    shift: Vec<Vector>,
    parts: CorrectionParts,
    load: Vec<Vector>,
    wall_load: Vec<Vector64>,
    outline_load: Vec<OutlineLoad>,
    shear_load: Vec<OutlineLoad>,
}

impl Corrections {
    /// Displacements by row \[m].
    pub fn displacements(&self) -> &[Vector] {
        &self.displacement
    }

    /// Displacements by row, to be written \[m].
    pub fn displacements_mut(&mut self) -> &mut [Vector] {
        &mut self.displacement
    }

    /// Moves by row that velocities do not follow \[m]; empty where no group asks for them.
    pub fn shifts(&self) -> &[Vector] {
        &self.shift
    }

    /// Moves by row that velocities do not follow, to be written \[m].
    pub fn shifts_mut(&mut self) -> &mut [Vector] {
        self.shift.resize(self.displacement.len(), Vector::ZERO);
        &mut self.shift
    }

    /// Displacements, and moves that velocities do not follow, to be written \[m].
    pub(crate) fn both_mut(&mut self) -> (&mut [Vector], &mut [Vector]) {
        self.shift.resize(self.displacement.len(), Vector::ZERO);
        (&mut self.displacement, &mut self.shift)
    }

    /// Whether rows are moved in a way that their velocities do not follow.
    pub(crate) fn any_shifted(&self) -> bool {
        self.parts.grid_shifts || !self.shift.is_empty()
    }

    /// Forces on samples of rigid bodies times dt^2, by dense row [kg m]; empty in a scene without bodies.
    pub fn loads(&self) -> &[Vector] {
        &self.load
    }

    /// Forces on samples of rigid bodies times dt^2, by dense row, to be written [kg m].
    pub fn loads_mut(&mut self) -> &mut [Vector] {
        &mut self.load
    }

    /// Forces on the measured walls times dt^2 [kg m]; empty where none is measured.
    pub fn wall_loads(&self) -> &[Vector64] {
        &self.wall_load
    }

    /// Forces on the measured walls times dt^2, to be written [kg m].
    pub fn wall_loads_mut(&mut self) -> &mut [Vector64] {
        &mut self.wall_load
    }

    /// Loads of the outlines of bodies; empty where a fluid meets none.
    pub fn outline_loads(&self) -> &[OutlineLoad] {
        &self.outline_load
    }

    /// Loads of the outlines of bodies, to be written.
    pub fn outline_loads_mut(&mut self) -> &mut [OutlineLoad] {
        &mut self.outline_load
    }

    /// Loads by shear of the bodies that viscous fluids do not slip along.
    pub(crate) fn shear_loads(&self) -> &[OutlineLoad] {
        &self.shear_load
    }

    /// The same, to be written.
    pub(crate) fn shear_loads_mut(&mut self) -> &mut [OutlineLoad] {
        &mut self.shear_load
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        held(&self.displacement)
            + held(&self.shift)
            + held(&self.load)
            + held(&self.wall_load)
            + held(&self.outline_load)
            + held(&self.shear_load)
    }

    /// Adds a displacement to one row.
    pub fn add(&mut self, row: usize, displacement: Vector) {
        self.displacement[row] += displacement;
    }

    /// Selects the parts that the scene has.
    pub(crate) fn select(&mut self, parts: CorrectionParts) {
        self.parts = parts;
    }

    /// Clears the `written` bands of this many rows, and the loads of the first `listed` rows.
    pub(crate) fn reset(&mut self, rows: usize, written: [Range<usize>; 2], listed: usize) {
        self.displacement.resize(rows, Vector::ZERO);
        written.into_iter().for_each(|band| self.displacement[band].fill(Vector::ZERO));
        self.shift.clear();
        self.load.clear();
        self.load.resize(if self.parts.loads { listed } else { 0 }, Vector::ZERO);
        self.wall_load.clear();
        self.wall_load.resize(self.parts.walls, Vector64::ZERO);
        self.outline_load.clear();
        self.outline_load.resize(self.parts.outlines, OutlineLoad::default());
        self.shear_load.clear();
        self.shear_load.resize(self.parts.without_slip, OutlineLoad::default());
    }
}
