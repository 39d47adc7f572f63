//! The part of a kernel that lies inside a wall, from precomputed tables.
//!
//! With Phi(a, b) the integral of W over x < a, y < b, any axis-aligned box, corner or half-plane
//! is a sum of a few values of Phi: walls count in the density as if they were fluid at rest.

use crate::kernel::{Kernel, Shape};
use crate::math::{Real, Vector, real};

const CELLS: usize = 128;
const NODES: usize = CELLS + 1;
/// Relative increase of the gradient of a wall at half a spacing, for walls that support a liquid. With 0.15 to 0.4
/// columns keep their level; a larger value increases the resistance of a wall to motion along it.
const STEEPER: f64 = 0.25;

/// How walls that uphold the lowest row of a liquid see distances: see [`Coverage::upholding`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// Distance that stays \[m].
    kept: f64,
    /// From there to the kernel radius \[m].
    reach: f64,
    strength: f64,
}

impl Stretch {
    /// For a kernel of this radius and a liquid of this spacing, if there is one to be upheld \[m].
    pub fn new(radius: f64, upheld: Option<f64>) -> Stretch {
        let kept = 0.5 * upheld.unwrap_or(0.0);
        Stretch { kept, reach: radius - kept, strength: if upheld.is_some() { STEEPER } else { 0.0 } }
    }

    /// The distance as it is seen, and its derivative.
    #[inline]
    pub fn at(&self, distance: f64) -> (f64, f64) {
        let apart = distance.max(0.0) - self.kept;
        let left = (1.0 - apart.max(0.0) / self.reach).max(0.0);
        let slope = if distance < 0.0 { 0.0 } else { left * (3.0 * left - 2.0) };
        (distance + self.strength * apart * left * left, 1.0 + self.strength * slope)
    }
}

/// Tables of the integral of a kernel over quadrants and half-planes.
#[derive(Clone, Debug)]
pub struct Coverage {
    radius: Real,
    scale: Real,
    /// Phi at the nodes of [-h, h]^2, row b, column a.
    quadrant: Vec<Real>,
    /// d Phi / d a at the same nodes [1/m].
    slope: Vec<Real>,
    /// Integral over x < a.
    half: Vec<Real>,
    /// Its derivative [1/m].
    marginal: Vec<Real>,
}

impl Coverage {
    /// Tables for this kernel.
    pub fn new<K: Shape>(kernel: &Kernel<K>) -> Self {
        Coverage::tabulate(kernel, |distance| (distance, 1.0))
    }

    /// Tables for this kernel, of walls that hold the first row of a liquid at half a spacing.
    ///
    /// Two particles push each other with the sum of both multipliers, but a wall has no multiplier: at the nominal
    /// position of the first row its push is too small, and the row moves closer until the gradient has grown
    /// enough. So distances are stretched about half a spacing: the part behind the wall is unchanged there
    /// and its gradient grows; at the kernel radius both have their true values. Value and gradient remain
    /// consistent: the push is the gradient of one potential, and adds no energy.
    ///
    /// With u = d - dx/2: seen(d) = d + b u (1 - u/(h - dx/2))^2 for u > 0, d + b u for 0 < d < dx/2, and
    /// behind the surface the shift keeps its value at the surface.
    pub fn upholding<K: Shape>(kernel: &Kernel<K>, spacing: f64) -> Self {
        let stretch = Stretch::new(f64::from(kernel.radius()), Some(spacing));
        Coverage::tabulate(kernel, |distance| stretch.at(distance))
    }

    /// Tables of a kernel with a modified wall distance: `stretch` returns the modified distance and its
    /// derivative.
    fn tabulate<K: Shape>(kernel: &Kernel<K>, stretch: impl Fn(f64) -> (f64, f64)) -> Self {
        let radius = f64::from(kernel.radius());
        let step = 2.0 * radius / CELLS as f64;
        // The inside of a wall is at x < a: its surface is at the distance -a.
        let nodes = (0..NODES).map(|i| stretch(radius - step * i as f64)).map(|(seen, slope)| (-seen, slope));
        let (node, stretched): (Vec<f64>, Vec<f64>) = nodes.unzip();
        let mut slope = vec![0.0; NODES * NODES];
        for a in 0..NODES {
            let mut sum = 0.0;
            for b in 1..NODES {
                sum += simpson(node[b - 1], node[b], |y| value(kernel, node[a], y));
                slope[b * NODES + a] = sum;
            }
        }
        let mut quadrant = vec![0.0; NODES * NODES];
        for b in 1..NODES {
            let mut sum = 0.0;
            for a in 1..NODES {
                let at = b * NODES + a;
                sum += 0.5 * (node[a] - node[a - 1]) * (slope[at - 1] + slope[at]);
                quadrant[at] = sum;
            }
        }
        // The trapezoid rule is exact to 1e-5 here; make the whole plane exactly 1.
        let whole = quadrant[NODES * NODES - 1];
        let top = (NODES - 1) * NODES;
        let by_distance = |(at, value): (usize, &f64)| real(value * stretched[at % NODES] / whole);
        Coverage {
            radius: real(radius),
            scale: real(1.0 / step),
            half: quadrant[top..].iter().map(|value| real(value / whole)).collect(),
            marginal: slope[top..].iter().enumerate().map(by_distance).collect(),
            quadrant: quadrant.iter().map(|value| real(value / whole)).collect(),
            slope: slope.iter().enumerate().map(by_distance).collect(),
        }
    }

