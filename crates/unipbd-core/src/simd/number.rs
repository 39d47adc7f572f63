//! One number or several lanes: the type that the formulas of a pair are generic over.

use crate::math::{Real, larger};
use std::ops::{Add, Div, Mul, Sub};

/// A number, or eight of them: the type used in the formulas of a pair.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// A constant.
    fn like(self, value: Real) -> Self;
    /// The exactly rounded square root.
    fn sqrt(self) -> Self;
    /// `self` where it is greater than `other`, else `other`: never NaN if `other` is not.
    fn larger(self, other: Self) -> Self;
    /// `yes` where `self < limit`, else `no`.
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self;
}

impl Number for Real {
    #[inline(always)]
    fn like(self, value: Real) -> Real {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Real {
        Real::sqrt(self)
    }
    #[inline(always)]
    fn larger(self, other: Real) -> Real {
        larger(self, other)
    }
    #[inline(always)]
    fn where_below(self, limit: Real, yes: Real, no: Real) -> Real {
        if self < limit { yes } else { no }
    }
}
