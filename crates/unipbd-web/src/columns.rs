//! Columns of numbers that a page reads where they lie.

use unipbd_core::Vector;
use unipbd_core::math::direction;

use crate::Session;

/// A column. Rows are particles in an order that changes from frame to frame; ids are stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Two numbers each \[m].
    Positions,
    /// Two numbers each [m/s].
    Velocities,
    /// Fractions: positive where a fluid is compressed.
    DensityErrors,
    /// Empty where no material has one.
    Temperatures,
    /// Ids.
    Ids,
    /// Numbers of materials in the description of the scene.
    Materials,
    /// Of each body: x, y \[m], angle \[rad], and 1, or 0 for one that was taken away.
    Poses,
    /// Of each body: the number of corners, then theirs in the world \[m]; a disc has 1 corner, its centre, then radius
    /// \[m] and angle \[rad]; one that was taken away has 0.
    Outlines,
}

impl Column {
    /// All columns, in the order of their numbers.
    pub const ALL: [Column; 8] = [
        Column::Positions,
        Column::Velocities,
        Column::DensityErrors,
        Column::Temperatures,
        Column::Ids,
        Column::Materials,
        Column::Poses,
        Column::Outlines,
    ];
}

/// The values of a column.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// Pairs of numbers.
    Pairs(&'a [Vector]),
    /// Single precision.
    Single(&'a [f32]),
    /// Double precision.
    Double(&'a [f64]),
    /// 32 bits.
    Words(&'a [u32]),
    /// 16 bits.
    Halves(&'a [u16]),
}

impl Values<'_> {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Values::Pairs(values) => 2 * values.len(),
            Values::Single(values) => values.len(),
            Values::Double(values) => values.len(),
            Values::Words(values) => values.len(),
            Values::Halves(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where they lie: until the next change of the run.
    pub fn place(&self) -> *const u8 {
        match self {
            Values::Pairs(values) => values.as_ptr().cast(),
            Values::Single(values) => values.as_ptr().cast(),
            Values::Double(values) => values.as_ptr().cast(),
            Values::Words(values) => values.as_ptr().cast(),
            Values::Halves(values) => values.as_ptr().cast(),
        }
    }
}

impl Session {
    /// A column of the run as it is now.
    pub fn column(&mut self, column: Column) -> Values<'_> {
        match column {
            Column::Positions => Values::Pairs(self.solver.positions()),
            Column::Velocities => Values::Pairs(self.solver.velocities()),
            Column::DensityErrors => Values::Single(self.solver.density_errors()),
            Column::Temperatures => Values::Single(self.solver.temperatures()),
            Column::Ids => Values::Words(self.solver.ids()),
            Column::Materials => Values::Halves(self.solver.material_indices()),
            Column::Poses => {
                self.find_poses();
                Values::Double(&self.poses)
            }
            Column::Outlines => {
                self.find_outlines();
                Values::Single(&self.outlines)
            }
        }
    }

    fn find_poses(&mut self) {
        self.poses.clear();
        for body in self.solver.bodies() {
            let there = if body.removed { 0.0 } else { 1.0 };
            self.poses.extend([body.position.x, body.position.y, body.angle, there]);
        }
    }

    fn find_outlines(&mut self) {
        self.outlines.clear();
        for body in self.solver.bodies() {
            let place = body.position;
            if body.removed {
                self.outlines.push(0.0);
            } else if body.radius > 0.0 {
                self.outlines.extend([1.0, place.x as f32, place.y as f32, body.radius as f32, body.angle as f32]);
            } else {
                let axis = direction(body.angle);
                self.outlines.push(body.outline.len() as f32);
                let corners = body.outline.iter().map(|corner| place + axis.rotate(*corner));
                self.outlines.extend(corners.flat_map(|corner| [corner.x as f32, corner.y as f32]));
            }
        }
    }
}
