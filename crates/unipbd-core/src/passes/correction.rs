//! The displacements of the density constraint.

use super::{Pairs, Pass, Records, Rows, in_space};
use crate::kernel::Shape;
use crate::math::{Real, Vector};
use crate::simd::space::Space;
use crate::simd::{Number, Record};

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
    /// Positions and multipliers, for lanes.
    records: &'a [Record],
}

impl<K: Shape, S: Space> Pass<2> for Correction<'_, K, S> {
    /// Position and multiplier.
    type Own<M: Number> = (M, M, M);

    #[inline(always)]
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value> {
        let unpacked = |row: usize| [self.positions[row], Vector::new(self.multipliers[row], 0.0)];
        let ((x, y), (multiplier, _)) = rows.records(self.records, unpacked);
        (x, y, multiplier)
    }

    #[inline(always)]
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; 2] {
        let (other_x, other_y, multiplier) = self.own(others);
        let (x, y) = self.space.shortest(own.0 - other_x, own.1 - other_y);
        let factor = self.kernel.at(x * x + y * y).1 * (own.2 + multiplier);
        [factor * x, factor * y]
    }

    #[inline(always)]
    fn finish<M: Number>(&self, [x, y]: [M; 2]) -> [M; 2] {
        let slope = x.like(self.kernel.slope_scale());
        [x * slope, y * slope]
    }
}
