//! Rows sorted by cell, and the index that finds the rows near a point.

use super::cells::{Cells, Span};
use super::cursor::Cursor;
use super::order::{CountingSort, Extent};
use super::sparse::SparseIndex;
use crate::bytes::held;
use crate::math::{Real, Vector};
use crate::parallel::Parallelism;
use crate::periodic::Periodic;
use std::ops::Range;

/// A table of all cells of the bounding box is used up to this many cells per row...
const CELLS_PER_ROW: u64 = 8;
/// ...and always up to this many.
const CELLS_ALWAYS: u64 = 4096;

/// How cells are found.
enum Index {
    /// A table of all cells of the bounding box: where each cell's rows end.
    Dense { extent: Extent, along: u32, ends: Vec<u32> },
    /// Only the occupied cells.
    Sparse,
}

/// Sorts rows by cell and finds the rows near a point.
pub struct Grid {
    periodic: Periodic,
    cells: Cells,
    index: Index,
    rows: usize,
    order: Vec<u32>,
    sort: CountingSort,
    sparse: SparseIndex,
    /// The table of the dense index while it is not in use, and that of the passive rows.
    spare: Vec<u32>,
}

impl Grid {
    /// A grid without rows.
    pub fn new(periodic: Periodic) -> Grid {
        Grid {
            periodic,
            cells: Cells::new(1.0, periodic),
            index: Index::Sparse,
            rows: 0,
            order: Vec::new(),
            sort: CountingSort::default(),
            sparse: SparseIndex::default(),
            spare: Vec::new(),
        }
        .indexed_empty()
    }

    fn indexed_empty(mut self) -> Grid {
        self.sparse.index();
        self
    }

    /// Which axes repeat.
    pub fn periodic(&self) -> Periodic {
        self.periodic
    }

    /// Number of rows in the index.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Sorts rows by cell, for searches within `radius` \[m], and returns the old row of each new row.
    ///
    /// Rows `..dense` are sorted among themselves and indexed; the passive rows `dense..` are sorted
    /// among themselves, for locality, and not indexed. Within a cell the old order is kept. The
    /// index speaks of new rows: it is right once the caller has permuted its columns.
    pub fn order(&mut self, positions: &[Vector], dense: usize, radius: Real, parallelism: Parallelism) -> &[u32] {
        let (indexed, passive) = positions.split_at(dense);
        self.order_both(indexed, passive, radius, parallelism);
        self.order[dense..].iter_mut().for_each(|row| *row += dense as u32);
        &self.order
    }

    /// As [`order`](Self::order), of two columns: returns the order of the indexed rows, and that of
    /// the passive ones among themselves.
    pub(super) fn order_both(
        &mut self,
        indexed: &[Vector],
        passive: &[Vector],
        radius: Real,
        parallelism: Parallelism,
    ) -> (&[u32], &[u32]) {
        let rows = indexed.len() + passive.len();
        assert!(u32::try_from(rows).is_ok(), "row numbers are 32 bits wide");
        self.cells = Cells::new(radius, self.periodic);
        self.rows = indexed.len();
        let mut order = std::mem::take(&mut self.order);
        order.resize(rows, 0);
        let (indexed_order, passive_order) = order.split_at_mut(indexed.len());
        self.sort_passive(passive, passive_order, parallelism);
        self.sort_indexed(indexed, indexed_order, parallelism);
        self.order = order;
        self.order.split_at(self.rows)
    }

    fn take_table(&mut self) -> Vec<u32> {
        match std::mem::replace(&mut self.index, Index::Sparse) {
            Index::Dense { ends, .. } => ends,
            Index::Sparse => std::mem::take(&mut self.spare),
        }
    }

    fn sort_passive(&mut self, positions: &[Vector], order: &mut [u32], parallelism: Parallelism) {
        if positions.is_empty() {
            return;
        }
        let extent = Extent::of(positions, &self.cells, parallelism);
        if is_compact(&extent, positions.len()) {
            let mut table = self.take_table();
            self.sort.sort(positions, &self.cells, &extent, order, &mut table, parallelism);
            self.spare = table;
        } else {
            self.sparse.sort(positions, &self.cells, order, parallelism);
        }
    }

