//! Cells of a grid that hold liquid. All other cells stay zero and are not visited.

use super::images::Images;
use crate::bytes::held;
use crate::math::Real;
use crate::parallel::{CHUNK_ROWS, Parallelism};
use std::ops::Range;

/// Spans begin and end at multiples of this many cells, as rows do.
pub(super) const BLOCK: usize = 8;
/// Gaps of at most this many cells are included in a span: this is cheaper than a new span.
const GAP: u32 = 16;

/// Runs of cells that include all liquid cells, by chunk. A run may continue into the next row, across the rim.
#[derive(Default)]
pub(super) struct Spans {
    /// Flags of the blocks of cells that are included.
    marks: Vec<bool>,
    /// First cell of each span, and the one after its last.
    spans: Vec<[u32; 2]>,
    /// Spans up to the end of each chunk.
    ends: Vec<u32>,
    /// Cells in all spans.
    cells: usize,
}

/// Loops over the spans of one or more columns of equal length.
macro_rules! spans_of_columns {
    ($($(#[$doc:meta])* $name:ident by $chunks:ident($($column:ident: $type:ident),+))+) => {
        impl Spans {$(
            $(#[$doc])*
            pub fn $name<$($type: Send),+>(
                &self,
                $($column: &mut [$type],)+
                parallelism: Parallelism,
                work: impl Fn(usize, $(&mut [$type]),+) + Sync,
            ) {
                self.loops(parallelism).$chunks($($column,)+ |first, $($column),+| {
                    for span in self.of_chunk(first) {
                        let within = span.start - first..span.end - first;
                        work(span.start, $(&mut $column[within.clone()]),+);
                    }
                });
            }
        )+}
    };
}

spans_of_columns! {
    /// Hands out a column by span, each with its first cell.
    each by chunks(a: A)
    /// As [`each`](Self::each), for two columns.
    each2 by chunks2(a: A, b: B)
    /// As [`each`](Self::each), for three columns.
    each3 by chunks3(a: A, b: B, c: C)
}

impl Spans {
    /// Finds the liquid, where the depth is not negative, and the cells to the right of and above it.
    pub fn find(&mut self, depth: &[Real], (images, stride): (Images, usize)) {
        let blocks = self.start(depth.len());
        for (block, depth) in depth.chunks(BLOCK).enumerate() {
            if depth.iter().any(|&depth| depth >= 0.0) {
                self.marks[block] = true;
                self.marks[block + 1] |= depth[BLOCK - 1] >= 0.0;
                // The last row is that of the rim.
                let above = block + stride / BLOCK;
                self.marks[above] |= above + stride / BLOCK < blocks;
            }
        }
        // The cell to the right of the last one in a row that repeats, and the cell above, are the first ones.
        images.borders(depth.len(), stride, |_, last, first| self.marks[first / BLOCK] |= depth[last] >= 0.0);
        self.collect();
    }

    /// Marks the cells of a coarser grid (factor two) whose child cells lie in the spans of the finer grid.
    pub fn coarsen(&mut self, finer: &Spans, finer_stride: usize, stride: usize, cells: usize) {
        self.start(cells);
        let coarser = |k: usize| k.div_ceil(2);
        for &[start, end] in &finer.spans {
            for part in by_row(start as usize..end as usize, finer_stride) {
                let row = coarser(part.row) * stride;
                let last = coarser(part.column + part.cells.len() - 1).min(stride - 1);
                self.marks[(row + coarser(part.column)) / BLOCK..=(row + last) / BLOCK].fill(true);
            }
        }
        self.collect();
    }

    fn start(&mut self, cells: usize) -> usize {
        self.marks.clear();
        self.marks.resize(cells / BLOCK, false);
        self.marks.len()
    }

    /// Joins the blocks of a chunk that follow each other closely.
    fn collect(&mut self) {
        self.spans.clear();
        self.ends.clear();
        self.cells = 0;
        for (chunk, marks) in self.marks.chunks(CHUNK_ROWS / BLOCK).enumerate() {
            let first = self.spans.len();
            for block in (0..marks.len()).filter(|&block| marks[block]) {
                let start = (chunk * CHUNK_ROWS + block * BLOCK) as u32;
                let end = start + BLOCK as u32;
                match self.spans[first..].last_mut() {
                    Some([_, last]) if start <= *last + GAP => *last = end,
                    _ => self.spans.push([start, end]),
                }
            }
            self.cells += self.spans[first..].iter().map(|[start, end]| (end - start) as usize).sum::<usize>();
            self.ends.push(self.spans.len() as u32);
        }
    }

    /// The spans of the chunk that begins at this cell.
    fn of_chunk(&self, first: usize) -> impl Iterator<Item = Range<usize>> {
        let chunk = first / CHUNK_ROWS;
        let start = if chunk == 0 { 0 } else { self.ends[chunk - 1] };
        let spans = &self.spans[start as usize..self.ends[chunk] as usize];
        spans.iter().map(|[start, end]| *start as usize..*end as usize)
    }

    /// Visits the cells of all spans, in order.
    pub fn each_range(&self, mut visit: impl FnMut(Range<usize>)) {
        self.spans.iter().for_each(|[start, end]| visit(*start as usize..*end as usize));
    }

    /// A pool where there is enough to do for one.
    fn loops(&self, parallelism: Parallelism) -> Parallelism {
        if parallelism.pays(self.cells) { parallelism } else { Parallelism::Serial }
    }

    /// The sum of products of two columns, in an order that depends on nothing but the spans.
    pub fn dot(&self, a: &[Real], b: &[Real], parallelism: Parallelism) -> f64 {
        let of_chunk = |cells: Range<usize>| {
            let mut sums = [0.0; BLOCK];
            for span in self.of_chunk(cells.start) {
                let (a, b) = (a[span.clone()].as_chunks::<BLOCK>().0, b[span].as_chunks::<BLOCK>().0);
                for (a, b) in a.iter().zip(b) {
                    for lane in 0..BLOCK {
                        sums[lane] += a[lane] * b[lane];
                    }
                }
            }
            sums.into_iter().map(f64::from).sum::<f64>()
        };
        self.loops(parallelism).reduce(a.len(), of_chunk, |a, b| a + b)
    }

    /// Sets a column to zero where it may be nonzero.
    pub fn clear<T: Default + Copy>(&self, column: &mut [T]) {
        for [start, end] in &self.spans {
            column[*start as usize..*end as usize].fill(T::default());
        }
    }

    /// Clears all spans: the columns are new.
    pub fn forget(&mut self) {
        self.spans.clear();
        self.ends.clear();
        self.cells = 0;
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.marks) + held(&self.spans) + held(&self.ends)
    }
}

/// Cells of one row.
pub(super) struct Part {
    pub row: usize,
    /// Column of the first one.
    pub column: usize,
    pub cells: Range<usize>,
}

/// The parts of a span, row by row.
pub(super) fn by_row(span: Range<usize>, stride: usize) -> impl Iterator<Item = Part> {
    (span.start / stride..=(span.end - 1) / stride).map(move |row| {
        let cells = span.start.max(row * stride)..span.end.min((row + 1) * stride);
        Part { row, column: cells.start - row * stride, cells }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRIDE: usize = 24;
    const CELLS: usize = STRIDE * 40;

    fn found(liquid: &[usize]) -> Spans {
        let mut depth = vec![-1.0; CELLS];
        liquid.iter().for_each(|&cell| depth[cell] = 0.5);
        let mut spans = Spans::default();
        spans.find(&depth, (Images::default(), STRIDE));
        spans
    }

    fn covered(spans: &Spans) -> Vec<bool> {
        let mut seen = vec![0; CELLS];
        spans.each(&mut seen, Parallelism::Serial, |_, seen| seen.iter_mut().for_each(|seen| *seen += 1));
        assert!(seen.iter().all(|&times| times <= 1));
        seen.into_iter().map(|times| times == 1).collect()
    }

    #[test]
    fn liquid_and_what_lies_beside_it_is_covered_once() {
        let liquid = [3 * STRIDE + 5, 3 * STRIDE + 15, 20 * STRIDE + 1, 21 * STRIDE + 8, 21 * STRIDE + 9];
        let covered = covered(&found(&liquid));
        for cell in liquid {
            assert!(covered[cell] && covered[cell + 1] && covered[cell + STRIDE], "{cell}");
        }
        assert!(covered.iter().filter(|&&covered| covered).count() <= 24 * BLOCK);
        assert!(!covered[..3 * STRIDE].contains(&true));
    }

    #[test]
    fn the_coarser_grid_covers_what_the_finer_does() {
        let liquid = [STRIDE + 1, 7 * STRIDE + 9, 8 * STRIDE + 20, 30 * STRIDE + 17];
        let (fine, mut coarse) = (found(&liquid), Spans::default());
        let (stride, rows) = (16, 22);
        coarse.coarsen(&fine, STRIDE, stride, stride * rows);
        let mut seen = vec![false; stride * rows];
        coarse.each(&mut seen, Parallelism::Serial, |_, seen| seen.fill(true));
        for cell in liquid {
            let (row, column) = (cell / STRIDE, cell % STRIDE);
            assert!(seen[row.div_ceil(2) * stride + column.div_ceil(2)], "{cell}");
        }
    }

    #[test]
    fn a_sum_takes_each_cell_once() {
        let spans = found(&[50, 51, 400, 600, 601, 602]);
        let (ones, covered) = (vec![1.0; CELLS], covered(&spans));
        let sum = spans.dot(&ones, &ones, Parallelism::Serial);
        assert_eq!(sum, covered.iter().filter(|&&covered| covered).count() as f64);
        let mut column = ones.clone();
        spans.clear(&mut column);
        assert!(column.iter().zip(covered).all(|(&value, covered)| (value == 0.0) == covered));
    }
}
