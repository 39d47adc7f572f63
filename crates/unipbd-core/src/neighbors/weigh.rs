//! Kernel sums at points that are not in the list: runs of consecutive rows, eight rows at a time.
//!
//! The k-th row of a run adds to the k-th of eight sums, modulo eight, and the eight are added along a
//! fixed tree: so one row at a time and eight at a time give the same bits.
#![cfg_attr(not(feature = "f64"), allow(unsafe_code))]

use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::simd::LANES;
use crate::simd::space::Space;
#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
use crate::simd::{lanes::Lanes, x86::Avx2};
use std::ops::Range;

/// A point, and the columns that are summed there.
#[derive(Clone, Copy)]
pub(crate) struct At<'a, S, K> {
    pub space: S,
    pub kernel: K,
    pub point: Vector,
    pub positions: &'a [Vector],
    /// The vectors to sum: as many rows as `positions`.
    pub vectors: &'a [Vector],
}

/// Sums of W, without its constant, and of W times the vectors.
#[derive(Clone, Copy, Default)]
pub(crate) struct Weighed {
    weight: [Real; LANES],
    x: [Real; LANES],
    y: [Real; LANES],
}

impl Weighed {
    /// Sum of W.
    #[inline(always)]
    pub fn weight(&self) -> Real {
        total(self.weight)
    }

    /// Sum of W times the vectors.
    #[inline(always)]
    pub fn vector(&self) -> Vector {
        Vector::new(total(self.x), total(self.y))
    }

    /// The scalar form.
    #[inline(always)]
    pub(super) fn add_one_by_one<S: Space, K: Shape>(&mut self, at: &At<'_, S, K>, run: Range<usize>) {
        let rows = at.positions[run.clone()].iter().zip(&at.vectors[run]);
        for (k, (position, vector)) in rows.enumerate() {
            let (x, y) = at.space.shortest(at.point.x - position.x, at.point.y - position.y);
            let weight = at.kernel.at(x * x + y * y).0;
            let lane = k % LANES;
            self.weight[lane] += weight;
            self.x[lane] += weight * vector.x;
            self.y[lane] += weight * vector.y;
        }
    }
}

/// Eight sums, added along a tree.
#[inline(always)]
fn total([a, b, c, d, e, f, g, h]: [Real; LANES]) -> Real {
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
impl Weighed {
    /// The lane form.
    ///
    /// # Safety
    /// The machine has AVX2.
    #[inline(always)]
    pub(super) unsafe fn add_eight_at_a_time<S: Space, K: Shape>(&mut self, at: &At<'_, S, K>, run: Range<usize>) {
        /// Eight counts are read from an offset in this table: as many of them are nonzero as rows are left.
        static COUNTED: [u32; 2 * LANES] = [1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0];
        let rows = at.positions.len();
        assert!(rows == at.vectors.len() && run.start <= run.end && run.end <= rows);
        let mut row = run.start;
        // SAFETY: the caller vouches for AVX2; eight vectors from `row` are within both
        // slices, and eight counts from at most the eighth are within `COUNTED`.
        unsafe {
            let (center_x, center_y) = (Avx2::splat(at.point.x), Avx2::splat(at.point.y));
            let (mut weights, mut xs, mut ys) = (Avx2::load(&self.weight), Avx2::load(&self.x), Avx2::load(&self.y));
            while row < run.end && row + LANES <= rows {
                let (other_x, other_y) = Avx2::deinterleaved(at.positions.as_ptr().add(row));
                let (u, v) = Avx2::deinterleaved(at.vectors.as_ptr().add(row));
                let (x, y) = at.space.shortest(center_x - other_x, center_y - other_y);
                let left = LANES.min(run.end - row);
                let counted = Avx2::counts(&*COUNTED.as_ptr().add(LANES - left).cast());
                let weight = at.kernel.at(x * x + y * y).0.where_counted(counted, 0);
                weights = weights + weight;
                xs = xs + weight * u;
                ys = ys + weight * v;
                row += LANES;
            }
            (self.weight, self.x, self.y) = (weights.to_array(), xs.to_array(), ys.to_array());
        }
        if row < run.end {
            self.add_one_by_one(at, row..run.end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::WendlandC2;
    use crate::neighbors::near::{self, Near, Work};
    use crate::simd::Level;
    use crate::simd::space::Open;

    struct Sum<'a> {
        at: At<'a, Open, WendlandC2>,
        runs: &'a [Range<usize>],
        sums: &'a mut Weighed,
    }

    impl Work for Sum<'_> {
        #[inline(always)]
        fn run<N: Near>(self, near: N) {
            for run in self.runs {
                near.weigh(&self.at, run.clone(), self.sums);
            }
        }
    }

    #[test]
    fn every_level_weighs_the_same_bits() {
        let place = |k: usize| Vector::new((k * 37 % 101) as Real * 0.03, (k * 53 % 89) as Real * 0.04);
        let positions: Vec<_> = (0..60).map(place).collect();
        let vectors: Vec<_> = (0..60).map(|k| place(k + 7) - Vector::ONE).collect();
        let runs = [0..3, 5..5, 7..24, 30..38, 41..60];
        let (space, kernel, point) = (Open, WendlandC2::new(2.5), Vector::new(1.3, 1.7));
        let at = At { space, kernel, point, positions: &positions, vectors: &vectors };
        let weighed = |level: Level| {
            let mut sums = Weighed::default();
            near::dispatch(level, Sum { at, runs: &runs, sums: &mut sums });
            (sums.weight(), sums.vector())
        };
        let oracle = weighed(Level::Scalar);
        assert!(oracle.0 > 1.0 && oracle.1.length() > 0.1);
        Level::available().into_iter().for_each(|level| assert_eq!(weighed(level), oracle, "{level:?}"));
        let plain: Real =
            runs.into_iter().flatten().map(|k| kernel.at((point - positions[k]).length_squared()).0).sum();
        assert!((plain - oracle.0).abs() < 1e-5 * plain);
    }
}
