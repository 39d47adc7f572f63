//! The passes over all pairs of neighbours. They take most of the time of a step.
//!
//! Each pass is one formula over the values of a row and of its neighbours. It is compiled for one number, which defines
//! its result, and for the lanes of each instruction set: eight rows at a time, straight from the blocks of the
//! [`NeighborList`], by the widest set of the machine. All give the same bits, because none of them fuses or reorders an
//! operation, and square roots and quotients are exact everywhere. In f64 only the form for one number exists.
//!
//! In the formulas x_ij = x_i - x_j (the shortest image of it), W is the kernel and grad W = g x_ij
//! its gradient at x_i. A row's own contribution W(0) is left out.

mod correction;
mod density;
mod fields;
mod records;
mod repulsion;
mod rows;
#[cfg(not(feature = "f64"))]
mod run;
mod velocity;

pub use correction::correction;
pub use density::{DensityInput, DensityOutput, density};
pub use fields::{difference_gradient, laplacian};
pub use records::Records;
pub use repulsion::{Reach, repulsion};
pub use velocity::{vorticity, xsph, xsph_mixed};

use crate::math::{Real, Vector};
use crate::neighbors::NeighborList;
use crate::parallel::{CHUNK_ROWS, Parallelism};
use crate::periodic::Periodic;
use crate::simd::{LANES, Level, Number, Record};
use rows::{OneRow, Rows};
use std::ops::Range;

/// The pairs a pass runs over, and how.
#[derive(Clone, Copy)]
pub struct Pairs<'a> {
    list: &'a NeighborList,
    periodic: Periodic,
    parallelism: Parallelism,
    #[cfg_attr(feature = "f64", allow(dead_code))]
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

    /// Runs a pass over the rows of one chunk and stores the results of a block at a time,
    /// under the numbers of its rows in the chunk.
    #[inline]
    #[cfg_attr(not(feature = "f64"), allow(unsafe_code))]
    fn run_chunk<const N: usize>(&self, pass: &impl Pass<N>, first: usize, rows: usize, sink: &mut impl Sink<N>) {
        #[cfg(not(feature = "f64"))]
        if self.level != Level::Scalar {
            assert!(first + rows <= self.rows());
            let chunks = &self.list.chunks()[first / CHUNK_ROWS..];
            if let Some(next) = chunks.get(1) {
                run::prefetch(next);
            }
            // SAFETY: the list takes its entries from row numbers below `reach()`, checked when it was
            // built, and its own rows are below that too.
            unsafe { run::run(self.level, pass, &chunks[0], first..first + rows, self.list.reach(), sink) };
            return;
        }
        debug_assert_eq!(first % CHUNK_ROWS, 0);
        for block in (0..rows).step_by(LANES) {
            let valid = LANES.min(rows - block);
            let mut sums = [[0.0; LANES]; N];
            for lane in 0..valid {
                let row = self.sum_row(pass, first + block + lane);
                sums.iter_mut().zip(row).for_each(|(lanes, value)| lanes[lane] = value);
            }
            sink.store(block..block + valid, &sums);
        }
    }

    /// The result of one row, one neighbour after the other.
    fn sum_row<const N: usize>(&self, pass: &impl Pass<N>, row: usize) -> [Real; N] {
        let own = pass.own(OneRow { row, from: row });
        let mut sums = [0.0; N];
        self.list.for_each(row, |other| {
            let terms = pass.terms(&own, OneRow { row: other, from: row });
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        });
        pass.finish(sums)
    }

    /// Puts the first `rows` rows of two columns side by side for lanes; a single row reads the columns, and
    /// where all sleep the records are not read.
    fn pack<'r>(&self, records: &'r mut Records, rows: usize, record: impl Fn(usize) -> Record + Sync) -> &'r [Record] {
        if cfg!(feature = "f64") || self.level == Level::Scalar || self.rows() == 0 {
            return &[];
        }
        let packed = records.rows_mut(rows);
        self.parallelism.fill(packed, record);
        packed
    }

    fn fill(&self, pass: &impl Pass<1>, out: &mut [Real]) {
        self.check(out.len());
        self.parallelism.chunks(out, |first, out| {
            self.run_chunk(pass, first, out.len(), &mut Scalars(out));
        });
    }

    fn fill_vectors(&self, pass: &impl Pass<2>, out: &mut [Vector]) {
        self.check(out.len());
        self.parallelism.chunks(out, |first, out| {
            self.run_chunk(pass, first, out.len(), &mut Vectors(out));
        });
    }

    fn check(&self, rows: usize) {
        assert_eq!(rows, self.rows(), "an output has as many rows as the list");
    }
}

/// Where the results of a chunk go. (Not a closure: those are not inlined into code for an instruction set.)
pub(super) trait Sink<const N: usize> {
    /// Stores the results of some rows of the chunk.
    fn store(&mut self, rows: Range<usize>, results: &[[Real; LANES]; N]);
}

struct Scalars<'a>(&'a mut [Real]);

impl Sink<1> for Scalars<'_> {
    #[inline(always)]
    fn store(&mut self, rows: Range<usize>, [values]: &[[Real; LANES]; 1]) {
        store(&mut self.0[rows], values);
    }
}

struct Vectors<'a>(&'a mut [Vector]);

impl Sink<2> for Vectors<'_> {
    #[inline(always)]
    fn store(&mut self, rows: Range<usize>, [x, y]: &[[Real; LANES]; 2]) {
        store_vectors(&mut self.0[rows], x, y);
    }
}

/// Writes the results of a block, which the last block of a set may fill in part.
#[inline(always)]
fn store(out: &mut [Real], values: &[Real; LANES]) {
    match <&mut [Real; LANES]>::try_from(&mut *out) {
        Ok(whole) => *whole = *values,
        Err(_) => out.iter_mut().zip(values).for_each(|(slot, &value)| *slot = value),
    }
}

/// As [`store`], for vectors.
#[inline(always)]
fn store_vectors(out: &mut [Vector], x: &[Real; LANES], y: &[Real; LANES]) {
    match <&mut [Vector; LANES]>::try_from(&mut *out) {
        Ok(whole) => *whole = std::array::from_fn(|lane| Vector::new(x[lane], y[lane])),
        Err(_) => out.iter_mut().zip(x.iter().zip(y)).for_each(|(slot, (&x, &y))| *slot = Vector::new(x, y)),
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
    /// The column, if there is one, and the factor common to all rows.
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

/// A pass that sums `N` numbers per row.
trait Pass<const N: usize>: Sync {
    /// The values of a row itself.
    type Own<M: Number>: Copy;

    /// Reads the values of rows.
    fn own<R: Rows>(&self, rows: R) -> Self::Own<R::Value>;

    /// The contributions of a neighbour of each row to the sums. A lane without a neighbour repeats its own row: what is
    /// not zero there must be cleared by [`Rows::counted`].
    fn terms<R: Rows>(&self, own: &Self::Own<R::Value>, others: R) -> [R::Value; N];

    /// The result of a row from its sums.
    fn finish<M: Number>(&self, sums: [M; N]) -> [M; N];
}

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
