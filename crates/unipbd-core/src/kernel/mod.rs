//! The smoothing kernel of a run: Wendland C2 for density and gradient alike.

mod functions;

#[doc(hidden)]
pub use functions::SlopeAsValue;
pub(crate) use functions::scaled;
pub use functions::{Shape, WendlandC2};

use crate::math::{Real, real};

/// A kernel of radius h, for single pairs; passes over many pairs take its [`shape`](Kernel::shape).
#[derive(Clone, Copy, Debug)]
pub struct Kernel<K = WendlandC2> {
    radius: Real,
    shape: K,
}

impl Kernel {
    /// Wendland C2 that vanishes at distance `radius` \[m].
    pub fn new(radius: f64) -> Self {
        Kernel::with_shape(radius, WendlandC2::new(radius))
    }
}

impl<K: Shape> Kernel<K> {
    /// The kernel of this formula, which vanishes at distance `radius` \[m].
    pub fn with_shape(radius: f64, shape: K) -> Self {
        Kernel { radius: real(radius), shape }
    }

    /// Radius h \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// The formula, for passes over pairs.
    pub fn shape(&self) -> K {
        self.shape
    }

    /// W at distance r [1/m^2].
    #[inline]
    pub fn value(&self, r: Real) -> Real {
        self.shape.at(r * r).0 * self.shape.value_scale()
    }

    /// g at distance r, where grad W = g x [1/m^4]; never positive.
    #[inline]
    pub fn slope(&self, r: Real) -> Real {
        self.shape.at(r * r).1 * self.shape.slope_scale()
    }

    /// Sums over the square lattice of this spacing around a particle, itself left out.
    pub fn lattice(&self, spacing: f64) -> LatticeSums {
        let reach = (f64::from(self.radius) / spacing).ceil() as i64;
        let mut sums = LatticeSums::default();
        for row in -reach..=reach {
            for column in -reach..=reach {
                if row == 0 && column == 0 {
                    continue;
                }
                let r = spacing * ((row * row + column * column) as f64).sqrt();
                let gradient = f64::from(self.slope(real(r))) * r;
                sums.value += f64::from(self.value(real(r)));
                sums.gradient_squared += gradient * gradient;
                sums.moment -= 0.5 * gradient * r;
            }
        }
        sums
    }
}

/// Sums of the kernel over a lattice at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatticeSums {
    /// sum of W [1/m^2].
    pub value: f64,
    /// sum of |grad W|^2 [1/m^6].
    pub gradient_squared: f64,
    /// -sum of y dW/dy [1/m^2]: times the volume, the gradient that the lattice gives for a linear field of slope 1.
    pub moment: f64,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A kernel integrates to one over its disc, and vanishes outside.
    pub(crate) fn check_integral(value: impl Fn(f64) -> f64, radius: f64) {
        let steps = 20_000;
        let dr = radius / f64::from(steps);
        let rings = (0..steps).map(|k| (f64::from(k) + 0.5) * dr);
        let integral: f64 = rings.map(|r| 2.0 * PI * r * dr * value(r)).sum();
        assert!((integral - 1.0).abs() < 1e-5, "integral {integral}");
        assert_eq!(value(radius * 1.01), 0.0);
    }

    /// A slope is the derivative over r, and vanishes outside.
    pub(crate) fn check_slope(value: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64, radius: f64) {
        for k in 1..40 {
            let (r, step) = (radius * f64::from(k) / 40.0, radius * 2e-3);
            let difference = (value(r + step) - value(r - step)) / (2.0 * step);
            let scale = value(0.0) / radius;
            assert!((slope(r) * r - difference).abs() < 0.02 * scale, "r {r}: {} {difference}", slope(r) * r);
        }
        assert_eq!(slope(radius * 1.01), 0.0);
    }

    #[test]
    fn the_kernel_integrates_to_one_and_its_gradient_is_the_derivative() {
        for radius in [0.05, 0.7, 3.0] {
            let kernel = Kernel::new(radius);
            let value = |r: f64| f64::from(kernel.value(real(r)));
            check_integral(value, radius);
            check_slope(value, |r| f64::from(kernel.slope(real(r))), radius);
        }
    }

    #[test]
    fn rest_lattice_needs_the_known_calibration() {
        let sums = Kernel::new(2.5).lattice(1.0);
        let calibration = 1.0 / (sums.value + f64::from(Kernel::new(2.5).value(0.0)));
        assert!((calibration - 0.9864).abs() < 1e-3, "{calibration}");
    }
}
