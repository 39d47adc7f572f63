//! The surfaces of the measured walls, for sums along them.

use super::{Plane, Rectangle, Walls};
use crate::math::{Real, Vector};

/// A straight part of the surface of a measured wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surface {
    /// Number of the wall among the measured ones.
    pub wall: u16,
    /// Ends \[m].
    pub ends: [Vector; 2],
    /// Direction out of the wall, of length 1.
    pub normal: Vector,
}

impl Walls {
    /// Visits the surfaces of the measured walls within a box.
    pub(crate) fn measured_surfaces(&self, [low, high]: [Vector; 2], mut visit: impl FnMut(Surface)) {
        for plane in &self.planes {
            if let Some(wall) = plane.measured
                && let Some(ends) = plane.within(low, high)
            {
                visit(Surface { wall, ends, normal: plane.normal });
            }
        }
        for rectangle in &self.rectangles {
            if let Some(wall) = rectangle.measured {
                for (ends, normal) in rectangle.sides() {
                    let ends = ends.map(|end| end.clamp(low, high));
                    if ends[0] != ends[1] {
                        visit(Surface { wall, ends, normal });
                    }
                }
            }
        }
    }
}

impl Plane {
    /// The part of its surface within a box.
    fn within(&self, low: Vector, high: Vector) -> Option<[Vector; 2]> {
        let along = self.normal.perp();
        let (mut from, mut to) = (Real::NEG_INFINITY, Real::INFINITY);
        for axis in [0, 1] {
            let (place, step) = (self.point[axis], along[axis]);
            if step.abs() < 1e-6 {
                if place < low[axis] || place > high[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low[axis] - place) / step, (high[axis] - place) / step);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from < to).then(|| [self.point + along * from, self.point + along * to])
    }
}

impl Rectangle {
    /// Its four sides, each with the direction out.
    fn sides(&self) -> [([Vector; 2], Vector); 4] {
        let (low, high) = (self.min, self.max);
        let (lower_right, upper_left) = (Vector::new(high.x, low.y), Vector::new(low.x, high.y));
        [
            ([low, lower_right], Vector::NEG_Y),
            ([lower_right, high], Vector::X),
            ([high, upper_left], Vector::Y),
            ([upper_left, low], Vector::NEG_X),
        ]
    }
}
