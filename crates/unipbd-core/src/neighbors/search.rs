//! The neighbour search of a run: grid, list and skin, kept valid while particles move.

use super::{Cursor, Grid, ListCost, Motion, NeighborList, SkinList};
use crate::bytes::{Damage, Reader, Writer, held};
use crate::math::{Real, Vector};
use crate::parallel::Parallelism;
use crate::particles::{Particles, Scratch};
use crate::periodic::Periodic;
use std::ops::Range;

/// The positions for which a list must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchPositions {
    /// The predicted ones only.
    Predicted,
    /// Those at the start of the substep too.
    StartAndPredicted,
}

/// Whether [`Neighbors::prepare`] made a new list, and so a new row order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prepared {
    /// The old list still holds.
    Kept,
    /// Rows were re-sorted and listed anew.
    Rebuilt,
}

/// The saved state of the search, from which the list is made again.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SavedList {
    /// Positions the list was built at, in its row order \[m].
    reference: Vec<Vector>,
    skin: Real,
    /// Motion since then, as the search last saw it.
    motion: Motion,
}

impl SavedList {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let numbers = [self.skin, self.motion.drift.x, self.motion.drift.y, self.motion.deviation];
        numbers.into_iter().all(Real::is_finite) && self.reference.iter().all(|point| point.is_finite())
    }

    /// Whether a search within a radius can have made it: no skin is as wide.
    pub fn fits(&self, radius: Real) -> bool {
        self.skin <= radius
    }

    /// Positions that the list is made at again \[m].
    pub fn reference(&self) -> &[Vector] {
        &self.reference
    }

    /// Appends it to a saved state.
    pub fn write(&self, out: &mut Writer) {
        out.column(&self.reference);
        out.value(self.skin);
        out.value(self.motion.drift);
        out.value(self.motion.deviation);
    }

    /// Takes it from a saved state.
    pub fn read(input: &mut Reader<'_>) -> Result<Self, Damage> {
        let (reference, skin) = (input.column()?, input.value()?);
        let motion = Motion { drift: input.value()?, deviation: input.value()? };
        Ok(SavedList { reference, skin, motion })
    }
}

/// Where the rows near a point are.
#[derive(Clone, Debug)]
pub(crate) struct Runs {
    /// Rows of the grid are higher than a search reaches, so it touches three, or four by rounding; the
    /// border of a periodic axis cuts each of both directions in two.
    /// As many again of both kinds of sleeping rows.
    runs: [Range<u32>; 48],
    count: usize,
}

impl Default for Runs {
    fn default() -> Self {
        Runs { runs: std::array::from_fn(|_| 0..0), count: 0 }
    }
}

impl Runs {
    /// The runs, in order.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.runs[..self.count].iter().map(|run| run.start as usize..run.end as usize)
    }
}

/// Neighbours of the dense particles.
pub struct Neighbors {
    grid: Grid,
    list: SkinList,
    motion: Motion,
    radius: Real,
    /// Skin kept for the small moves of the projection, so that velocity passes find their pairs.
    least_skin: Real,
    cost: ListCost,
    /// Where the list is made, where it must cover more than the predicted positions.
    reference: Vec<Vector>,
    /// The sleeping rows, behind those of `grid`: those near others that are awake, then the rest.
    still: [Grid; 2],
    /// Whether the sleeping rows are those that `still` has sorted.
    still_sorted: bool,
    scratch: Scratch,
}

impl Neighbors {
    /// A search for pairs within `radius` \[m].
    pub fn new(periodic: Periodic, radius: Real, least_skin: Real, cost: ListCost) -> Self {
        Neighbors {
            grid: Grid::new(periodic),
            list: SkinList::default(),
            motion: Motion::default(),
            radius,
            least_skin,
            cost,
            reference: Vec::new(),
            still: [Grid::new(periodic), Grid::new(periodic)],
            still_sorted: true,
            scratch: Scratch::default(),
        }
    }

    /// Which axes repeat.
    pub fn periodic(&self) -> Periodic {
        self.grid.periodic()
    }

    /// The radius within which pairs are found \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// The list: all pairs within the radius, and some more.
    pub fn list(&self) -> &NeighborList {
        self.list.list()
    }

    /// Visits the neighbours of a dense row, and some rows beyond the radius.
    #[inline]
    pub fn for_each(&self, row: usize, visit: impl FnMut(usize)) {
        self.list.list().for_each(row, visit);
    }

