//! Broad phase: boxes in a grid, in which those that have moved look for others.
//!
//! A box is listed in each cell that it covers, and cells in buckets. Two boxes meet in the cell where both begin. Boxes
//! much larger than a cell are compared with all.

use super::bounds::{Bounds, NONE};
use crate::math::Vector64;

/// Cells on either side of the origin: bodies farther away share the last one.
const FARTHEST: i32 = 1 << 29;
/// Boxes of which the median is taken for the side of a cell.
const SAMPLES: usize = 256;
/// Columns or rows of cells that a box covers at most; larger ones are in no cell.
const MOST: i32 = 16;

/// A box in a cell.
#[derive(Clone, Copy)]
struct Entry {
    index: u32,
    /// The next entry of the bucket.
    next: u32,
    /// The cell where the box begins.
    first: [i32; 2],
}

/// Boxes by place.
#[derive(Clone, Default)]
pub(super) struct Broad {
    /// Side of a cell \[m].
    cell: f64,
    /// The cells of the lower left and upper right corner of each box.
    corners: Vec<[[i32; 2]; 2]>,
    /// The first entry of each bucket.
    heads: Vec<u32>,
    entries: Vec<Entry>,
    /// Entries that hold no box.
    free: Vec<u32>,
    large: Vec<u32>,
}

impl Broad {
    /// Lists all boxes anew, in cells twice as wide as the median of these sizes \[m].
    pub fn restart(&mut self, boxes: &[Bounds], sizes: impl Iterator<Item = f64>) {
        self.cell = 2.0 * median(sizes.step_by(boxes.len() / SAMPLES + 1).collect());
        self.heads.clear();
        self.heads.resize((2 * boxes.len()).next_power_of_two(), NONE);
        self.corners.clear();
        self.entries.clear();
        self.free.clear();
        self.large.clear();
        for (bounds, k) in boxes.iter().zip(0..) {
            let corners = self.corners_of(bounds);
            self.corners.push(corners);
            self.list(k);
        }
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// A box has moved.
    pub fn set(&mut self, k: u32, bounds: &Bounds) {
        let corners = self.corners_of(bounds);
        if corners != self.corners[k as usize] {
            self.strike_off(k);
            self.corners[k as usize] = corners;
            self.list(k);
        }
    }

    /// Visits all boxes that may overlap this one; some of them twice, as two cells of a box may be in one bucket.
    pub fn each_near(&self, k: u32, mut meet: impl FnMut(u32)) {
        let [low, high] = self.corners[k as usize];
        if is_large(&[low, high]) {
            return (0..self.corners.len() as u32).for_each(meet);
        }
        self.large.iter().for_each(|&other| meet(other));
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                let mut at = self.heads[self.bucket([x, y])];
                while let Some(entry) = self.entries.get(at as usize) {
                    if low[0].max(entry.first[0]) == x && low[1].max(entry.first[1]) == y {
                        meet(entry.index);
                    }
                    at = entry.next;
                }
            }
        }
    }

    /// Lists a box in the cells that it covers.
    fn list(&mut self, k: u32) {
        let corners = self.corners[k as usize];
        if is_large(&corners) {
            return self.large.push(k);
        }
        for cell in cells(corners) {
            let bucket = self.bucket(cell);
            let entry = Entry { index: k, next: self.heads[bucket], first: corners[0] };
            self.heads[bucket] = match self.free.pop() {
                Some(at) => {
                    self.entries[at as usize] = entry;
                    at
                }
                None => {
                    self.entries.push(entry);
                    self.entries.len() as u32 - 1
                }
            };
        }
    }

    /// Takes a box out of its cells.
    fn strike_off(&mut self, k: u32) {
        let corners = self.corners[k as usize];
        if is_large(&corners) {
            return self.large.retain(|other| *other != k);
        }
        for cell in cells(corners) {
            let bucket = self.bucket(cell);
            let (mut before, mut at) = (NONE, self.heads[bucket]);
            while self.entries[at as usize].index != k {
                (before, at) = (at, self.entries[at as usize].next);
            }
            let next = self.entries[at as usize].next;
            match self.entries.get_mut(before as usize) {
                Some(before) => before.next = next,
                None => self.heads[bucket] = next,
            }
            self.free.push(at);
        }
    }

    fn corners_of(&self, bounds: &Bounds) -> [[i32; 2]; 2] {
        let per_metre = 1.0 / self.cell;
        let corner = |at: Vector64| [column(at.x * per_metre), column(at.y * per_metre)];
        [corner(bounds.low), corner(bounds.high)]
    }

    #[inline]
    fn bucket(&self, [x, y]: [i32; 2]) -> usize {
        let mixed = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
        (mixed ^ (mixed >> 15)) as usize & (self.heads.len() - 1)
    }
}

/// Whether a box with these corners is compared with all others: one that has no size is, too.
fn is_large([low, high]: &[[i32; 2]; 2]) -> bool {
    (0..2).any(|axis| !(0..MOST).contains(&(high[axis] - low[axis])))
}

fn cells([low, high]: [[i32; 2]; 2]) -> impl Iterator<Item = [i32; 2]> {
    (low[1]..=high[1]).flat_map(move |y| (low[0]..=high[0]).map(move |x| [x, y]))
}

/// Middle of some sizes, or 1 if there are none of use.
fn median(mut sizes: Vec<f64>) -> f64 {
    sizes.retain(|size| size.is_normal() && *size > 0.0);
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 1.0 } else { *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Rounding down by a comparison: without SSE 4.1 `floor` is a call.
fn column(at: f64) -> i32 {
    // Far beyond every body, and a cell more is still a number.
    let towards_zero = (at as i32).clamp(-FARTHEST, FARTHEST);
    towards_zero - i32::from(f64::from(towards_zero) > at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    fn boxes(random: &mut Rng) -> Vec<Bounds> {
        let mut number = || random.unit();
        let mut bounds = |_| {
            let size = 10f64.powf(4.0 * number() - 3.0);
            let low = Vector64::new(20.0 * number() - 10.0, 20.0 * number() - 10.0);
            Bounds { low, high: low + Vector64::new(size * number(), size * number()) }
        };
        let mut boxes: Vec<Bounds> = (0..300).map(&mut bounds).collect();
        boxes.push(Bounds { low: Vector64::NEG_INFINITY, high: Vector64::INFINITY });
        boxes.push(Bounds { low: Vector64::ONE, high: Vector64::ONE });
        boxes
    }

    fn overlapping(boxes: &[Bounds], a: usize) -> Vec<u32> {
        (0..boxes.len()).filter(|b| boxes[a].overlaps(&boxes[*b])).map(|b| b as u32).collect()
    }

    #[test]
    fn boxes_of_all_sizes_meet_those_that_overlap_them() {
        let mut random = Rng::new(5, 0);
        let (mut broad, mut now) = (Broad::default(), boxes(&mut random));
        broad.restart(&now, now.iter().map(|bounds| (bounds.high - bounds.low).max_element()));
        for _ in 0..4 {
            for a in 0..now.len() {
                let mut met = Vec::new();
                broad.each_near(a as u32, |b| met.push(b));
                met.retain(|b| now[a].overlaps(&now[*b as usize]));
                met.sort_unstable();
                met.dedup();
                assert_eq!(met, overlapping(&now, a));
            }
            // Half of them move.
            for (k, bounds) in boxes(&mut random).into_iter().enumerate().step_by(2) {
                now[k] = bounds;
                broad.set(k as u32, &bounds);
            }
        }
    }
}
