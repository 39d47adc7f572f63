//! The smoothing kernel of a run: Wendland C2 for density and gradient alike, unless the scene names
//! another one for its density.
//!
//! (Density by poly6 with the gradient of the spiky kernel, the pair of Müller et al. 2003, is
//! inconsistent: a column at rest keeps boiling.)

mod functions;

pub use functions::{Alternative, CubicSpline, Mixed, Poly6, Shape, SlopeAsValue, Spiky, Tensile, WendlandC2};

use crate::math::{Real, real};
use crate::scene::KernelKind;

/// A kernel of radius h, for single pairs; passes over many pairs take its [`shape`](Kernel::shape).
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    radius: Real,
    shape: WendlandC2,
    alternative: Option<Alternative>,
}

impl Kernel {
    /// The kernel that vanishes at distance `radius` [m].
    pub fn new(radius: f64) -> Self {
        Kernel { radius: real(radius), shape: WendlandC2::new(radius), alternative: None }
    }

    /// The kernel of this kind.
    pub fn of(kind: KernelKind, radius: f64) -> Self {
        let pair = || Mixed { value: Poly6::new(radius), slope: Spiky::new(radius) };
        let alternative = match kind {
            KernelKind::WendlandC2 => None,
            KernelKind::CubicSpline => Some(Alternative::CubicSpline(CubicSpline::new(radius))),
            KernelKind::Poly6Spiky => Some(Alternative::Poly6Spiky(pair())),
            KernelKind::Poly6Spiky3d => {
                let pair = Mixed { value: Poly6::of_space(radius), slope: Spiky::of_space(radius) };
                Some(Alternative::Poly6Spiky(pair))
            }
        };
        Kernel { alternative, ..Kernel::new(radius) }
    }

    /// The formula where it is not Wendland C2.
    pub fn alternative(&self) -> Option<Alternative> {
        self.alternative
    }

    /// Radius h [m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// The formula of Wendland C2, for passes over pairs.
    pub fn shape(&self) -> WendlandC2 {
        self.shape
    }

    /// W at distance r [1/m^2].
    #[inline]
    pub fn value(&self, r: Real) -> Real {
        match &self.alternative {
            None => self.shape.at(r * r).0 * self.shape.value_scale(),
            Some(other) => other.at(r * r).0 * other.value_scale(),
        }
    }

    /// g at distance r, where grad W = g x [1/m^4]; never positive.
    #[inline]
    pub fn slope(&self, r: Real) -> Real {
        match &self.alternative {
            None => self.shape.at(r * r).1 * self.shape.slope_scale(),
            Some(other) => other.at(r * r).1 * other.slope_scale(),
        }
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
    /// -sum of y dW/dy [1/m^2]: times the volume, what the gradient of a linear field comes out as.
    pub moment: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn integrates_to_one() {
        let kernel = Kernel::new(0.7);
        let steps = 20_000;
        let dr = 0.7 / f64::from(steps);
        let integral: f64 = (0..steps)
            .map(|i| (f64::from(i) + 0.5) * dr)
            .map(|r| 2.0 * PI * r * f64::from(kernel.value(real(r))) * dr)
            .sum();
        assert!((integral - 1.0).abs() < 1e-5, "{integral}");
    }

    #[test]
    fn slope_is_the_derivative_over_r() {
        let kernel = Kernel::new(1.3);
        for i in 1..12 {
            let (r, step) = (0.1 * i as Real, 1e-2);
            let difference = (kernel.value(r + step) - kernel.value(r - step)) / (2.0 * step);
            assert!((kernel.slope(r) * r - difference).abs() < 2e-3, "r = {r}");
        }
    }

    #[test]
    fn rest_lattice_needs_the_known_calibration() {
        let sums = Kernel::new(2.5).lattice(1.0);
        let calibration = 1.0 / (sums.value + f64::from(Kernel::new(2.5).value(0.0)));
        assert!((calibration - 0.9864).abs() < 1e-3, "{calibration}");
    }
}
