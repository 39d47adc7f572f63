//! Kernels used by legacy options only: the cubic spline, and poly6 with the gradient of spiky.

use std::f64::consts::PI;

use crate::kernel::{Kernel, Shape, WendlandC2, scaled};
use crate::math::{Real, real};
use crate::scene::{LegacyKernel, Scene};
use crate::simd::Number;

/// A kernel for comparison. Kernels are told apart at run time, so that passes are compiled once for all of them.
#[derive(Clone, Copy, Debug)]
pub struct Formula {
    inverse_square: Real,
    value_scale: Real,
    slope_scale: Real,
    form: Form,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    /// Wendland C2, for comparisons with the default kernel.
    WendlandC2(WendlandC2),
    /// W = 40/(7 pi h^2) times 1 + 6 (q^3 - q^2) up to q = 1/2, then 2 (1-q)^3 (Monaghan 1992).
    CubicSpline,
    /// W = 4/(pi h^2) (1-q^2)^3, and g = -30/(pi h^4) (1-q)^2 / q of another kernel (Müller et al. 2003, in two
    /// dimensions).
    Poly6Spiky,
}

/// Below this q a quotient by q is taken at this q: the pair is coincident and x is zero.
const LEAST_Q: Real = 1e-12;

impl Formula {
    /// The kernel of this kind and radius \[m].
    pub fn new(kind: LegacyKernel, radius: f64) -> Formula {
        let (square, cube) = (radius * radius, radius * radius * radius);
        let (form, value_scale, slope_scale) = match kind {
            LegacyKernel::WendlandC2 => {
                let kernel = WendlandC2::new(radius);
                return Formula {
                    inverse_square: 0.0,
                    value_scale: kernel.value_scale(),
                    slope_scale: kernel.slope_scale(),
                    form: Form::WendlandC2(kernel),
                };
            }
            LegacyKernel::CubicSpline => {
                (Form::CubicSpline, 40.0 / (7.0 * PI * square), 240.0 / (7.0 * PI * square * square))
            }
            LegacyKernel::Poly6Spiky => (Form::Poly6Spiky, 4.0 / (PI * square), -30.0 / (PI * square * square)),
            // The constants 315/(64 pi h^9) and 15/(pi h^6) of three dimensions, per metre of depth: in the plane the
            // kernels integrate to 1.23 m/h and 1.5 m/h.
            LegacyKernel::Poly6Spiky3d => {
                (Form::Poly6Spiky, 315.0 / (64.0 * PI * cube), -45.0 / (PI * cube * radius * radius))
            }
        };
        let inverse_square = real(1.0 / square);
        Formula { inverse_square, value_scale: real(value_scale), slope_scale: real(slope_scale), form }
    }

    /// The kernel that a scene asks for.
    pub fn of(scene: &Scene) -> Kernel<Formula> {
        let radius = scene.solver.kernel_radius * scene.spacing;
        Kernel::with_shape(radius, Formula::new(scene.legacy.kernel, radius))
    }
}

impl Shape for Formula {
    #[inline(always)]
    fn at<N: Number>(&self, square: N) -> (N, N) {
        match self.form {
            Form::WendlandC2(kernel) => kernel.at(square),
            Form::CubicSpline => cubic_spline(scaled(square, self.inverse_square)),
            Form::Poly6Spiky => {
                let t = (square.like(1.0) - square * square.like(self.inverse_square)).larger(square.like(0.0));
                (t * t * t, spiky_slope(scaled(square, self.inverse_square)))
            }
        }
    }
    fn value_scale(&self) -> Real {
        self.value_scale
    }
    fn slope_scale(&self) -> Real {
        self.slope_scale
    }
}

#[inline(always)]
fn cubic_spline<N: Number>((q, t): (N, N)) -> (N, N) {
    let (half, one) = (q.like(0.5), q.like(1.0));
    let (q2, t2) = (q * q, t * t);
    let inner = q2 * (q - one) * q.like(6.0) + one;
    let outer = t2 * t * q.like(2.0);
    let inner_slope = q * q.like(3.0) - q.like(2.0);
    let outer_slope = q.like(0.0) - t2 / q.larger(half);
    (q.where_below(half, inner, outer), q.where_below(half, inner_slope, outer_slope))
}

#[inline(always)]
fn spiky_slope<N: Number>((q, t): (N, N)) -> N {
    t * t / q.larger(q.like(LEAST_Q))
}

/// The artificial pressure of Monaghan 2000: g times (W/W0)^4.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tensile<K> {
    kernel: K,
    inverse_reference: Real,
}

impl<K: Shape> Tensile<K> {
    /// With W0 the value of the kernel at this distance \[m].
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
    use crate::kernel::tests::{check_integral, check_slope};

    /// W and g of a kernel as functions of the distance.
    fn formulas(kind: LegacyKernel, radius: f64) -> (impl Fn(f64) -> f64 + Copy, impl Fn(f64) -> f64 + Copy) {
        let kernel = Kernel::with_shape(radius, Formula::new(kind, radius));
        (move |r| f64::from(kernel.value(real(r))), move |r| f64::from(kernel.slope(real(r))))
    }

    #[test]
    fn kernels_integrate_to_one_and_gradients_are_their_derivatives() {
        for radius in [0.05, 0.7, 3.0] {
            let (value, slope) = formulas(LegacyKernel::CubicSpline, radius);
            check_integral(value, radius);
            check_slope(value, slope, radius);
            let (poly6, slope) = formulas(LegacyKernel::Poly6Spiky, radius);
            let spiky = |r: f64| {
                let t = (1.0 - r / radius).max(0.0);
                10.0 / (PI * radius * radius) * t * t * t
            };
            check_integral(poly6, radius);
            check_slope(spiky, slope, radius);
        }
    }

    #[test]
    fn the_legacy_form_of_wendland_is_the_default_kernel() {
        let (legacy, kernel) = (Formula::new(LegacyKernel::WendlandC2, 2.5), WendlandC2::new(2.5));
        for square in [0.0, 0.7, 3.1, 6.3] {
            assert_eq!(legacy.at(real(square)), kernel.at(real(square)));
        }
        assert_eq!((legacy.value_scale(), legacy.slope_scale()), (kernel.value_scale(), kernel.slope_scale()));
    }

    #[test]
    fn kernels_of_space_are_those_of_the_plane_times_a_constant() {
        let (space, plane) = (formulas(LegacyKernel::Poly6Spiky3d, 2.0), formulas(LegacyKernel::Poly6Spiky, 2.0));
        let (values, slopes) = (space.0(0.8) / plane.0(0.8), space.1(0.8) / plane.1(0.8));
        assert!((values - 0.615).abs() < 1e-3 && (slopes - 0.75).abs() < 1e-6, "{values} {slopes}");
    }
}
