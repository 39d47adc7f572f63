//! Conjugate gradients, with a cycle through ever coarser grids as the preconditioner.

use super::couplings::Couplings;
use super::lattice::{Lattice, stride};
use super::level::Level;
use super::openings::Openings;
use super::spans::Spans;
use super::{held_by, renew};
use crate::math::Real;
use crate::parallel::Parallelism;

/// Sweeps before and after each coarser grid.
const SWEEPS: usize = 2;
/// Sweeps on the coarsest grid, and how many cells it has along an axis at most.
const LAST_SWEEPS: usize = 24;
const COARSEST: usize = 4;

/// Conjugate gradients end where the energy of a direction is less than this part of what the preconditioner expects.
const LEAST_ENERGY: f64 = 0.1;

/// When a solution is good enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Accuracy {
    /// Reduction of the residual, in the norm of the preconditioner.
    pub tolerance: f64,
    /// Most steps.
    pub most: u32,
}

/// A linear system that the multigrid cycle preconditions.
pub(super) trait Problem {
    /// When the solution is good enough.
    fn accuracy(&self) -> Accuracy;

    /// Sets a vector to zero where nothing is sought, and takes out what the operator does not see.
    fn constrain(&self, column: &mut [Real]);

    /// Applies the operator.
    fn image(&self, finest: &Level, columns: (&[Real], &mut [Real]), parallelism: Parallelism);
}

/// Solves the system of one substep.
#[derive(Default)]
pub(super) struct Multigrid {
    levels: Vec<Level>,
    direction: Vec<Real>,
    image: Vec<Real>,
}

impl Multigrid {
    /// Lays out all grids in the space outside walls.
    pub fn allocate(&mut self, lattice: &Lattice, openings: &Openings, parallelism: Parallelism) {
        let (mut width, mut height, mut count) = (lattice.width, lattice.height, 1);
        while width.max(height) > COARSEST {
            (width, height, count) = (coarser(width), coarser(height), count + 1);
        }
        self.levels.resize_with(count, Level::default);
        let mut images = lattice.images;
        (width, height) = (lattice.width, lattice.height);
        for level in &mut self.levels {
            level.resize(width, height, images);
            (width, height, images) = (coarser(width), coarser(height), images.coarser());
        }
        [&mut self.direction, &mut self.image].into_iter().for_each(|column| renew(column, lattice.len()));
        let room = &mut self.levels[0].room;
        parallelism.fill(room, |k| if openings.inverse[k] > 0.0 { 1.0 } else { 0.0 });
        self.pairs(|finer, coarser| {
            coarser.make_room(finer, parallelism);
            finer.weigh(coarser, parallelism);
        });
    }

    /// Finds the liquid cells from the depths on the finest grid. The caller then sets the couplings of that grid, and
    /// [adds them up](Self::add_up).
    pub fn find(&mut self, depth: &[Real]) {
        // The image is read only where it was just written.
        self.levels[0].spans.clear(&mut self.direction);
        self.levels.iter_mut().for_each(Level::clear);
        let finest = &mut self.levels[0];
        finest.spans.find(depth, (finest.images, finest.stride()));
        self.pairs(|finer, coarser| {
            coarser.spans.coarsen(&finer.spans, finer.stride(), coarser.stride(), coarser.cells());
        });
    }

    /// The liquid cells and the couplings of the finest grid.
    pub fn finest_couplings(&mut self) -> (&Spans, &mut Couplings) {
        let finest = &mut self.levels[0];
        (&finest.spans, &mut finest.couplings)
    }

    /// Sums the couplings of the finest grid, once the caller has set them.
    pub fn add_up(&mut self, parallelism: Parallelism) {
        self.levels[0].add_up(parallelism);
    }

    /// Couples the cells of all coarser grids.
    pub fn coarsen(&mut self, parallelism: Parallelism) {
        self.pairs(|finer, coarser| {
            coarser.couple(finer, parallelism);
            coarser.add_up(parallelism);
        });
    }

