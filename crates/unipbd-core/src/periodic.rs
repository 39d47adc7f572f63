//! Domains that repeat along one or both axes.

use crate::math::{Real, Vector};

/// An axis that repeats itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicAxis {
    /// Where the period starts \[m].
    pub from: Real,
    /// Its length \[m].
    pub length: Real,
}

impl PeriodicAxis {
    /// The shortest of a difference and its images, for points at most half a period outside the domain.
    #[inline(always)]
    pub fn min_image(self, difference: Real) -> Real {
        let half = self.length * 0.5;
        let down = if difference > half { self.length } else { 0.0 };
        let up = if difference < -half { self.length } else { 0.0 };
        (difference - down) + up
    }

    /// The image of a coordinate inside the domain.
    #[inline]
    pub fn wrap(self, x: Real) -> Real {
        let end = self.from + self.length;
        if x >= self.from && x < end {
            return x;
        }
        let periods = ((x - self.from) / self.length).floor();
        let inside = x - periods * self.length;
        // Rounding can leave a point just outside on either side.
        if inside >= end || inside < self.from { self.from } else { inside }
    }
}

/// Which axes repeat, if any.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Periodic {
    /// Period along x.
    pub x: Option<PeriodicAxis>,
    /// Period along y.
    pub y: Option<PeriodicAxis>,
}

impl Periodic {
    /// No axis repeats.
    pub const NONE: Periodic = Periodic { x: None, y: None };

    /// Whether any axis repeats.
    pub fn any(self) -> bool {
        self.x.is_some() || self.y.is_some()
    }

    /// The shortest image of the difference of two points at most half a period outside the domain.
    #[inline(always)]
    pub fn min_image(self, difference: Vector) -> Vector {
        Vector::new(
            self.x.map_or(difference.x, |axis| axis.min_image(difference.x)),
            self.y.map_or(difference.y, |axis| axis.min_image(difference.y)),
        )
    }

    /// The image of a point inside the domain.
    #[inline]
    pub fn wrap(self, point: Vector) -> Vector {
        Vector::new(
            self.x.map_or(point.x, |axis| axis.wrap(point.x)),
            self.y.map_or(point.y, |axis| axis.wrap(point.y)),
        )
    }

    /// Whether the nearest image is the only one within `radius`: every period is at least twice as long.
    pub fn admits(self, radius: Real) -> bool {
        let fits = |axis: Option<PeriodicAxis>| axis.is_none_or(|axis| axis.length >= 2.0 * radius);
        fits(self.x) && fits(self.y)
    }
}
