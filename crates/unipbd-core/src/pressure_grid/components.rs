//! Parts of the fluid that meet no air: their pressure is determined up to a constant.

use super::couplings::Couplings;
use super::images::Images;
use super::spans::Spans;
use crate::bytes::held;
use crate::math::Real;
use crate::union_find::UnionFind;

/// A coupling with air at least this large connects a cell with it: less is only there to keep the system regular.
const CONNECTED: Real = 1e-3;

/// Cells of one row that are coupled from one to the next.
#[derive(Clone, Copy)]
struct Run {
    start: u32,
    end: u32,
}

/// The parts without air, each as its runs of cells.
#[derive(Default)]
pub(super) struct Components {
    runs: Vec<Run>,
    joined: UnionFind,
    /// Whether the part of each run meets air.
    airy: Vec<bool>,
    /// Runs of the closed parts, ordered by part, and the number of the part of each.
    closed: Vec<(u32, Run)>,
}

impl Components {
    /// Finds the closed parts of the fluid, from couplings that were summed.
    pub fn find(&mut self, couplings: &Couplings, spans: &Spans, (images, stride): (Images, usize)) {
        self.closed.clear();
        self.list_runs(couplings, spans);
        self.joined.reset(self.runs.len());
        self.join(&couplings.upper, stride);
        let Components { runs, joined, .. } = self;
        let run_of = |cell: usize| {
            let number = runs.partition_point(|run| run.end as usize <= cell);
            runs.get(number).filter(|run| run.start as usize <= cell).map(|_| number as u32)
        };
        images.borders(couplings.right.len(), stride, |axis, cell, other| {
            let coupling = if axis == 0 { couplings.right[cell] } else { couplings.upper[cell] };
            if coupling > 0.0
                && let (Some(run), Some(across)) = (run_of(cell), run_of(other))
            {
                joined.unite(run, across);
            }
        });
        self.airy.clear();
        self.airy.resize(self.runs.len(), false);
        for (number, run) in self.runs.iter().enumerate() {
            let root = self.joined.root(number as u32) as usize;
            let air = &couplings.air[run.start as usize..run.end as usize];
            self.airy[root] = self.airy[root] || air.iter().any(|&air| air > CONNECTED);
        }
        for (number, run) in self.runs.iter().enumerate() {
            let root = self.joined.root(number as u32) as usize;
            self.airy[number] = self.airy[root];
            if !self.airy[root] {
                self.closed.push((root as u32, *run));
            }
        }
        self.closed.sort_by_key(|(root, run)| (*root, run.start));
    }

    fn list_runs(&mut self, couplings: &Couplings, spans: &Spans) {
        self.runs.clear();
        let Couplings { right, total, .. } = couplings;
        spans.each_range(|cells| {
            let mut start = None;
            for cell in cells.clone() {
                if total[cell] > 0.0 {
                    let first = *start.get_or_insert(cell);
                    // The last cell before images is coupled with one of them.
                    if right[cell] == 0.0 || cell + 1 == cells.end || total[cell + 1] == 0.0 {
                        self.runs.push(Run { start: first as u32, end: cell as u32 + 1 });
                        start = None;
                    }
                }
            }
        });
    }

    /// Joins runs that follow each other across the end of a span, and runs of neighbouring rows.
    fn join(&mut self, upper: &[Real], stride: usize) {
        let (runs, mut above) = (&self.runs, 0);
        for (number, run) in runs.iter().enumerate() {
            if let Some(next) = runs.get(number + 1)
                && next.start == run.end
            {
                self.joined.unite(number as u32, number as u32 + 1);
            }
            let stride = stride as u32;
            while runs.get(above).is_some_and(|other| other.end <= run.start + stride) {
                above += 1;
            }
            let over = runs[above..].iter().take_while(|other| other.start < run.end + stride);
            for (offset, other) in over.enumerate() {
                let (from, to) = (run.start.max(other.start - stride), run.end.min(other.end - stride));
                if upper[from as usize..to as usize].iter().any(|&coupling| coupling > 0.0) {
                    self.joined.unite(number as u32, (above + offset) as u32);
                }
            }
        }
    }

    /// Whether a cell is of a part that meets air.
    pub fn meets_air(&self, cell: usize) -> bool {
        let number = self.runs.partition_point(|run| run.end as usize <= cell);
        self.runs.get(number).is_some_and(|run| run.start as usize <= cell && self.airy[number])
    }

    /// Whether all fluid is one part.
    pub fn are_one(&mut self) -> bool {
        let Components { runs, joined, .. } = self;
        (1..runs.len() as u32).all(|run| joined.root(run) == joined.root(0))
    }

    /// The closed parts.
    pub fn closed(&self) -> impl Iterator<Item = Part<'_>> {
        self.closed.chunk_by(|a, b| a.0 == b.0).map(Part)
    }

    /// Takes from each closed part its mean over the cells that count.
    pub fn remove_means(&self, column: &mut [Real], counts: impl Fn(usize) -> bool) {
        for part in self.closed() {
            let cells = || part.cells().filter(|&cell| counts(cell));
            let (sum, number) = cells().fold((0.0, 0.0), |(sum, n), cell| (sum + f64::from(column[cell]), n + 1.0));
            let mean = (sum / f64::max(number, 1.0)) as Real;
            cells().for_each(|cell| column[cell] -= mean);
        }
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.runs) + held(&self.airy) + held(&self.closed)
    }
}

/// A part without air.
pub(super) struct Part<'a>(&'a [(u32, Run)]);

impl Part<'_> {
    /// Its cells.
    pub fn cells(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().flat_map(|(_, run)| run.start as usize..run.end as usize)
    }
}
