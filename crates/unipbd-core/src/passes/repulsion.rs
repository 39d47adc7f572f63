//! A repulsion of close pairs.

use super::{Pairs, Pass, Rows, Weights, in_space};
use crate::math::{Real, Vector};
use crate::simd::Number;
use crate::simd::space::Space;

/// Distances between which a repulsion grows as a pair comes closer \[m].
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
    /// Position, and order of the row.
    type Own<M: Number> = (M, M, M);

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        let (x, y) = rows.vectors(self.positions);
        (x, y, rows.order())
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 2] {
        let (other_x, other_y, order) = self.own(others);
        let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
        let square = x * x + y * y;
        let mut push = others.counted(self.overlap(square));
        if WEIGHTED {
            push = push * others.numbers(self.weights);
        }
        let (push_x, push_y) = Self::along(x, y, square, push, own.2.where_below(order, x.like(-1.0), x.like(1.0)));
        [push_x, push_y]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.factor);
        [x * factor, y * factor]
    }
}
