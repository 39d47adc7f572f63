//! A neighbour list that stays valid while its particles have moved little.
//!
//! A list of all pairs within h + skin at the reference positions holds every pair within h as long
//! as no two particles have come nearer by more than the skin. With d the displacement of a particle
//! from its reference and c any common drift, |d_i - d_j| <= 2 max |d - c|, so the list holds while
//! 2 max |d - c| <= skin: a body of fluid that only travels needs no new list.

use super::list::NeighborList;
use super::{Cursor, Grid};
use crate::bytes::held;
use crate::math::{Real, Vector, larger};
use crate::parallel::{Aabb, GROUP, Parallelism};
use crate::periodic::Periodic;
use std::ops::Range;

/// How particles have moved since a list was built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Common drift of all rows \[m].
    pub drift: Vector,
    /// No displacement is farther from the drift \[m]; infinite where one is not a number.
    pub deviation: Real,
}

impl Motion {
    /// The motion from `from` to `to`, in a domain that repeats as `grid` does.
    pub fn between(from: &[Vector], to: &[Vector], grid: &Grid, parallelism: Parallelism) -> Motion {
        let moves = Moves { from, to, periodic: grid.periodic(), parallelism };
        moves.within(moves.bound())
    }

    /// This motion beside rows that do not move at all.
    #[must_use]
    pub(super) fn beside_still_ones(self) -> Motion {
        Motion { drift: Vector::ZERO, deviation: self.deviation + self.drift.length() }
    }

    /// The skin a list needs to survive this motion \[m].
    pub fn needed_skin(&self) -> Real {
        // Displacements, and distances within the list, are rounded.
        let rounding = 8.0 * Real::EPSILON * (self.drift.abs().max_element() + self.deviation);
        2.0 * (self.deviation + rounding)
    }
}

/// Rows at two moments.
#[derive(Clone, Copy)]
struct Moves<'a> {
    from: &'a [Vector],
    to: &'a [Vector],
    periodic: Periodic,
    parallelism: Parallelism,
}

impl Moves<'_> {
    /// The middle of the displacements' bounding box, and half of its diagonal: no other drift makes the
    /// deviation much smaller, and the true one is at most sqrt(2) times smaller than this.
    fn bound(self) -> Motion {
        assert_eq!(self.from.len(), self.to.len(), "columns of one particle set have one length");
        if self.from.is_empty() {
            return Motion::default();
        }
        let all = self.parallelism.reduce(
            self.from.len(),
            |rows| {
                let mut spread = Aabb::NONE;
                self.each_four(rows, |moved| spread.add(moved));
                spread
            },
            Aabb::join,
        );
        let (low, high) = all.corners();
        let (drift, half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
        Motion { drift, deviation: if all.is_finite() { half.length() } else { Real::INFINITY } }
    }

    /// A bound, made exact by a second look at each row.
    fn within(self, bound: Motion) -> Motion {
        if bound.deviation == Real::INFINITY || self.from.is_empty() {
            return bound;
        }
        let square = self.parallelism.reduce(
            self.from.len(),
            |rows| {
                let mut largest = [0.0; GROUP];
                self.each_four(rows, |moved| {
                    for (largest, moved) in largest.iter_mut().zip(moved) {
                        *largest = larger((*moved - bound.drift).length_squared(), *largest);
                    }
                });
                largest.into_iter().fold(0.0, Real::max)
            },
            Real::max,
        );
        Motion { deviation: square.sqrt(), ..bound }
    }

    /// Hands out the displacements of some rows, four at a time; the last ones are repeated to fill up.
    #[inline(always)]
    fn each_four(self, rows: Range<usize>, mut visit: impl FnMut(&[Vector; GROUP])) {
        let (from, to) = (&self.from[rows.clone()], &self.to[rows]);
        let moved = |from: Vector, to: Vector| match self.periodic.any() {
            true => self.periodic.min_image(to - from),
            false => to - from,
        };
        let (from_groups, from_rest) = from.as_chunks::<GROUP>();
        let (to_groups, to_rest) = to.as_chunks::<GROUP>();
        for (from, to) in from_groups.iter().zip(to_groups) {
            visit(&std::array::from_fn(|k| moved(from[k], to[k])));
        }
        if let Some(last) = from_rest.len().checked_sub(1) {
            visit(&std::array::from_fn(|k| moved(from_rest[k.min(last)], to_rest[k.min(last)])));
        }
    }
}

/// A neighbour list with its reference positions.
#[derive(Default)]
pub struct SkinList {
    list: NeighborList,
    reference: Vec<Vector>,
    radius: Real,
    skin: Real,
    builds: u64,
}

impl SkinList {
    /// The widest skin a list is built with, as a multiple of its radius: particles that need more in
    /// one substep have come loose, and listing all pairs of them would take the memory with it.
    pub const WIDEST_SKIN: Real = 2.0;

