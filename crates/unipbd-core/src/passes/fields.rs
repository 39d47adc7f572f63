//! Passes over scalar fields: the gradient of differences, and the Laplacian.

use super::{Pairs, Pass, Rows, Weights, in_space};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
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

/// Position and field value.
type Sample<M> = (M, M, M);

#[inline(always)]
fn sample<R: Rows>(rows: R, positions: &[Vector], field: &[Real]) -> Sample<R::Value> {
    let (x, y) = rows.vectors(positions);
    (x, y, rows.numbers(field))
}

#[derive(Clone, Copy)]
struct Gradient<'a, K, S> {
    kernel: K,
    space: S,
    positions: &'a [Vector],
    field: &'a [Real],
}

impl<K: Shape, S: Space> Pass<2> for Gradient<'_, K, S> {
    type Own<M: Number> = Sample<M>;

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        sample(rows, self.positions, self.field)
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 2] {
        let (other_x, other_y, other) = self.own(others);
        let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
        let factor = self.kernel.at(x * x + y * y).1 * (other - own.2);
        [factor * x, factor * y]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let slope = x.like(self.kernel.slope_scale());
        [x * slope, y * slope]
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
    type Own<M: Number> = Sample<M>;

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        sample(rows, self.positions, self.field)
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 1] {
        let (other_x, other_y, other) = self.own(others);
        let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
        let mut g = self.kernel.at(x * x + y * y).1;
        if WEIGHTED {
            g = g * others.numbers(self.weights);
        }
        [g * (own.2 - other)]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [sum]: [M; 1]) -> [M; 1] {
        [sum * sum.like(self.kernel.slope_scale() * self.factor)]
    }
}
