//! From coordinates to cells. The plane is cut into rows as high as the search radius, and each row
//! into narrower bins, so that a search reads one stretch of each of three rows.

use crate::math::{Real, Vector};
use crate::periodic::{Periodic, PeriodicAxis};

/// Bins per row height: narrow bins keep the stretches of a row tight.
const BINS_PER_ROW_HEIGHT: Real = 4.0;

/// Cell numbers stay within this, so that sums of a few never overflow; points beyond share the last cell.
const FARTHEST: Real = 1_073_741_824.0;

/// One axis of the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Cells per metre.
    inverse: Real,
    /// The period, and the number of cells in it.
    period: Option<(PeriodicAxis, i32)>,
}

/// Cells from `first` to `last`, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub first: i32,
    pub last: i32,
}

impl Axis {
    fn new(side: Real, periodic: Option<PeriodicAxis>) -> Axis {
        match periodic {
            None => Axis { inverse: 1.0 / side, period: None },
            Some(axis) => {
                let count = (axis.length / side).clamp(1.0, FARTHEST) as i32;
                Axis { inverse: count as Real / axis.length, period: Some((axis, count)) }
            }
        }
    }

    /// The cell of a coordinate. Monotonic on an axis without a period; NaN gives cell 0.
    #[inline(always)]
    pub fn cell(&self, x: Real) -> i32 {
        match self.period {
            None => floor(x * self.inverse),
            Some((axis, count)) => floor((axis.wrap(x) - axis.from) * self.inverse).clamp(0, count - 1),
        }
    }

    /// The one or two stretches of cells that hold everything within `radius` of `low..=high`.
    #[inline(always)]
    pub fn near(&self, low: Real, high: Real, radius: Real) -> (Span, Option<Span>) {
        let Some((axis, count)) = self.period else {
            // Distances are rounded: a point within the radius may lie a few roundings outside it.
            let reach = radius * (1.0 + 8.0 * Real::EPSILON);
            return (Span { first: self.cell(low - reach), last: self.cell(high + reach) }, None);
        };
        let at = |x: Real| (axis.wrap(x) - axis.from) * self.inverse;
        let reach = radius * self.inverse + (0.001 + 16.0 * Real::EPSILON * count as Real);
        let (first, last) = (floor(at(low) - reach), floor(at(high) + reach));
        if i64::from(last) - i64::from(first) + 1 >= i64::from(count) {
            return (Span { first: 0, last: count - 1 }, None);
        }
        if first < 0 {
            (Span { first: 0, last }, Some(Span { first: first + count, last: count - 1 }))
        } else if last >= count {
            (Span { first: 0, last: last - count }, Some(Span { first, last: count - 1 }))
        } else {
            (Span { first, last }, None)
        }
    }
}

/// Largest whole number not above `u`, held within the range of cell numbers. (`Real::floor` is a
/// function call on x86-64 without SSE4.1.)
#[inline(always)]
fn floor(u: Real) -> i32 {
    let u = u.clamp(-FARTHEST, FARTHEST);
    let whole = u as i32;
    whole - i32::from(u < whole as Real)
}

/// Both axes: which row and bin a point is in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    pub rows: Axis,
    pub bins: Axis,
}

/// Row and bin of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cell {
    pub row: i32,
    pub bin: i32,
}

impl Cells {
    /// Cells for searches within `radius` \[m].
    pub fn new(radius: Real, periodic: Periodic) -> Cells {
        // A little more than the radius, so that rounding does not add a fourth row to a search.
        let side = (radius * 1.001).clamp(1e-30, 1e30);
        Cells { rows: Axis::new(side, periodic.y), bins: Axis::new(side / BINS_PER_ROW_HEIGHT, periodic.x) }
    }

    /// Whether a point beyond another along an axis is never in a cell before its.
    pub fn keep_order(&self) -> bool {
        self.rows.period.is_none() && self.bins.period.is_none()
    }

    #[inline(always)]
    pub fn cell(&self, point: Vector) -> Cell {
        Cell { row: self.rows.cell(point.y), bin: self.bins.cell(point.x) }
    }
}