    /// Runs of dense rows that hold every one within the kernel's radius of a point, and some more; no
    /// row twice.
    #[inline]
    pub(crate) fn runs_near(&self, point: Vector) -> Runs {
        let mut runs = Runs::default();
        self.list.for_each_run_near(&self.grid, &self.motion, point, self.radius, |run| {
            runs.runs[runs.count] = run.start as u32..run.end as u32;
            runs.count += 1;
        });
        let mut first = self.grid.rows() as u32;
        for still in self.still.iter().filter(|still| still.rows() > 0) {
            still.for_each_run(point, self.radius, &mut Cursor::default(), |run| {
                runs.runs[runs.count] = run.start + first..run.end + first;
                runs.count += 1;
            });
            first += still.rows() as u32;
        }
        runs
    }

    /// Visits every dense row within `radius` of any point, and some more.
    #[inline]
    pub fn for_each_near(&self, point: Vector, radius: Real, mut visit: impl FnMut(usize)) {
        self.list.for_each_near(&self.grid, &self.motion, point, radius, &mut visit);
        let mut first = self.grid.rows();
        for still in &self.still {
            still.for_each_near(point, radius, |row| visit(first + row));
            first += still.rows();
        }
    }

    /// Makes lists anew, with at least this skin \[m] from now on; returns the least skin of before.
    pub(crate) fn keep_skin(&mut self, least: Real) -> Real {
        // A list of a wide skin holds more memory than one of a narrow skin needs.
        self.list.clear();
        self.invalidate();
        std::mem::replace(&mut self.least_skin, least)
    }

    /// Lists built so far.
    pub fn builds(&self) -> u64 {
        self.list.builds()
    }

    /// Whether the rows of the list are those of the particles: none were added or removed since.
    pub fn is_current(&self) -> bool {
        self.list.builds() > 0 && self.list.skin() >= 0.0
    }

    /// The next [`prepare`](Self::prepare) makes a new list: rows were added or removed.
    pub fn invalidate(&mut self) {
        self.list.invalidate();
        self.still_sorted = false;
    }

    /// Brings the dense rows into a new order. The list is invalid until the next [`prepare`](Self::prepare).
    pub(crate) fn reorder_dense(&mut self, particles: &mut Particles, order: &[u32], parallelism: Parallelism) {
        particles.reorder(0, order, parallelism, &mut self.scratch);
        self.invalidate();
    }

    /// Makes sure the list holds every pair for the given positions; re-sorts all rows if it must
    /// be made anew.
    pub fn prepare(&mut self, particles: &mut Particles, at: SearchPositions, parallelism: Parallelism) -> Prepared {
        if self.holds(particles, at, parallelism) {
            return Prepared::Kept;
        }
        self.rebuild(particles, at, parallelism);
        Prepared::Rebuilt
    }

    fn holds(&mut self, particles: &Particles, at: SearchPositions, parallelism: Parallelism) -> bool {
        if self.list.reference().len() != particles.listed() || self.list.skin() < 0.0 {
            return false;
        }
        self.motion = self.moved_to(particles.positions(), parallelism);
        if !self.list.covers(&self.motion) {
            return false;
        }
        at == SearchPositions::Predicted || self.list.covers(&self.moved_to(particles.starts(), parallelism))
    }

    /// How the rows of the list have moved since it was built.
    fn moved_to(&self, positions: &[Vector], parallelism: Parallelism) -> Motion {
        self.seen(self.list.motion(&self.grid, positions, parallelism))
    }

    /// A motion of those awake as all dense rows see it.
    fn seen(&self, motion: Motion) -> Motion {
        if self.anything_still() { motion.beside_still_ones() } else { motion }
    }

    fn anything_still(&self) -> bool {
        self.still.iter().any(|still| still.rows() > 0)
    }

    fn rebuild(&mut self, particles: &mut Particles, at: SearchPositions, parallelism: Parallelism) {
        if !self.still_sorted {
            self.sort_still(particles, parallelism);
        }
        let (awake, dense) = (particles.awake(), particles.dense());
        let (start, end) = (&particles.starts()[..awake], &particles.positions()[..awake]);
        let step = self.seen(Motion::between(start, end, &self.grid, parallelism)).needed_skin();
        let skin = self.skin(step, at);
        self.set_reference(particles, at, parallelism);
        // Smoke follows the dense rows only to stay near them in memory.
        let radius = SkinList::list_radius(self.radius, skin);
        let reference = Self::reference(&self.reference, particles, at);
        let (indexed, loose) = (&reference[..awake], &reference[dense..]);
        let (order, loose_order) = self.grid.order_both(indexed, loose, radius, parallelism);
        particles.reorder(0, order, parallelism, &mut self.scratch);
        particles.reorder(dense, loose_order, parallelism, &mut self.scratch);
        self.set_reference(particles, at, parallelism);
        let reference = Self::reference(&self.reference, particles, at);
        Self::build_list(&mut self.list, &self.grid, &self.still, reference, (self.radius, skin), parallelism);
        self.motion = self.moved_to(particles.positions(), parallelism);
    }

