//! The flow between cells.

use crate::math::Real;

/// Velocities at the faces of cells.
pub(super) struct Flow<'a> {
    pub u: &'a [Real],
    pub v: &'a [Real],
    pub stride: usize,
}

impl Flow<'_> {
    pub fn neighbors(&self, cell: usize) -> [usize; 4] {
        [cell - 1, cell + 1, cell - self.stride, cell + self.stride]
    }

    /// Outflow of a cell.
    pub fn out_of(&self, cell: usize, [left, lower]: &[Vec<Real>; 2]) -> Real {
        let (right, upper) = (cell + 1, cell + self.stride);
        (self.u[right] * left[right] - self.u[cell] * left[cell])
            + (self.v[upper] * lower[upper] - self.v[cell] * lower[cell])
    }

    /// Minus the determinant of the velocity gradient, in cell units: the compression by curved paths. (The trace of the
    /// squared gradient is twice that where the flow has no divergence; but squares of noise add up.)
    pub fn squeeze(&self, cell: usize) -> Real {
        let [left, right, lower, upper] = self.neighbors(cell);
        let (u, v) =
            (|cell: usize| self.u[cell] + self.u[cell + 1], |cell: usize| self.v[cell] + self.v[cell + self.stride]);
        let (v_along_x, u_along_y) = (0.5 * (v(right) - v(left)), 0.5 * (u(upper) - u(lower)));
        let (ux, vy) = (self.u[cell + 1] - self.u[cell], self.v[cell + self.stride] - self.v[cell]);
        0.25 * v_along_x * u_along_y - ux * vy
    }
}
