//! The displacements of the density constraint.

use super::Records;
use super::{Pairs, Pass, in_space};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::simd::Number;
use crate::simd::Record;
use crate::simd::space::Space;

/// out_i = sum_j (l_i + l_j) grad W_ij, for multipliers l (Macklin & Müller 2013, equation 12).
pub fn correction<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    multipliers: &[Real],
    records: &mut Records,
    out: &mut [Vector],
) {
    let record = |row: usize| [positions[row], Vector::new(multipliers[row], 0.0)];
    let records = pairs.pack(records, positions.len().min(multipliers.len()), record);
    in_space!(pairs, space => {
        pairs.fill_vectors(&Correction { kernel, space, positions, multipliers, records }, out);
    });
}

#[derive(Clone, Copy)]
struct Correction<'a, K, S> {
    kernel: K,
    space: S,
    positions: &'a [Vector],
    multipliers: &'a [Real],
    /// Positions and multipliers, for the lane forms.
    #[cfg_attr(feature = "f64", allow(dead_code))]
    records: &'a [Record],
}

impl<K: Shape, S: Space> Pass<2> for Correction<'_, K, S> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 2] {
        let [mut sum_x, mut sum_y] = [0.0; 2];
        list.for_each(row, |j| {
            let apart = self.positions[row] - self.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let factor = self.kernel.at(x * x + y * y).1 * (self.multipliers[row] + self.multipliers[j]);
            sum_x += factor * x;
            sum_y += factor * y;
        });
        self.finish([sum_x, sum_y])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let slope = x.like(self.kernel.slope_scale());
        [x * slope, y * slope]
    }

    fn shortest_column(&self) -> usize {
        self.positions.len().min(self.multipliers.len())
    }
}

#[cfg(not(feature = "f64"))]
mod lanes {
    use super::super::run::LanePass;
    use super::*;
    use crate::simd::lanes::{ColumnPair, Entry, Turn};

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space> LanePass<2> for Correction<'_, K, S> {
        /// Position and multiplier.
        type Own<F: Turn> = (F, F, F);

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            let ((x, y), (multiplier, _)) = unsafe { F::gather_records(self.records.as_ptr().add(base), entries) };
            (x, y, multiplier)
        }

        #[inline(always)]
        unsafe fn terms<F: Turn, E: Entry>(
            &self,
            own: &Self::Own<F>,
            base: usize,
            entries: &ColumnPair<E>,
            _counted: impl Fn(F) -> F,
        ) -> [F; 2] {
            // SAFETY: the caller vouches that all rows are within the columns.
            let ((other_x, other_y), (multiplier, _)) =
                unsafe { F::gather_records(self.records.as_ptr().add(base), entries) };
            let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
            let factor = self.kernel.at(x * x + y * y).1 * (own.2 + multiplier);
            // Padding lies at distance zero and adds nothing.
            [factor * x, factor * y]
        }
    }
}
