//! The sums of the density constraint.

use super::{Pairs, Pass, Sink, Weights, in_space, rows_if, store, store_vectors};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::simd::LANES;
use crate::simd::Number;
use crate::simd::space::Space;
use std::ops::Range;

/// Input of the density pass.
#[derive(Clone, Copy)]
pub struct DensityInput<'a> {
    /// Where W is taken.
    pub positions: &'a [Vector],
    /// Where grad W is taken, if not at `positions`.
    pub gradient_positions: Option<&'a [Vector]>,
    /// The factor w_j of |grad W_ij|^2: inverse masses.
    pub weights: Weights<'a>,
    /// A factor on grad W in the response, about the volume of a particle [m^2]: without it small spacings leave the
    /// range of f32. A power of two changes no digit.
    pub unit: Real,
}

/// Output of the density pass: one row per row of the list.
pub struct DensityOutput<'a> {
    /// sum_j W_ij [1/m^2].
    pub value: &'a mut [Real],
    /// sum_j grad W_ij [1/m^3].
    pub gradient: &'a mut [Vector],
    /// sum_j w_j |unit grad W_ij|^2.
    pub response: &'a mut [Real],
}

impl Sink<4> for DensityOutput<'_> {
    #[inline(always)]
    fn store(&mut self, rows: Range<usize>, [w, x, y, q]: &[[Real; LANES]; 4]) {
        store(&mut self.value[rows.clone()], w);
        store_vectors(&mut self.gradient[rows.clone()], x, y);
        store(&mut self.response[rows], q);
    }
}

/// Sums W, grad W and w |grad W|^2 over the neighbours of each row.
pub fn density<K: Shape>(pairs: Pairs<'_>, kernel: K, input: DensityInput<'_>, out: DensityOutput<'_>) {
    in_space!(pairs, space => match (input.gradient_positions.is_some(), input.weights.is_column()) {
        (false, false) => fill(pairs, &Density::<_, _, false, false>::new(kernel, space, input), out),
        (false, true) => fill(pairs, &Density::<_, _, false, true>::new(kernel, space, input), out),
        (true, false) => fill(pairs, &Density::<_, _, true, false>::new(kernel, space, input), out),
        (true, true) => fill(pairs, &Density::<_, _, true, true>::new(kernel, space, input), out),
    })
}

fn fill(pairs: Pairs<'_>, pass: &impl super::AnyForm<4>, out: DensityOutput<'_>) {
    pairs.check(out.value.len());
    pairs.parallelism.chunks3(out.value, out.gradient, out.response, |first, value, gradient, response| {
        pairs.run_chunk(pass, first, value.len(), &mut DensityOutput { value, gradient, response });
    });
}

/// `SPLIT`: gradients at other positions. `WEIGHTED`: a weight for each row.
#[derive(Clone, Copy)]
struct Density<'a, K, S, const SPLIT: bool, const WEIGHTED: bool> {
    kernel: K,
    space: S,
    positions: &'a [Vector],
    gradient_positions: &'a [Vector],
    weights: &'a [Real],
    factor: Real,
    unit: Real,
}

impl<'a, K: Shape, S: Space, const SPLIT: bool, const WEIGHTED: bool> Density<'a, K, S, SPLIT, WEIGHTED> {
    fn new(kernel: K, space: S, input: DensityInput<'a>) -> Self {
        let (weights, factor) = input.weights.parts();
        let gradient_positions = input.gradient_positions.unwrap_or(input.positions);
        Density { kernel, space, positions: input.positions, gradient_positions, weights, factor, unit: input.unit }
    }
}

impl<K: Shape, S: Space, const SPLIT: bool, const WEIGHTED: bool> Pass<4> for Density<'_, K, S, SPLIT, WEIGHTED> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 4] {
        let [mut value, mut gradient_x, mut gradient_y, mut response] = [0.0; 4];
        list.for_each(row, |j| {
            let apart = self.positions[row] - self.positions[j];
            let (mut x, mut y) = self.space.shortest(apart.x, apart.y);
            let mut square = x * x + y * y;
            let (w, mut g) = self.kernel.at(square);
            if SPLIT {
                let apart = self.gradient_positions[row] - self.gradient_positions[j];
                (x, y) = self.space.shortest(apart.x, apart.y);
                square = x * x + y * y;
                g = self.kernel.at(square).1;
            }
            let norm = g * g * square;
            value += w;
            gradient_x += g * x;
            gradient_y += g * y;
            response += if WEIGHTED { norm * self.weights[j] } else { norm };
        });
        self.finish([value, gradient_x, gradient_y, response])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [value, x, y, response]: [M; 4]) -> [M; 4] {
        let slope = self.kernel.slope_scale();
        let in_units = slope * self.unit;
        [
            value * value.like(self.kernel.value_scale()),
            x * x.like(slope),
            y * y.like(slope),
            response * response.like(in_units * in_units * self.factor),
        ]
    }

    fn shortest_column(&self) -> usize {
        self.positions.len().min(self.gradient_positions.len()).min(rows_if(WEIGHTED, self.weights))
    }
}

#[cfg(not(feature = "f64"))]
mod lanes {
    use super::super::run::LanePass;
    use super::*;
    use crate::simd::lanes::{ColumnPair, Entry, Turn};

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space, const SPLIT: bool, const WEIGHTED: bool> LanePass<4> for Density<'_, K, S, SPLIT, WEIGHTED> {
        /// The position, and the position for gradients.
        type Own<F: Turn> = ((F, F), (F, F));

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe {
                let at = F::gather_vectors(self.positions.as_ptr().add(base), entries);
                (at, if SPLIT { F::gather_vectors(self.gradient_positions.as_ptr().add(base), entries) } else { at })
            }
        }

        #[inline(always)]
        unsafe fn terms<F: Turn, E: Entry>(
            &self,
            own: &Self::Own<F>,
            base: usize,
            entries: &ColumnPair<E>,
            counted: impl Fn(F) -> F,
        ) -> [F; 4] {
            // SAFETY: the caller vouches that all rows are within the columns.
            let gather = |from: &[Vector]| unsafe { F::gather_vectors(from.as_ptr().add(base), entries) };
            let (other_x, other_y) = gather(self.positions);
            let (mut x, mut y) = self.space.shortest(own.0.0 - other_x, own.0.1 - other_y);
            let mut square = x * x + y * y;
            let (w, mut g) = self.kernel.at(square);
            if SPLIT {
                let (other_x, other_y) = gather(self.gradient_positions);
                (x, y) = self.space.shortest(own.1.0 - other_x, own.1.1 - other_y);
                square = x * x + y * y;
                g = self.kernel.at(square).1;
            }
            let mut norm = g * g * square;
            if WEIGHTED {
                // SAFETY: as above.
                norm = norm * unsafe { F::gather(self.weights.as_ptr().add(base), entries) };
            }
            // Padding lies at distance zero: its W must be cleared, its gradient is zero anyway.
            [counted(w), g * x, g * y, norm]
        }
    }
}
