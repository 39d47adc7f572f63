//! One file per family of passes: the scalar form that defines it, and the lane form beside it.

mod correction;
mod density;
mod fields;
mod repulsion;
mod velocity;

pub use correction::correction;
pub use density::{DensityInput, DensityOutput, density};
pub use fields::{difference_gradient, laplacian};
pub use repulsion::repulsion;
pub use velocity::{vorticity, xsph};

use super::Level;
#[cfg(not(feature = "f64"))]
use super::run::{self, LanePass};
use super::shapes::Number;
use crate::math::{Real, Vector};
use crate::neighbors::{NeighborList, Periodic};
use crate::parallel::{CHUNK_ROWS, Parallelism};

/// The pairs a pass runs over, and how.
#[derive(Clone, Copy)]
pub struct Pairs<'a> {
    list: &'a NeighborList,
    periodic: Periodic,
    parallelism: Parallelism,
    level: Level,
}

impl<'a> Pairs<'a> {
    /// All pairs of a list. The list may hold more pairs than are within the kernel's radius: they count for nothing.
    pub fn new(list: &'a NeighborList, periodic: Periodic, parallelism: Parallelism) -> Self {
        Pairs { list, periodic, parallelism, level: Level::best() }
    }

    /// The same pairs by another instruction set, if the machine has it. Results do not change.
    pub fn at_level(self, level: Level) -> Self {
        if Level::available().contains(&level) { Pairs { level, ..self } } else { self }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.list.rows()
    }

    /// Runs a pass over the rows of one chunk and emits the result of each row under its number in the chunk.
    #[inline]
    #[cfg_attr(not(feature = "f64"), allow(unsafe_code))]
    fn run_chunk<P: AnyForm<N>, const N: usize>(
        &self,
        pass: &P,
        first: usize,
        rows: usize,
        mut emit: impl FnMut(usize, [Real; N]),
    ) {
        #[cfg(not(feature = "f64"))]
        if self.level != Level::Scalar {
            assert!(pass.shortest_column() >= self.rows() && first + rows <= self.rows());
            let chunk = &self.list.chunks()[first / CHUNK_ROWS];
            // SAFETY: the list takes its entries from row numbers below `rows()`, checked when it was
            // built, and every column of the pass has at least that many rows.
            unsafe { run::run(self.level, pass, chunk, first, rows, emit) };
            return;
        }
        debug_assert_eq!(first % CHUNK_ROWS, 0);
        for row in 0..rows {
            emit(row, pass.row(self.list, first + row));
        }
    }

    fn fill<P: AnyForm<1>>(&self, pass: &P, out: &mut [Real]) {
        self.check(out.len());
        self.parallelism.chunks(out, |first, out| {
            self.run_chunk(pass, first, out.len(), |row, [value]: [Real; 1]| out[row] = value);
        });
    }

    fn fill_vectors<P: AnyForm<2>>(&self, pass: &P, out: &mut [Vector]) {
        self.check(out.len());
        self.parallelism.chunks(out, |first, out| {
            self.run_chunk(pass, first, out.len(), |row, [x, y]: [Real; 2]| out[row] = Vector::new(x, y));
        });
    }

    fn check(&self, rows: usize) {
        assert_eq!(rows, self.rows(), "an output has as many rows as the list");
    }
}

/// A factor per row: the same for all, or a column.
#[derive(Clone, Copy, Debug)]
pub enum Weights<'a> {
    /// The same for all rows; costs nothing per pair.
    Uniform(Real),
    /// One for each row.
    Column(&'a [Real]),
}

impl<'a> Weights<'a> {
    /// The column, or nothing, and the factor common to all rows.
    fn parts(self) -> (&'a [Real], Real) {
        match self {
            Weights::Uniform(factor) => (&[], factor),
            Weights::Column(column) => (column, 1.0),
        }
    }

    fn is_column(self) -> bool {
        matches!(self, Weights::Column(_))
    }
}

/// Rows of a column that is read only where `used`.
fn rows_if(used: bool, column: &[Real]) -> usize {
    if used { column.len() } else { usize::MAX }
}

/// A pass that sums `N` numbers per row: its scalar form.
pub(super) trait Pass<const N: usize>: Sync {
    /// The result for one row.
    fn row(&self, list: &NeighborList, row: usize) -> [Real; N];

    /// What a row gets from its sums.
    fn finish<M: Number>(&self, sums: [M; N]) -> [M; N];

    /// Rows that every column it reads has.
    fn shortest_column(&self) -> usize;
}

/// A pass in all forms this build has.
#[cfg(not(feature = "f64"))]
trait AnyForm<const N: usize>: LanePass<N> {}
#[cfg(not(feature = "f64"))]
impl<P: LanePass<N>, const N: usize> AnyForm<N> for P {}
#[cfg(feature = "f64")]
trait AnyForm<const N: usize>: Pass<N> {}
#[cfg(feature = "f64")]
impl<P: Pass<N>, const N: usize> AnyForm<N> for P {}

/// Runs an expression with `space` for the domain of `pairs`.
macro_rules! in_space {
    ($pairs:expr, $space:ident => $run:expr) => {
        if $pairs.periodic.any() {
            let $space = crate::simd::space::Wrapped::new($pairs.periodic);
            $run
        } else {
            let $space = crate::simd::space::Open;
            $run
        }
    };
}
use in_space;
