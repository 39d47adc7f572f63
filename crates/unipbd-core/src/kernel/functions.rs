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
fn scaled<N: Number>(square: N, inverse_square: Real) -> (N, N) {
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
    /// The kernel of radius `radius` [m].
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

/// Poly6 (Müller et al. 2003, in two dimensions): W = 4/(pi h^2) (1-q^2)^3, g = -24/(pi h^4) (1-q^2)^2.
#[derive(Clone, Copy, Debug)]
pub struct Poly6 {
    inverse_square: Real,
    value_scale: Real,
    slope_scale: Real,
}

impl Poly6 {
    /// The kernel of radius `radius` [m].
    pub fn new(radius: f64) -> Poly6 {
        let square = radius * radius;
        Poly6 {
            inverse_square: real(1.0 / square),
            value_scale: real(4.0 / (PI * square)),
            slope_scale: real(-24.0 / (PI * square * square)),
        }
    }

    /// With the constant of three dimensions, 315/(64 pi h^9), per metre of depth: in the plane it
    /// integrates to 1.23 m/h.
    pub fn of_space(radius: f64) -> Poly6 {
        let cube = radius * radius * radius;
        Poly6 {
            value_scale: real(315.0 / (64.0 * PI * cube)),
            slope_scale: real(-945.0 / (32.0 * PI * cube * radius * radius)),
            ..Poly6::new(radius)
        }
    }
}

impl Shape for Poly6 {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let t = (square.like(1.0) - square * square.like(self.inverse_square)).larger(square.like(0.0));
        let t2 = t * t;
        (t2 * t, t2)
    }
    fn value_scale(&self) -> Real {
        self.value_scale
    }
    fn slope_scale(&self) -> Real {
        self.slope_scale
    }
}

/// Below this q a quotient by q is taken at this q: the pair is coincident and x is zero.
const LEAST_Q: Real = 1e-12;

/// Spiky (Müller et al. 2003, in two dimensions): W = 10/(pi h^2) (1-q)^3, g = -30/(pi h^4) (1-q)^2 / q.
#[derive(Clone, Copy, Debug)]
pub struct Spiky {
    inverse_square: Real,
    value_scale: Real,
    slope_scale: Real,
}

impl Spiky {
    /// The kernel of radius `radius` [m].
    pub fn new(radius: f64) -> Spiky {
        let square = radius * radius;
        Spiky {
            inverse_square: real(1.0 / square),
            value_scale: real(10.0 / (PI * square)),
            slope_scale: real(-30.0 / (PI * square * square)),
        }
    }

    /// With the constant of three dimensions, 15/(pi h^6), per metre of depth: in the plane it
    /// integrates to 1.5 m/h.
    pub fn of_space(radius: f64) -> Spiky {
        let cube = radius * radius * radius;
        Spiky {
            value_scale: real(15.0 / (PI * cube)),
            slope_scale: real(-45.0 / (PI * cube * radius * radius)),
            ..Spiky::new(radius)
        }
    }
}

impl Shape for Spiky {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let (q, t) = scaled(square, self.inverse_square);
        let t2 = t * t;
        (t2 * t, t2 / q.larger(q.like(LEAST_Q)))
    }
    fn value_scale(&self) -> Real {
        self.value_scale
    }
    fn slope_scale(&self) -> Real {
        self.slope_scale
    }
}

/// Cubic spline (Monaghan 1992): W = 40/(7 pi h^2) times 1 + 6 (q^3 - q^2) up to q = 1/2, then 2 (1-q)^3.
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline {
    inverse_square: Real,
    value_scale: Real,
    slope_scale: Real,
}

impl CubicSpline {
    /// The kernel of radius `radius` [m].
    pub fn new(radius: f64) -> CubicSpline {
        let square = radius * radius;
        CubicSpline {
            inverse_square: real(1.0 / square),
            value_scale: real(40.0 / (7.0 * PI * square)),
            slope_scale: real(240.0 / (7.0 * PI * square * square)),
        }
    }
}

impl Shape for CubicSpline {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let (q, t) = scaled(square, self.inverse_square);
        let (half, one) = (q.like(0.5), q.like(1.0));
        let (q2, t2) = (q * q, t * t);
        let inner = q2 * (q - one) * q.like(6.0) + one;
        let outer = t2 * t * q.like(2.0);
        let inner_slope = q * q.like(3.0) - q.like(2.0);
        let outer_slope = q.like(0.0) - t2 / q.larger(half);
        (q.where_below(half, inner, outer), q.where_below(half, inner_slope, outer_slope))
    }
    fn value_scale(&self) -> Real {
        self.value_scale
    }
    fn slope_scale(&self) -> Real {
        self.slope_scale
    }
}

