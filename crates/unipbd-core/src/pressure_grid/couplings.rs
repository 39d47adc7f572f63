//! Couplings between the cells of a grid, and the operator they make.

use super::held_by;
use super::spans::Spans;
use crate::math::Real;
use crate::parallel::Parallelism;

/// Couplings by cell; all are zero where there is no liquid.
#[derive(Default)]
pub(super) struct Couplings {
    /// With the cell to the right.
    pub right: Vec<Real>,
    /// With the cell above.
    pub upper: Vec<Real>,
    /// With air.
    pub air: Vec<Real>,
    /// Sum of all couplings of a cell.
    pub total: Vec<Real>,
}

impl Couplings {
    /// Takes the couplings between cells, and their sums, from another grid of the same size.
    pub fn take(&mut self, other: &Couplings) {
        self.right.clone_from(&other.right);
        self.upper.clone_from(&other.upper);
        self.total.clone_from(&other.total);
    }

    /// Applies the couplings to a field.
    pub fn image(&self, x: &[Real], out: &mut [Real], (spans, stride): (&Spans, usize), parallelism: Parallelism) {
        let value = |x: Real, total: Real, coupled: Real, _| total * x - coupled;
        self.stencil(x, out, (spans, stride), parallelism, value, [&self.total; 2]);
    }

    /// `out = value(x, total, sum of couplings times neighbours, columns)` for each cell of the liquid.
    #[inline(always)]
    pub fn stencil(
        &self,
        x: &[Real],
        out: &mut [Real],
        (spans, stride): (&Spans, usize),
        parallelism: Parallelism,
        value: impl Fn(Real, Real, Real, [Real; 2]) -> Real + Sync,
        [a, b]: [&[Real]; 2],
    ) {
        let (right, upper, total) = (&self.right, &self.upper, &self.total);
        spans.each(out, parallelism, |first, out| {
            let count = out.len();
            let (xc, xr, xl) = (&x[first..][..count], &x[first + 1..][..count], &x[first - 1..][..count]);
            let (xu, xd) = (&x[first + stride..][..count], &x[first - stride..][..count]);
            let (cr, cl) = (&right[first..][..count], &right[first - 1..][..count]);
            let (cu, cd) = (&upper[first..][..count], &upper[first - stride..][..count]);
            let (total, a, b) = (&total[first..][..count], &a[first..][..count], &b[first..][..count]);
            for k in 0..count {
                let coupled = (cr[k] * xr[k] + cl[k] * xl[k]) + (cu[k] * xu[k] + cd[k] * xd[k]);
                out[k] = value(xc[k], total[k], coupled, [a[k], b[k]]);
            }
        });
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held_by(&[&self.right, &self.upper, &self.air, &self.total])
    }
}
