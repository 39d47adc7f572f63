//! Passes over velocities: XSPH and vorticity.

use super::{Pairs, Pass, Records, Rows, Weights, in_space};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::simd::space::Space;
use crate::simd::{Number, Record};

/// out_i = sum_j w_j (v_j - v_i) W_ij (Schechter & Bridson 2012).
pub fn xsph<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    velocities: &[Vector],
    weights: Weights<'_>,
    records: &mut Records,
    out: &mut [Vector],
) {
    let columns = Columns::pack(pairs, positions, velocities, records);
    let (weights, factor) = weights.parts();
    in_space!(pairs, space => if weights.is_empty() {
        pairs.fill_vectors(&Xsph::<_, _, false> { kernel, space, columns, weights, factor }, out);
    } else {
        pairs.fill_vectors(&Xsph::<_, _, true> { kernel, space, columns, weights, factor }, out);
    });
}

/// out_i = sum_j (s_i + s_j) w_i / (w_i + w_j) (v_j - v_i) W_ij: the exchange of two rows of unlike inverse masses w
/// keeps their momentum. `traits` holds the strength s and w of each row; a row with w = 0
/// drags others along and is not dragged.
pub fn xsph_mixed<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    velocities: &[Vector],
    traits: &[Vector],
    records: &mut Records,
    out: &mut [Vector],
) {
    let columns = Columns::pack(pairs, positions, velocities, records);
    in_space!(pairs, space => pairs.fill_vectors(&XsphMixed { kernel, space, columns, traits }, out));
}

/// out_i = sum_j x_ij x (v_j - v_i) g_ij: the vorticity, once multiplied by the volume of a particle.
pub fn vorticity<K: Shape>(
    pairs: Pairs<'_>,
    kernel: K,
    positions: &[Vector],
    velocities: &[Vector],
    records: &mut Records,
    out: &mut [Real],
) {
    let columns = Columns::pack(pairs, positions, velocities, records);
    in_space!(pairs, space => pairs.fill(&Vorticity { kernel, space, columns }, out));
}

/// Input of all passes over velocities.
#[derive(Clone, Copy)]
struct Columns<'a> {
    positions: &'a [Vector],
    velocities: &'a [Vector],
    /// Both side by side, for lanes.
    records: &'a [Record],
}

impl<'a> Columns<'a> {
    fn pack(pairs: Pairs<'_>, positions: &'a [Vector], velocities: &'a [Vector], records: &'a mut Records) -> Self {
        let rows = positions.len().min(velocities.len());
        let records = pairs.pack(records, rows, |row| [positions[row], velocities[row]]);
        Columns { positions, velocities, records }
    }

    /// Positions and velocities of some rows.
    #[inline(always)]
    fn read<R: Rows>(&self, rows: R) -> Motion<R::Value> {
        rows.records(self.records, |row| [self.positions[row], self.velocities[row]])
    }
}

/// Position and velocity.
type Motion<M> = ((M, M), (M, M));

/// The difference of positions and its square, own less other, and that of velocities, other less own.
#[inline(always)]
fn difference<S: Space, M: Number>(space: S, own: Motion<M>, other: Motion<M>) -> (Motion<M>, M) {
    let (x, y) = space.shortest(own.0.0 - other.0.0, own.0.1 - other.0.1);
    (((x, y), (other.1.0 - own.1.0, other.1.1 - own.1.1)), x * x + y * y)
}

#[derive(Clone, Copy)]
struct Xsph<'a, K, S, const WEIGHTED: bool> {
    kernel: K,
    space: S,
    columns: Columns<'a>,
    weights: &'a [Real],
    factor: Real,
}

impl<K: Shape, S: Space, const WEIGHTED: bool> Pass<2> for Xsph<'_, K, S, WEIGHTED> {
    type Own<M: Number> = Motion<M>;

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        self.columns.read(rows)
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 2] {
        let ((_, (u, v)), square) = difference(self.space, *own, self.own(others));
        let mut w = self.kernel.at(square).0;
        if WEIGHTED {
            w = w * others.numbers(self.weights);
        }
        [w * u, w * v]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.kernel.value_scale() * self.factor);
        [x * factor, y * factor]
    }
}

#[derive(Clone, Copy)]
struct XsphMixed<'a, K, S> {
    kernel: K,
    space: S,
    columns: Columns<'a>,
    traits: &'a [Vector],
}

/// (s_i + s_j) w_i / (w_i + w_j); zero for two rows without inverse mass.
#[inline(always)]
fn exchange<M: Number>((s_i, w_i): (M, M), (s_j, w_j): (M, M)) -> M {
    (s_i + s_j) * (w_i / (w_i + w_j).larger(w_i.like(Real::MIN_POSITIVE)))
}

impl<K: Shape, S: Space> Pass<2> for XsphMixed<'_, K, S> {
    /// Motion and traits.
    type Own<M: Number> = (Motion<M>, (M, M));

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        (self.columns.read(rows), rows.vectors(self.traits))
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 2] {
        let (motion, traits) = self.own(others);
        let ((_, (u, v)), square) = difference(self.space, own.0, motion);
        let w = self.kernel.at(square).0 * exchange(own.1, traits);
        [w * u, w * v]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.kernel.value_scale());
        [x * factor, y * factor]
    }
}

#[derive(Clone, Copy)]
struct Vorticity<'a, K, S> {
    kernel: K,
    space: S,
    columns: Columns<'a>,
}

impl<K: Shape, S: Space> Pass<1> for Vorticity<'_, K, S> {
    type Own<M: Number> = Motion<M>;

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        self.columns.read(rows)
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 1] {
        let (((x, y), (u, v)), square) = difference(self.space, *own, self.own(others));
        let g = self.kernel.at(square).1;
        [g * (x * v - y * u)]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [sum]: [M; 1]) -> [M; 1] {
        [sum * sum.like(self.kernel.slope_scale())]
    }
}
