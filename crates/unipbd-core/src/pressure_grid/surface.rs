//! The pressure at the free surface, which lies between cells.

use crate::math::Real;

/// Least distance of the free surface from a cell, as a part of the distance of two cells.
const NEAREST_SURFACE: Real = 0.1;
/// Greatest factor of the coupling with air where a body covers a part of the face: the force on the body has none.
const NEAREST_BESIDE_BODIES: Real = 0.5;
/// Covered part of a face from which on this holds.
const BESIDE_BODY: Real = 0.05;

/// Ghost-pressure factor next to air, at a face of which bodies cover this part: the pressure is zero at the free
/// surface, not at the centre of the next cell.
#[inline(always)]
pub(super) fn ghost(liquid: Real, air: Real, covered: Real) -> Real {
    let nearest = if covered > BESIDE_BODY { NEAREST_BESIDE_BODIES } else { NEAREST_SURFACE };
    1.0 / (liquid / (liquid - air)).clamp(nearest, 1.0)
}

/// Distance from a flat free surface, in cells, of a cell with this fill fraction; exact along an axis.
#[inline(always)]
pub(super) fn depth_of(fill: Real) -> Real {
    let missing = 1.0 - fill;
    if missing <= 0.0 {
        1.0
    } else if fill < 0.5 {
        (2.0 * fill).sqrt() - 1.0
    } else {
        1.0 - (2.0 * missing).sqrt()
    }
}