    /// Each grid with the next coarser one, the finest first.
    fn pairs(&mut self, mut visit: impl FnMut(&mut Level, &mut Level)) {
        for fine in 0..self.levels.len() - 1 {
            let (finer, coarser) = self.levels.split_at_mut(fine + 1);
            visit(&mut finer[fine], &mut coarser[0]);
        }
    }

    /// Where the finest grid holds liquid.
    pub fn spans(&self) -> &Spans {
        &self.levels[0].spans
    }

    /// Solves by conjugate gradients from zero, which `solution` holds.
    pub fn solve(
        &mut self,
        right_side: &[Real],
        solution: &mut [Real],
        problem: &impl Problem,
        parallelism: Parallelism,
    ) {
        // The right side of the finest grid is the residual all along.
        let finest = &mut self.levels[0];
        finest.spans.each(&mut finest.right_side, parallelism, |first, out| {
            out.copy_from_slice(&right_side[first..][..out.len()]);
        });
        problem.constrain(&mut finest.right_side);
        finest.images.clear(&mut finest.right_side, stride(finest.width));
        let Accuracy { tolerance, most } = problem.accuracy();
        let (mut before, mut enough) = (0.0, 0.0);
        for step in 0..most {
            self.cycle(0, parallelism);
            let finest = &mut self.levels[0];
            problem.constrain(&mut finest.x);
            let fit = finest.spans.dot(&finest.x, &finest.right_side, parallelism);
            if step == 0 {
                enough = fit * tolerance * tolerance;
            }
            if fit <= enough {
                break;
            }
            let kept = if step == 0 { 0.0 } else { (fit / before) as Real };
            before = fit;
            let (spans, found) = (&finest.spans, &finest.x);
            spans.each(&mut self.direction, parallelism, |first, direction| {
                let found = &found[first..][..direction.len()];
                for k in 0..direction.len() {
                    direction[k] = found[k] + kept * direction[k];
                }
            });
            finest.images.copy(&mut self.direction, finest.stride());
            problem.image(finest, (&self.direction, &mut self.image), parallelism);
            finest.images.clear(&mut self.image, finest.stride());
            let (direction, image) = (&self.direction, &self.image);
            let energy = spans.dot(direction, image, parallelism);
            // The preconditioner is close to the inverse: anything else is rounding.
            if energy < LEAST_ENERGY * fit {
                break;
            }
            let length = (fit / energy) as Real;
            spans.each2(solution, &mut finest.right_side, parallelism, |first, solution, residual| {
                let (direction, image) = (&direction[first..][..solution.len()], &image[first..][..solution.len()]);
                for k in 0..solution.len() {
                    solution[k] += length * direction[k];
                    residual[k] -= length * image[k];
                }
            });
        }
    }

    /// Solves approximately for the right side of a level, by a cycle over all coarser levels.
    fn cycle(&mut self, level: usize, parallelism: Parallelism) {
        let last = level + 1 == self.levels.len();
        self.levels[level].sweep_from_zero(if last { LAST_SWEEPS } else { SWEEPS }, parallelism);
        if last {
            return;
        }
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        let (fine, coarse) = (&mut finer[level], &mut coarser[0]);
        fine.residual(parallelism);
        coarse.restrict(fine, parallelism);
        self.cycle(level + 1, parallelism);
        let (finer, coarser) = self.levels.split_at_mut(level + 1);
        finer[level].prolong(&mut coarser[0], parallelism);
        finer[level].sweep(SWEEPS, parallelism);
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        self.levels.iter().map(Level::memory_bytes).sum::<usize>() + held_by(&[&self.direction, &self.image])
    }
}

/// Cells of the next coarser grid along an axis of this many, rounded up to even so that no cell lacks children.
fn coarser(cells: usize) -> usize {
    (cells / 2 + 1) & !1
}