/// The value of one kernel with the gradient of another, as in Müller et al. 2003.
#[derive(Clone, Copy, Debug)]
pub struct Mixed<V, S> {
    /// Gives W.
    pub value: V,
    /// Gives g.
    pub slope: S,
}

impl<V: Shape, S: Shape> Shape for Mixed<V, S> {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        (self.value.at(square).0, self.slope.at(square).1)
    }
    fn value_scale(&self) -> Real {
        self.value.value_scale()
    }
    fn slope_scale(&self) -> Real {
        self.slope.slope_scale()
    }
}

/// The kernels that are there for comparison, told apart at run time so that passes are not
/// compiled for each of them.
#[derive(Clone, Copy, Debug)]
pub enum Alternative {
    /// The cubic spline.
    CubicSpline(CubicSpline),
    /// Poly6 with the gradient of spiky.
    Poly6Spiky(Mixed<Poly6, Spiky>),
}

impl Shape for Alternative {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        match self {
            Alternative::CubicSpline(shape) => shape.at(square),
            Alternative::Poly6Spiky(shape) => shape.at(square),
        }
    }
    fn value_scale(&self) -> Real {
        match self {
            Alternative::CubicSpline(shape) => shape.value_scale(),
            Alternative::Poly6Spiky(shape) => shape.value_scale(),
        }
    }
    fn slope_scale(&self) -> Real {
        match self {
            Alternative::CubicSpline(shape) => shape.slope_scale(),
            Alternative::Poly6Spiky(shape) => shape.slope_scale(),
        }
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

/// The artificial pressure of Monaghan 2000: g times (W/W0)^4.
#[derive(Clone, Copy, Debug)]
pub struct Tensile<K> {
    kernel: K,
    inverse_reference: Real,
}

impl<K: Shape> Tensile<K> {
    /// With W0 the value of the kernel at this distance [m].
    pub fn new(kernel: K, reference: f64) -> Self {
        let value = kernel.at(real(reference * reference)).0;
        Tensile { kernel, inverse_reference: 1.0 / value }
    }
}

impl<K: Shape> Shape for Tensile<K> {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        let (value, slope) = self.kernel.at(square);
        let ratio = value * value.like(self.inverse_reference);
        let squared = ratio * ratio;
        (value, slope * (squared * squared))
    }
    fn value_scale(&self) -> Real {
        self.kernel.value_scale()
    }
    fn slope_scale(&self) -> Real {
        self.kernel.slope_scale()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(kernel: impl Shape, radius: f64) {
        let value = |r: f64| f64::from(kernel.at(real(r * r)).0) * f64::from(kernel.value_scale());
        let slope = |r: f64| f64::from(kernel.at(real(r * r)).1) * f64::from(kernel.slope_scale());
        let steps = 4000;
        let dr = radius / f64::from(steps);
        let rings = (0..steps).map(|k| (f64::from(k) + 0.5) * dr);
        let integral: f64 = rings.map(|r| 2.0 * PI * r * dr * value(r)).sum();
        assert!((integral - 1.0).abs() < 2e-4, "integral {integral}");
        for k in 1..40 {
            let (r, step) = (radius * f64::from(k) / 40.0, radius * 2e-3);
            let difference = (value(r + step) - value(r - step)) / (2.0 * step);
            let scale = value(0.0) / radius;
            assert!((slope(r) * r - difference).abs() < 0.02 * scale, "r {r}: {} {difference}", slope(r) * r);
        }
        assert_eq!(value(radius * 1.01), 0.0);
        assert_eq!(slope(radius * 1.01), 0.0);
    }

    #[test]
    fn kernels_integrate_to_one_and_gradients_are_their_derivatives() {
        for radius in [0.05, 0.7, 3.0] {
            check(WendlandC2::new(radius), radius);
            check(Poly6::new(radius), radius);
            check(Spiky::new(radius), radius);
            check(CubicSpline::new(radius), radius);
        }
    }

    #[test]
    fn kernels_of_space_are_those_of_the_plane_times_a_constant() {
        let (radius, square) = (2.0, real(0.7));
        let value = |kernel: Poly6| f64::from(kernel.at(square).0 * kernel.value_scale());
        let slope = |kernel: Spiky| f64::from(kernel.at(square).1 * kernel.slope_scale());
        let values = value(Poly6::of_space(radius)) / value(Poly6::new(radius));
        let slopes = slope(Spiky::of_space(radius)) / slope(Spiky::new(radius));
        assert!((values - 0.615).abs() < 1e-3 && (slopes - 0.75).abs() < 1e-6, "{values} {slopes}");
    }
}