    fn build_list(
        list: &mut SkinList,
        grid: &Grid,
        still: &[Grid; 2],
        reference: &[Vector],
        (radius, skin): (Real, Real),
        parallelism: Parallelism,
    ) {
        if still.iter().any(|still| still.rows() > 0) {
            list.build_beside(grid, still, reference, radius, skin, parallelism);
        } else {
            list.build(grid, reference, radius, skin, parallelism);
        }
    }

    /// Sorts the sleeping rows among themselves: once, until others sleep.
    fn sort_still(&mut self, particles: &mut Particles, parallelism: Parallelism) {
        self.still_sorted = true;
        if particles.asleep() == 0 && !self.anything_still() {
            return;
        }
        let radius = self.still_radius();
        for (still, rows) in self.still.iter_mut().zip(still_rows(particles)) {
            let (order, _) = still.order_both(&particles.positions()[rows.clone()], &[], radius, parallelism);
            particles.reorder(rows.start, order, parallelism, &mut self.scratch);
        }
    }

    /// The skin for particles that come nearer to each other by up to `step` per substep.
    fn skin(&self, step: Real, at: SearchPositions) -> Real {
        let wanted = self.cost.skin(step / self.radius) * self.radius;
        // From the middle of the substep both its ends are half a step away.
        let needed = if at == SearchPositions::StartAndPredicted { 0.5 * step * 1.001 } else { 0.0 };
        wanted.max(self.least_skin).max(needed)
    }

    /// Finds the positions to make a list at, where they are not the predicted ones.
    fn set_reference(&mut self, particles: &Particles, at: SearchPositions, parallelism: Parallelism) {
        if at == SearchPositions::Predicted {
            return;
        }
        let (start, end) = (particles.starts(), particles.positions());
        let periodic = self.grid.periodic();
        self.reference.resize(end.len(), Vector::ZERO);
        self.reference[particles.awake()..particles.dense()]
            .copy_from_slice(&end[particles.awake()..particles.dense()]);
        for rows in particles.bands() {
            let first = rows.start;
            parallelism.fill(&mut self.reference[rows], |row| {
                let (start, end) = (start[first + row], end[first + row]);
                periodic.wrap(start + 0.5 * periodic.min_image(end - start))
            });
        }
    }

    /// The positions to make a list at.
    fn reference<'a>(middle: &'a [Vector], particles: &'a Particles, at: SearchPositions) -> &'a [Vector] {
        match at {
            SearchPositions::Predicted => particles.positions(),
            SearchPositions::StartAndPredicted => middle,
        }
    }

    /// The state from which the same list can be made again.
    pub(crate) fn saved(&self) -> SavedList {
        SavedList { reference: self.list.reference().to_vec(), skin: self.list.skin(), motion: self.motion }
    }

    /// Makes the list of a saved state again; rows already stand in its order.
    pub(crate) fn restore(&mut self, particles: &Particles, saved: &SavedList, parallelism: Parallelism) {
        if saved.reference.len() != particles.listed() || saved.skin < 0.0 {
            self.invalidate();
            return;
        }
        let radius = SkinList::list_radius(self.radius, saved.skin);
        self.grid.order_both(&saved.reference[..particles.awake()], &[], radius, parallelism);
        let radius = self.still_radius();
        for (still, rows) in self.still.iter_mut().zip(still_rows(particles)) {
            still.order_both(&particles.positions()[rows], &[], radius, parallelism);
        }
        self.still_sorted = true;
        let unlisted = &particles.positions()[particles.listed()..particles.dense()];
        let reference = [&saved.reference, unlisted].concat();
        let reach = (self.radius, saved.skin);
        Self::build_list(&mut self.list, &self.grid, &self.still, &reference, reach, parallelism);
        self.motion = saved.motion;
    }

    /// The radius that the sleeping rows are sorted for \[m].
    fn still_radius(&self) -> Real {
        self.radius * (1.0 + ListCost::LONGEST)
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        self.grid.memory_bytes()
            + self.still.iter().map(Grid::memory_bytes).sum::<usize>()
            + self.list.memory_bytes()
            + held(&self.reference)
            + self.scratch.memory_bytes()
    }
}

/// The sleeping rows: those near others that are awake, and the rest.
fn still_rows(particles: &Particles) -> [Range<usize>; 2] {
    [particles.awake()..particles.listed(), particles.listed()..particles.dense()]
}
