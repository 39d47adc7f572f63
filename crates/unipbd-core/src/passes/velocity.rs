//! Passes over velocities: XSPH and vorticity.

use super::Records;
use super::{Pairs, Pass, Weights, in_space, rows_if};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::simd::Number;
use crate::simd::Record;
use crate::simd::space::Space;

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
    /// Both side by side, for the lane forms.
    #[cfg_attr(feature = "f64", allow(dead_code))]
    records: &'a [Record],
}

impl<'a> Columns<'a> {
    fn pack(pairs: Pairs<'_>, positions: &'a [Vector], velocities: &'a [Vector], records: &'a mut Records) -> Self {
        let rows = positions.len().min(velocities.len());
        let records = pairs.pack(records, rows, |row| [positions[row], velocities[row]]);
        Columns { positions, velocities, records }
    }

    fn shortest(&self) -> usize {
        self.positions.len().min(self.velocities.len())
    }
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
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 2] {
        let [mut sum_x, mut sum_y] = [0.0; 2];
        list.for_each(row, |j| {
            let apart = self.columns.positions[row] - self.columns.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let mut w = self.kernel.at(x * x + y * y).0;
            if WEIGHTED {
                w *= self.weights[j];
            }
            sum_x += w * (self.columns.velocities[j].x - self.columns.velocities[row].x);
            sum_y += w * (self.columns.velocities[j].y - self.columns.velocities[row].y);
        });
        self.finish([sum_x, sum_y])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.kernel.value_scale() * self.factor);
        [x * factor, y * factor]
    }

    fn shortest_column(&self) -> usize {
        self.columns.shortest().min(rows_if(WEIGHTED, self.weights))
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
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 2] {
        let [mut sum_x, mut sum_y] = [0.0; 2];
        list.for_each(row, |j| {
            let apart = self.columns.positions[row] - self.columns.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let exchange = exchange(self.traits[row].into(), self.traits[j].into());
            let w = self.kernel.at(x * x + y * y).0 * exchange;
            sum_x += w * (self.columns.velocities[j].x - self.columns.velocities[row].x);
            sum_y += w * (self.columns.velocities[j].y - self.columns.velocities[row].y);
        });
        self.finish([sum_x, sum_y])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let factor = x.like(self.kernel.value_scale());
        [x * factor, y * factor]
    }

    fn shortest_column(&self) -> usize {
        self.columns.shortest().min(self.traits.len())
    }
}

#[derive(Clone, Copy)]
struct Vorticity<'a, K, S> {
    kernel: K,
    space: S,
    columns: Columns<'a>,
}

impl<K: Shape, S: Space> Pass<1> for Vorticity<'_, K, S> {
    fn row(&self, list: &NeighborList, row: usize) -> [Real; 1] {
        let mut sum = 0.0;
        list.for_each(row, |j| {
            let apart = self.columns.positions[row] - self.columns.positions[j];
            let (x, y) = self.space.shortest(apart.x, apart.y);
            let g = self.kernel.at(x * x + y * y).1;
            let u = self.columns.velocities[j].x - self.columns.velocities[row].x;
            let v = self.columns.velocities[j].y - self.columns.velocities[row].y;
            sum += g * (x * v - y * u);
        });
        self.finish([sum])
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [sum]: [M; 1]) -> [M; 1] {
        [sum * sum.like(self.kernel.slope_scale())]
    }

    fn shortest_column(&self) -> usize {
        self.columns.shortest()
    }
}

#[cfg(not(feature = "f64"))]
mod lanes {
    use super::super::run::LanePass;
    use super::*;
    use crate::simd::lanes::{ColumnPair, Entry, Turn};

    /// Positions and velocities.
    ///
    /// # Safety
    /// As for [`Turn::gather_records`].
    #[allow(unsafe_code)]
    #[inline(always)]
    unsafe fn gather<F: Turn, E: Entry>(
        columns: &Columns<'_>,
        base: usize,
        entries: &ColumnPair<E>,
    ) -> ((F, F), (F, F)) {
        // SAFETY: passed on to the caller.
        unsafe { F::gather_records(columns.records.as_ptr().add(base), entries) }
    }

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space, const WEIGHTED: bool> LanePass<2> for Xsph<'_, K, S, WEIGHTED> {
        /// Position and velocity.
        type Own<F: Turn> = ((F, F), (F, F));

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe { gather(&self.columns, base, entries) }
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
            let ((other_x, other_y), (u, v)): Self::Own<F> = unsafe { gather(&self.columns, base, entries) };
            let (x, y) = self.space.shortest(own.0.0 - other_x, own.0.1 - other_y);
            let mut w = self.kernel.at(x * x + y * y).0;
            if WEIGHTED {
                // SAFETY: as above.
                w = w * unsafe { F::gather(self.weights.as_ptr().add(base), entries) };
            }
            // Padding has no velocity of its own and adds nothing.
            [w * (u - own.1.0), w * (v - own.1.1)]
        }
    }

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space> LanePass<2> for XsphMixed<'_, K, S> {
        /// Position, velocity and traits.
        type Own<F: Turn> = ((F, F), (F, F), (F, F));

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe {
                let (at, velocity) = gather(&self.columns, base, entries);
                (at, velocity, F::gather_vectors(self.traits.as_ptr().add(base), entries))
            }
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
            let (((other_x, other_y), (u, v)), traits): (((F, F), (F, F)), (F, F)) = unsafe {
                let both = gather(&self.columns, base, entries);
                (both, F::gather_vectors(self.traits.as_ptr().add(base), entries))
            };
            let (x, y) = self.space.shortest(own.0.0 - other_x, own.0.1 - other_y);
            let w = self.kernel.at(x * x + y * y).0 * exchange(own.2, traits);
            // Padding has no velocity of its own and adds nothing.
            [w * (u - own.1.0), w * (v - own.1.1)]
        }
    }

    #[allow(unsafe_code)]
    impl<K: Shape, S: Space> LanePass<1> for Vorticity<'_, K, S> {
        /// Position and velocity.
        type Own<F: Turn> = ((F, F), (F, F));

        #[inline(always)]
        unsafe fn own<F: Turn>(&self, base: usize, entries: &ColumnPair<i16>) -> Self::Own<F> {
            // SAFETY: the caller vouches that all rows are within the columns.
            unsafe { gather(&self.columns, base, entries) }
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
            let ((other_x, other_y), (u, v)): Self::Own<F> = unsafe { gather(&self.columns, base, entries) };
            let (x, y) = self.space.shortest(own.0.0 - other_x, own.0.1 - other_y);
            let g = self.kernel.at(x * x + y * y).1;
            // Padding lies at distance zero and adds nothing.
            [g * (x * (v - own.1.1) - y * (u - own.1.0))]
        }
    }
}
