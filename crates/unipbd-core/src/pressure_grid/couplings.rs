//! Couplings between the cells of a grid.

use crate::math::Real;

/// Couplings by cell; all are zero where there is no liquid.
#[derive(Default)]
pub(super) struct Couplings {
    /// With the cell to the right.
    pub right: Vec<Real>,
    /// With the cell above.
    pub upper: Vec<Real>,
    /// With air.
    pub air: Vec<Real>,
}