    fn capped(radius: Real, skin: Real) -> Real {
        if skin <= Self::WIDEST_SKIN * radius { skin } else { Self::WIDEST_SKIN * radius }
    }

    /// The radius to order a grid by for [`build`](Self::build) \[m].
    pub fn list_radius(radius: Real, skin: Real) -> Real {
        (radius + Self::capped(radius, skin)) * (1.0 + 8.0 * Real::EPSILON)
    }

    /// Lists all pairs that are within `radius` now and as long as [`covers`](Self::covers) holds. A
    /// `skin` wider than [`WIDEST_SKIN`](Self::WIDEST_SKIN) is cut to that.
    /// `grid` must have been ordered by `reference` for [`list_radius`](Self::list_radius), and
    /// `reference` permuted by that order.
    pub fn build(&mut self, grid: &Grid, reference: &[Vector], radius: Real, skin: Real, parallelism: Parallelism) {
        self.list.build(grid, reference, Self::list_radius(radius, skin), parallelism);
        self.note_build(reference, radius, skin);
    }

    /// As [`build`](Self::build), with rows that do not move behind those of `grid`, in two more: those
    /// of the first have a list too.
    pub(super) fn build_beside(
        &mut self,
        grid: &Grid,
        still: &[Grid; 2],
        reference: &[Vector],
        radius: Real,
        skin: Real,
        parallelism: Parallelism,
    ) {
        self.list.build_beside(grid, still, reference, Self::list_radius(radius, skin), parallelism);
        self.note_build(reference, radius, skin);
    }

    fn note_build(&mut self, reference: &[Vector], radius: Real, skin: Real) {
        self.reference.clear();
        self.reference.extend_from_slice(&reference[..self.list.rows()]);
        (self.radius, self.skin) = (radius, Self::capped(radius, skin));
        self.builds += 1;
    }

    /// How the particles have moved since the list was built, as precisely as it takes to tell whether
    /// the list [`covers`](Self::covers) it. `positions` may have more rows than the list.
    pub fn motion(&self, grid: &Grid, positions: &[Vector], parallelism: Parallelism) -> Motion {
        let to = &positions[..self.reference.len()];
        let moves = Moves { from: &self.reference, to, periodic: grid.periodic(), parallelism };
        let bound = moves.bound();
        if self.covers(&bound) { bound } else { moves.within(bound) }
    }

    /// Whether the list holds every pair within the radius after this motion. Where pairs are
    /// evaluated at two sets of positions, it must cover the motion to each.
    pub fn covers(&self, motion: &Motion) -> bool {
        self.builds > 0 && motion.needed_skin() <= self.skin
    }

    /// Whether a new list is due for `rows` rows at `positions`.
    pub fn needs_rebuild(&self, grid: &Grid, positions: &[Vector], rows: usize, parallelism: Parallelism) -> bool {
        self.reference.len() != rows || !self.covers(&self.motion(grid, positions, parallelism))
    }

    /// Visits every row that is within `radius` of `point` after `motion`, and some more: the caller
    /// tests the distance. For points that are not in the list, such as smoke.
    #[inline]
    pub fn for_each_near(
        &self,
        grid: &Grid,
        motion: &Motion,
        point: Vector,
        radius: Real,
        mut visit: impl FnMut(usize),
    ) {
        self.for_each_run_near(grid, motion, point, radius, |run| run.for_each(&mut visit));
    }

    /// As [`for_each_near`](Self::for_each_near), in runs of consecutive rows.
    #[inline]
    pub fn for_each_run_near(
        &self,
        grid: &Grid,
        motion: &Motion,
        point: Vector,
        radius: Real,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let reach = radius + 0.5 * motion.needed_skin();
        grid.for_each_run(point - motion.drift, reach, &mut Cursor::default(), |run| {
            visit(run.start as usize..run.end as usize);
        });
    }

    /// The list. Pairs up to radius + skin are in it.
    #[inline]
    pub fn list(&self) -> &NeighborList {
        &self.list
    }

    /// The radius within which it is complete \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// The positions the list was built at.
    pub fn reference(&self) -> &[Vector] {
        &self.reference
    }

    /// The skin of the list \[m].
    pub fn skin(&self) -> Real {
        self.skin
    }

    /// Lists built so far.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// Forces a new list at the next [`needs_rebuild`](Self::needs_rebuild): rows were added, removed or permuted.
    pub fn invalidate(&mut self) {
        self.skin = -1.0;
    }

    /// Gives its memory back: the next list is made anew.
    pub(super) fn clear(&mut self) {
        *self = SkinList { builds: self.builds, skin: -1.0, ..SkinList::default() };
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        self.list.memory_bytes() + held(&self.reference)
    }
}
