//! The bounding box of many vectors.

use super::Parallelism;
use crate::math::{Real, Vector, smaller};

/// Vectors looked at side by side, so that they fill the vectors of the machine.
pub(crate) const GROUP: usize = 4;

/// The bounding box of vectors, gathered in four lanes.
#[derive(Clone, Copy)]
pub(crate) struct Aabb {
    low: [Vector; GROUP],
    high: [Vector; GROUP],
    /// Not a number where any vector is infinite or not a number, else zero.
    strange: [Vector; GROUP],
}

impl Aabb {
    pub const NONE: Aabb = Aabb {
        low: [Vector::splat(Real::INFINITY); GROUP],
        high: [Vector::splat(Real::NEG_INFINITY); GROUP],
        strange: [Vector::ZERO; GROUP],
    };

    /// That of all points.
    pub fn of(points: &[Vector], parallelism: Parallelism) -> Aabb {
        let of_rows = |points: &[Vector]| {
            let (mut spread, (groups, rest)) = (Aabb::NONE, points.as_chunks::<GROUP>());
            groups.iter().for_each(|group| spread.add(group));
            if let Some(last) = rest.len().checked_sub(1) {
                spread.add(&std::array::from_fn(|k| rest[k.min(last)]));
            }
            spread
        };
        parallelism.reduce(points.len(), |rows| of_rows(&points[rows]), Aabb::join)
    }

    #[inline(always)]
    pub fn add(&mut self, points: &[Vector; GROUP]) {
        for (k, &point) in points.iter().enumerate() {
            self.low[k] = lower(point, self.low[k]);
            self.high[k] = -lower(-point, -self.high[k]);
            self.strange[k] += point * 0.0;
        }
    }

    pub fn join(self, other: Aabb) -> Aabb {
        Aabb {
            low: std::array::from_fn(|k| lower(self.low[k], other.low[k])),
            high: std::array::from_fn(|k| -lower(-self.high[k], -other.high[k])),
            strange: std::array::from_fn(|k| self.strange[k] + other.strange[k]),
        }
    }

    /// The lower left and the upper right corner. NaN is passed over.
    pub fn corners(&self) -> (Vector, Vector) {
        let low = self.low.into_iter().reduce(lower).unwrap_or_default();
        let high = self.high.into_iter().map(|high| -high).reduce(lower).unwrap_or_default();
        (low, -high)
    }

    /// Whether all vectors were finite.
    pub fn is_finite(&self) -> bool {
        self.strange.iter().all(|strange| *strange == Vector::ZERO)
    }
}

/// The smaller of each coordinate.
#[inline(always)]
fn lower(a: Vector, b: Vector) -> Vector {
    Vector::new(smaller(a.x, b.x), smaller(a.y, b.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_hold_all_points_and_what_is_not_finite_is_told() {
        let mut points: Vec<Vector> = (0..13).map(|k| Vector::new(k as Real, -2.0 * k as Real)).collect();
        let of = |points: &[Vector]| Aabb::of(points, Parallelism::Serial);
        assert_eq!(of(&points).corners(), (Vector::new(0.0, -24.0), Vector::new(12.0, 0.0)));
        assert!(of(&points).is_finite());
        points[12].x = Real::NAN;
        assert_eq!(of(&points).corners().1, Vector::new(11.0, 0.0));
        assert!(!of(&points).is_finite());
        points[3] = Vector::new(0.0, Real::NEG_INFINITY);
        assert!(!of(&points[..5]).is_finite());
    }
}
