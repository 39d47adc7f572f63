//! A repulsion of close pairs.

use super::{Pairs, Pass, Weights, in_space, rows_if};
use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::simd::Number;
use crate::simd::space::Space;

/// Distances between which a repulsion grows as a pair comes closer [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Below this it grows no more: a pair that is thrown together must not be thrown apart.
    pub full: Real,
    /// Above this there is none.
    pub none: Real,
}

/// out_i = sum_j s_j max(none - max(r, full), 0) x_ij / r, for strengths s.
///
/// Multiplied by s_i it is the same for both of a pair, up to its sign; a strength of zero leaves a
/// row out. Coincident rows part along x, the lower row to the left.
pub fn repulsion(pairs: Pairs<'_>, reach: Reach, positions: &[Vector], strengths: Weights<'_>, out: &mut [Vector]) {
    let (weights, factor) = strengths.parts();
    in_space!(pairs, space => if strengths.is_column() {
        pairs.fill_vectors(&Repulsion::<_, true> { space, reach, positions, weights, factor }, out)
    } else {
        pairs.fill_vectors(&Repulsion::<_, false> { space, reach, positions, weights, factor }, out)
    });
}

#[derive(Clone, Copy)]
struct Repulsion<'a, S, const WEIGHTED: bool> {
    space: S,
    reach: Reach,
    positions: &'a [Vector],
    weights: &'a [Real],
    factor: Real,
}

impl<S, const WEIGHTED: bool> Repulsion<'_, S, WEIGHTED> {
    /// How far a pair overlaps, as far as it counts.
    #[inline(always)]
    fn overlap<M: Number>(&self, square: M) -> M {
        let distance = square.sqrt().larger(square.like(self.reach.full));
        (square.like(self.reach.none) - distance).larger(square.like(0.0))
    }

    /// `push` along the pair, or along x where the pair has no direction.
    #[inline(always)]
    fn along<M: Number>(x: M, y: M, square: M, push: M, order: M) -> (M, M) {
        let zero = x.like(0.0);
        let pull = push / square.sqrt();
        (zero.where_below(square, pull * x, push * order), zero.where_below(square, pull * y, zero))
    }
}

impl<S: Space, const WEIGHTED: bool> Pass<2> for Repulsion<'_, S, WEIGHTED> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 2] {
        let [mut sum_x, mut sum_y] = [0.0; 2];
        list.for_each(row, |j| {
            let apart = self.positions[row] - self.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let square = x * x + y * y;
            let overlap = self.overlap(square);
            let push = if WEIGHTED { overlap * self.weights[j] } else { overlap };
            let (push_x, push_y) = Self::along(x, y, square, push, if row < j { -1.0 } else { 1.0 });
            sum_x += push_x;
            sum_y += push_y;
        });
        self.finish([sum_x, sum_y])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.factor);
        [x * factor, y * factor]
    }

    fn shortest_column(&self) -> usize {
        self.positions.len().min(rows_if(WEIGHTED, self.weights))
    }
}

#[cfg(not(feature = "f64"))]
mod lanes {
    use super::super::run::LanePass;
    use super::*;
    use crate::simd::lanes::{ColumnPair, Entry, Turn};

    /// The entries as numbers.
    #[inline(always)]
    fn offsets<E: Entry>([first, second]: &ColumnPair<E>) -> ColumnPair<f32> {
        [first.map(|entry| entry.offset() as f32), second.map(|entry| entry.offset() as f32)]
    }

    #[allow(unsafe_code)]
    impl<S: Space, const WEIGHTED: bool> LanePass<2> for Repulsion<'_, S, WEIGHTED> {
        /// Position, and offset in the block.
        type Own<F: Turn> = (F, F, F);

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe {
                let (x, y) = F::gather_vectors(self.positions.as_ptr().add(base), entries);
                (x, y, F::load(&offsets(entries)))
            }
        }

        #[inline(always)]
        unsafe fn terms<F: Turn, E: Entry>(
            &self,
            own: &Self::Own<F>,
            base: usize,
            entries: &ColumnPair<E>,
            counted: impl Fn(F) -> F,
        ) -> [F; 2] {
            // SAFETY: the caller vouches that all rows are within the columns.
            let ((other_x, other_y), offset) =
                unsafe { (F::gather_vectors(self.positions.as_ptr().add(base), entries), F::load(&offsets(entries))) };
            let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
            let square = x * x + y * y;
            let mut push = counted(self.overlap(square));
            if WEIGHTED {
                // SAFETY: as above.
                push = push * unsafe { F::gather(self.weights.as_ptr().add(base), entries) };
            }
            let order = own.2.where_below(offset, x.like(-1.0), x.like(1.0));
            let (push_x, push_y) = Self::along(x, y, square, push, order);
            [push_x, push_y]
        }
    }
}
