//! Differences of points, in an open or a periodic domain.

use super::Number;
use crate::math::Real;
use crate::periodic::{Periodic, PeriodicAxis};

/// Turns a difference of coordinates into that of the nearest images.
pub(crate) trait Space: Copy + Send + Sync {
    fn shortest<N: Number>(self, x: N, y: N) -> (N, N);
}

/// A domain without periods: it adds no cost to scenes without periodic axes.
#[derive(Clone, Copy)]
pub(crate) struct Open;

impl Space for Open {
    #[inline(always)]
    fn shortest<N: Number>(self, x: N, y: N) -> (N, N) {
        (x, y)
    }
}

/// A domain with a period along one or both axes.
#[derive(Clone, Copy)]
pub(crate) struct Wrapped {
    x: Wrap,
    y: Wrap,
}

#[derive(Clone, Copy)]
struct Wrap {
    length: Real,
    half: Real,
}

impl Wrap {
    fn new(axis: Option<PeriodicAxis>) -> Wrap {
        axis.map_or(Wrap { length: 0.0, half: Real::INFINITY }, |axis| Wrap {
            length: axis.length,
            half: axis.length * 0.5,
        })
    }

    #[inline(always)]
    fn shortest<N: Number>(self, difference: N) -> N {
        let (zero, length) = (difference.like(0.0), difference.like(self.length));
        let down = difference.like(self.half).where_below(difference, length, zero);
        let up = difference.where_below(difference.like(-self.half), length, zero);
        (difference - down) + up
    }
}

impl Wrapped {
    pub(crate) fn new(periodic: Periodic) -> Wrapped {
        Wrapped { x: Wrap::new(periodic.x), y: Wrap::new(periodic.y) }
    }
}

impl Space for Wrapped {
    #[inline(always)]
    fn shortest<N: Number>(self, x: N, y: N) -> (N, N) {
        (self.x.shortest(x), self.y.shortest(y))
    }
}
