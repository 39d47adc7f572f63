//! The sums of the density constraint.

use super::{Pairs, Pass, Rows, Sink, Weights, in_space, store, store_vectors};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::simd::space::Space;
use crate::simd::{LANES, Number};
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

fn fill(pairs: Pairs<'_>, pass: &impl Pass<4>, out: DensityOutput<'_>) {
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
    /// The position, and the position for gradients.
    type Own<M: Number> = ((M, M), (M, M));

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        let at = rows.vectors(self.positions);
        (at, if SPLIT { rows.vectors(self.gradient_positions) } else { at })
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 4] {
        let (other_x, other_y) = others.vectors(self.positions);
        let (mut x, mut y) = self.space.shortest(own.0.0 - other_x, own.0.1 - other_y);
        let mut square = x * x + y * y;
        let (w, mut g) = self.kernel.at(square);
        if SPLIT {
            let (other_x, other_y) = others.vectors(self.gradient_positions);
            (x, y) = self.space.shortest(own.1.0 - other_x, own.1.1 - other_y);
            square = x * x + y * y;
            g = self.kernel.at(square).1;
        }
        let mut norm = g * g * square;
        if WEIGHTED {
            norm = norm * others.numbers(self.weights);
        }
        [others.counted(w), g * x, g * y, norm]
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
}
