//! Passes over scalar fields: the gradient of differences, and the Laplacian.

use super::{Pairs, Pass, Weights, in_space, rows_if};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::simd::Number;
use crate::simd::space::Space;

/// out_i = sum_j (f_j - f_i) grad W_ij: the gradient of f, once multiplied by the volume of a particle.
pub fn difference_gradient<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    field: &[Real],
    out: &mut [Vector],
) {
    in_space!(pairs, space => pairs.fill_vectors(&Gradient { kernel, space, positions, field }, out));
}

/// out_i = sum_j w_j (f_i - f_j) g_ij: the Laplacian of f (Brookshaw 1985), once multiplied by twice
/// the volume of a particle.
pub fn laplacian<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    field: &[Real],
    weights: Weights<'_>,
    out: &mut [Real],
) {
    let (column, factor) = weights.parts();
    in_space!(pairs, space => if weights.is_column() {
        pairs.fill(&Laplacian::<_, _, true> { kernel, space, positions, field, weights: column, factor }, out)
    } else {
        pairs.fill(&Laplacian::<_, _, false> { kernel, space, positions, field, weights: column, factor }, out)
    });
}

#[derive(Clone, Copy)]
struct Gradient<'a, K, S> {
    kernel: K,
    space: S,
    positions: &'a [Vector],
    field: &'a [Real],
}

impl<K: Shape, S: Space> Pass<2> for Gradient<'_, K, S> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 2] {
        let [mut sum_x, mut sum_y] = [0.0; 2];
        list.for_each(row, |j| {
            let apart = self.positions[row] - self.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let factor = self.kernel.at(x * x + y * y).1 * (self.field[j] - self.field[row]);
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
        self.positions.len().min(self.field.len())
    }
}

#[derive(Clone, Copy)]
struct Laplacian<'a, K, S, const WEIGHTED: bool> {
    kernel: K,
    space: S,
    positions: &'a [Vector],
    field: &'a [Real],
    weights: &'a [Real],
    factor: Real,
}

impl<K: Shape, S: Space, const WEIGHTED: bool> Pass<1> for Laplacian<'_, K, S, WEIGHTED> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 1] {
        let mut sum = 0.0;
        list.for_each(row, |j| {
            let apart = self.positions[row] - self.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let mut g = self.kernel.at(x * x + y * y).1;
            if WEIGHTED {
                g *= self.weights[j];
            }
            sum += g * (self.field[row] - self.field[j]);
        });
        self.finish([sum])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [sum]: [M; 1]) -> [M; 1] {
        [sum * sum.like(self.kernel.slope_scale() * self.factor)]
    }

    fn shortest_column(&self) -> usize {
        self.positions.len().min(self.field.len()).min(rows_if(WEIGHTED, self.weights))
    }
}

#[cfg(not(feature = "f64"))]
mod lanes {
    use super::super::run::LanePass;
    use super::*;
    use crate::simd::lanes::{ColumnPair, Entry, Turn};

    /// Position and field value.
    ///
    /// # Safety
    /// As for [`Turn::gather`], in both columns.
    #[allow(unsafe_code)]
    #[inline(always)]
    unsafe fn gather_both<F: Turn, E: Entry>(
        positions: &[Vector],
        field: &[Real],
        base: usize,
        entries: &ColumnPair<E>,
    ) -> (F, F, F) {
        // SAFETY: passed on to the caller.
        unsafe {
            let (x, y) = F::gather_vectors(positions.as_ptr().add(base), entries);
            (x, y, F::gather(field.as_ptr().add(base), entries))
        }
    }

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space> LanePass<2> for Gradient<'_, K, S> {
        /// Position and field value.
        type Own<F: Turn> = (F, F, F);

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe { gather_both(self.positions, self.field, base, entries) }
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
            let (other_x, other_y, other): Self::Own<F> =
                unsafe { gather_both(self.positions, self.field, base, entries) };
            let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
            let factor = self.kernel.at(x * x + y * y).1 * (other - own.2);
            // Padding lies at distance zero and adds nothing.
            [factor * x, factor * y]
        }
    }

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space, const WEIGHTED: bool> LanePass<1> for Laplacian<'_, K, S, WEIGHTED> {
        /// Position and field value.
        type Own<F: Turn> = (F, F, F);

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe { gather_both(self.positions, self.field, base, entries) }
        }

        #[inline(always)]
        unsafe fn terms<F: Turn, E: Entry>(
            &self,
            own: &Self::Own<F>,
            base: usize,
            entries: &ColumnPair<E>,
            _counted: impl Fn(F) -> F,
        ) -> [F; 1] {
            // SAFETY: the caller vouches that all rows are within the columns.
            let (other_x, other_y, other): Self::Own<F> =
                unsafe { gather_both(self.positions, self.field, base, entries) };
            let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
            let mut g = self.kernel.at(x * x + y * y).1;
            if WEIGHTED {
                // SAFETY: as above.
                g = g * unsafe { F::gather(self.weights.as_ptr().add(base), entries) };
            }
            // Padding has no difference of its own and adds nothing.
            [g * (own.2 - other)]
        }
    }
}