    /// Kernel radius \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Part of the kernel behind a half-plane at this distance, and its derivative by the distance.
    #[inline]
    pub fn behind(&self, distance: Real) -> (Real, Real) {
        let (cell, t) = self.locate(-distance);
        let lerp = |table: &[Real]| table[cell] + t * (table[cell + 1] - table[cell]);
        (lerp(&self.half), -lerp(&self.marginal))
    }

    /// Phi(a, b) and its gradient.
    #[inline]
    pub fn quadrant(&self, a: Real, b: Real) -> (Real, Vector) {
        let gradient = Vector::new(self.bilinear(&self.slope, a, b), self.bilinear(&self.slope, b, a));
        (self.bilinear(&self.quadrant, a, b), gradient)
    }

    #[inline]
    fn locate(&self, a: Real) -> (usize, Real) {
        let position = ((a + self.radius) * self.scale).clamp(0.0, CELLS as Real);
        let cell = (position as usize).min(CELLS - 1);
        (cell, position - cell as Real)
    }

    #[inline]
    fn bilinear(&self, table: &[Real], a: Real, b: Real) -> Real {
        let ((ca, ta), (cb, tb)) = (self.locate(a), self.locate(b));
        let row = |b: usize| {
            let at = b * NODES + ca;
            table[at] + ta * (table[at + 1] - table[at])
        };
        let (low, high) = (row(cb), row(cb + 1));
        low + tb * (high - low)
    }
}

fn value<K: Shape>(kernel: &Kernel<K>, x: f64, y: f64) -> f64 {
    f64::from(kernel.value(real((x * x + y * y).sqrt())))
}

pub(super) fn simpson(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    (to - from) / 6.0 * (f(from) + 4.0 * f(0.5 * (from + to)) + f(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coverage() -> Coverage {
        Coverage::new(&Kernel::new(2.5))
    }

    #[test]
    fn half_the_kernel_is_behind_a_wall_at_distance_zero() {
        let coverage = coverage();
        assert!((coverage.behind(0.0).0 - 0.5).abs() < 1e-4);
        assert_eq!(coverage.behind(2.5).0, 0.0);
        assert!((coverage.behind(-3.0).0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_quarter_is_in_a_quadrant_through_the_centre() {
        let coverage = coverage();
        let (value, gradient) = coverage.quadrant(0.0, 0.0);
        assert!((value - 0.25).abs() < 1e-4);
        assert!((gradient.x - gradient.y).abs() < 1e-6);
    }

    #[test]
    fn a_wall_that_upholds_pushes_harder_at_half_a_spacing_and_covers_the_same_there() {
        let kernel = Kernel::new(3.0);
        let (plain, upholding) = (Coverage::new(&kernel), Coverage::upholding(&kernel, 1.0));
        let ((part, slope), (same, steeper)) = (plain.behind(0.5), upholding.behind(0.5));
        assert!((part - same).abs() < 1e-3, "{part} {same}");
        assert!((f64::from(steeper / slope) - 1.0 - STEEPER).abs() < 0.02, "{steeper} {slope}");
        assert!(upholding.behind(0.1).0 > plain.behind(0.1).0 && upholding.behind(1.2).0 < plain.behind(1.2).0);
        assert_eq!(upholding.behind(3.0).0, 0.0);
        assert!((upholding.behind(-3.0).0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn gradients_match_differences() {
        let kernel = Kernel::new(2.5);
        [Coverage::new(&kernel), Coverage::upholding(&kernel, 1.0)].iter().for_each(match_differences);
    }

    fn match_differences(coverage: &Coverage) {
        let step = 0.08;
        for i in -6..=6 {
            // Not across the surface: the gradient of supporting walls has a jump there.
            let a = 0.37 * i as Real + 0.15;
            let (plus, minus) = (coverage.behind(a + step).0, coverage.behind(a - step).0);
            let (slope, difference) = (coverage.behind(a).1, (plus - minus) / (2.0 * step));
            assert!((slope - difference).abs() < 8e-3, "{a}: {slope} {difference}");
            let (plus, minus) = (coverage.quadrant(a + step, 0.3).0, coverage.quadrant(a - step, 0.3).0);
            let (slope, difference) = (coverage.quadrant(a, 0.3).1.x, (plus - minus) / (2.0 * step));
            assert!((slope - difference).abs() < 8e-3, "{a}: {slope} {difference}");
        }
    }
}