    fn sort_indexed(&mut self, positions: &[Vector], order: &mut [u32], parallelism: Parallelism) {
        let extent = Extent::of(positions, &self.cells, parallelism);
        let mut ends = self.take_table();
        if is_compact(&extent, positions.len()) {
            self.sort.sort(positions, &self.cells, &extent, order, &mut ends, parallelism);
            self.index = Index::Dense { extent, along: extent.bins().0 as u32, ends };
        } else {
            self.spare = ends;
            self.sparse.sort(positions, &self.cells, order, parallelism);
            self.sparse.index();
        }
    }

    /// Visits runs of consecutive rows that together hold every indexed row whose position, when
    /// sorted, was within `radius` of `point`, and some more; no row twice.
    #[inline]
    pub fn for_each_run(&self, point: Vector, radius: Real, cursor: &mut Cursor, visit: impl FnMut(Range<u32>)) {
        self.for_each_run_around(point, point, radius, cursor, visit);
    }

    /// Visits runs of consecutive rows that together hold every indexed row whose position, when
    /// sorted, was within `radius` of a point of the box from `low` to `high`, and some more; no row
    /// twice. On a periodic axis a box must not cross the border.
    #[inline]
    pub(super) fn for_each_run_around(
        &self,
        low: Vector,
        high: Vector,
        radius: Real,
        cursor: &mut Cursor,
        mut visit: impl FnMut(Range<u32>),
    ) {
        let (rows, more_rows) = self.cells.rows.near(low.y, high.y, radius);
        let (bins, more_bins) = self.cells.bins.near(low.x, high.x, radius);
        self.runs_in(rows, bins, cursor, &mut visit);
        if more_bins.is_none() && more_rows.is_none() {
            return;
        }
        if let Some(more_bins) = more_bins {
            self.runs_in(rows, more_bins, cursor, &mut visit);
        }
        if let Some(more_rows) = more_rows {
            self.runs_in(more_rows, bins, cursor, &mut visit);
            if let Some(more_bins) = more_bins {
                self.runs_in(more_rows, more_bins, cursor, &mut visit);
            }
        }
    }

    #[inline(always)]
    fn runs_in(&self, rows: Span, bins: Span, cursor: &mut Cursor, visit: &mut impl FnMut(Range<u32>)) {
        match &self.index {
            Index::Dense { extent, along, ends } => {
                let (first, last) = (bins.first.max(extent.first.bin), bins.last.min(extent.last.bin));
                if first > last {
                    return;
                }
                let (from, to) = ((first - extent.first.bin) as usize, (last - extent.first.bin) as usize);
                for row in rows.first.max(extent.first.row)..=rows.last.min(extent.last.row) {
                    let base = (row - extent.first.row) as usize * *along as usize;
                    let start = if base + from == 0 { 0 } else { ends[base + from - 1] };
                    let end = ends[base + to];
                    if start < end {
                        visit(start..end);
                    }
                }
            }
            Index::Sparse => {
                // A search much wider than the cells takes whole rows, rather than walk the empty ones.
                if i64::from(rows.last) - i64::from(rows.first) > 16 {
                    let run = self.sparse.whole_rows(rows.first, rows.last);
                    return if run.start < run.end {
                        visit(run)
                    };
                }
                for row in rows.first..=rows.last {
                    let run = self.sparse.run(row, bins.first, bins.last, cursor);
                    if run.start < run.end {
                        visit(run);
                    }
                }
            }
        }
    }

    /// Visits every indexed row whose position, when sorted, was within `radius` of `point`, and some
    /// more: the caller tests the distance. For particles that have moved since, see
    /// [`SkinList::for_each_near`](super::SkinList::for_each_near).
    #[inline]
    pub fn for_each_near(&self, point: Vector, radius: Real, mut visit: impl FnMut(usize)) {
        self.for_each_run(point, radius, &mut Cursor::default(), |run| run.for_each(|row| visit(row as usize)));
    }

    /// Whether all cells of the bounding box are in a table (a measure of cost, not of the result).
    pub fn is_dense(&self) -> bool {
        matches!(self.index, Index::Dense { .. })
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        let table = match &self.index {
            Index::Dense { ends, .. } => held(ends),
            Index::Sparse => 0,
        };
        table + held(&self.spare) + held(&self.order) + self.sort.memory_bytes() + self.sparse.memory_bytes()
    }
}

fn is_compact(extent: &Extent, rows: usize) -> bool {
    extent.bins().1 <= CELLS_ALWAYS.max(CELLS_PER_ROW * rows as u64)
}
