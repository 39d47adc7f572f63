//! Smoothing kernels in two dimensions, written once for one number and for eight lanes.
//!
//! A kernel is a shape times a constant; the constant is applied once per row, not once per pair.

use crate::math::{Real, real};
use crate::simd::Number;
use std::f64::consts::PI;

/// A smoothing kernel W(r) that vanishes from its radius on, and its gradient grad W = g(r) x.
pub trait Shape: Copy + Send + Sync {
    /// W and g at a squared distance, each without its constant.
    fn at<N: Number>(&self, square: N) -> (N, N);
    /// The constant of W [1/m^2].
    fn value_scale(&self) -> Real;
    /// The constant of g [1/m^4].
    fn slope_scale(&self) -> Real;
}

/// q = r/h and 1 - q, not below zero.
#[inline(always)]
pub(crate) fn scaled<N: Number>(square: N, inverse_square: Real) -> (N, N) {
    let q = (square * square.like(inverse_square)).sqrt();
    (q, (q.like(1.0) - q).larger(q.like(0.0)))
}

/// Wendland C2 (Wendland 1995): W = 7/(pi h^2) (1-q)^4 (1+4q), g = -140/(pi h^4) (1-q)^3.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC2 {
    inverse_square: Real,
    value_scale: Real,
    slope_scale: Real,
}

impl WendlandC2 {
    /// The kernel of radius `radius` \[m].
    pub fn new(radius: f64) -> WendlandC2 {
        let square = radius * radius;
        WendlandC2 {
            inverse_square: real(1.0 / square),
            value_scale: real(7.0 / (PI * square)),
            slope_scale: real(-140.0 / (PI * square * square)),
        }
    }
}

impl Shape for WendlandC2 {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let (q, t) = scaled(square, self.inverse_square);
        let t2 = t * t;
        ((t2 * t2) * (q * q.like(4.0) + q.like(1.0)), t2 * t)
    }
    fn value_scale(&self) -> Real {
        self.value_scale
    }
    fn slope_scale(&self) -> Real {
        self.slope_scale
    }
}

/// A kernel whose value is the g of another one: sums over it make a Laplacian (Brookshaw 1985).
#[derive(Clone, Copy, Debug)]
pub struct SlopeAsValue<K>(pub K);

impl<K: Shape> Shape for SlopeAsValue<K> {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let slope = self.0.at(square).1;
        (slope, slope)
    }
    fn value_scale(&self) -> Real {
        self.0.slope_scale()
    }
    fn slope_scale(&self) -> Real {
        self.0.slope_scale()
    }
}
