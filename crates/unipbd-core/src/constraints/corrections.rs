use crate::math::Vector;

/// Displacements that a group wants, by row [m]. Added up, then applied by the loop at once.
#[derive(Clone, Debug, Default)]
pub struct Corrections {
    displacement: Vec<Vector>,
}

impl Corrections {
    /// Displacements by row.
    pub fn displacements(&self) -> &[Vector] {
        &self.displacement
    }

    /// Displacements by row, to be written.
    pub fn displacements_mut(&mut self) -> &mut [Vector] {
        &mut self.displacement
    }

    /// Adds a displacement to one row.
    pub fn add(&mut self, row: usize, displacement: Vector) {
        self.displacement[row] += displacement;
    }

    /// Back to zero for this many rows.
    pub(crate) fn reset(&mut self, rows: usize) {
        self.displacement.clear();
        self.displacement.resize(rows, Vector::ZERO);
    }
}
