//! Broad phase: pairs of pieces that can touch. Boxes whose pairs are sought are listed in square cells, and cells in
//! buckets, where all others look for them; boxes much larger than a cell are compared with all.

use super::bounds::Bounds;
use super::pieces::Pieces;
use crate::math::Vector64;

/// Cells on either side of the origin: bodies farther away share the last one.
const FARTHEST: i32 = 1 << 30;

/// A box, and the cell of its lower left corner.
type Entry = (u32, [i32; 2]);

/// Boxes by place.
#[derive(Clone, Default)]
pub(super) struct Broad {
    /// Side of a cell \[m].
    cell: f64,
    /// The listed boxes, and their corners in cells.
    corners: Vec<(u32, [[i32; 2]; 2])>,
    /// Boxes of bucket k: `listed[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    listed: Vec<Entry>,
    large: Vec<u32>,
    extents: Vec<f64>,
}

impl Broad {
    /// Pairs with overlapping boxes, accepted by `allowed`, of pieces (the smaller index first) and of pieces with
    /// half-planes; sorted. At least one of a pair is in `sought`, which is marked in `is_sought`. Half-plane k has the
    /// index `pieces + k`.
    pub fn pairs(
        &mut self,
        pieces: &Pieces,
        fat: &[Bounds],
        (sought, is_sought): (&[u32], &[bool]),
        allowed: impl Fn(u32, u32) -> bool,
        found: &mut Vec<(u32, u32)>,
    ) {
        found.clear();
        self.list(fat, sought);
        for b in 0..fat.len() as u32 {
            let of_b = &fat[b as usize];
            let mut meet = |a: u32| {
                // A pair of two sought pieces is found from both.
                let once = b != a && (a < b || !is_sought[b as usize]);
                if once && of_b.overlaps(&fat[a as usize]) && allowed(a, b) {
                    found.push((a.min(b), a.max(b)));
                }
            };
            if self.is_large(of_b) {
                sought.iter().for_each(|&a| meet(a));
                continue;
            }
            self.large.iter().for_each(|&a| meet(a));
            self.each_near(of_b, meet);
        }
        for (plane, index) in pieces.half_planes.iter().zip(fat.len() as u32..) {
            for &a in sought {
                if depth_towards(&fat[a as usize], plane.point, plane.normal) < 0.0 && allowed(a, index) {
                    found.push((a, index));
                }
            }
        }
        found.sort_unstable();
        // Two cells of a box may be in one bucket.
        found.dedup();
    }

    /// Lists the sought boxes but the large ones in the buckets of the cells they cover.
    fn list(&mut self, fat: &[Bounds], sought: &[u32]) {
        self.cell = 2.0 * self.median_extent(fat, sought);
        self.large.clear();
        self.corners.clear();
        for &k in sought {
            let bounds = &fat[k as usize];
            if self.is_large(bounds) {
                self.large.push(k);
            } else {
                self.corners.push((k, self.corners_of(bounds)));
            }
        }
        let buckets = (2 * sought.len()).next_power_of_two().max(2);
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        self.each_cell(|starts, _, bucket, _| starts[bucket + 1] += 1);
        for k in 0..buckets {
            self.starts[k + 1] += self.starts[k];
        }
        self.listed.clear();
        self.listed.resize(self.starts[buckets] as usize, (0, [0; 2]));
        self.each_cell(|starts, listed, bucket, entry| {
            listed[starts[bucket] as usize] = entry;
            starts[bucket] += 1;
        });
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    fn each_cell(&mut self, mut rule: impl FnMut(&mut [u32], &mut [Entry], usize, Entry)) {
        let buckets = self.starts.len() - 1;
        for &(k, [[x0, y0], [x1, y1]]) in &self.corners {
            for y in y0..=y1 {
                for x in x0..=x1 {
                    rule(&mut self.starts, &mut self.listed, bucket([x, y], buckets), (k, [x0, y0]));
                }
            }
        }
    }

    /// Whether a box is compared with all others.
    fn is_large(&self, bounds: &Bounds) -> bool {
        let extent = (bounds.high - bounds.low).max_element();
        extent > 4.0 * self.cell || extent.is_nan() || self.cell.is_nan()
    }

    /// Visits the listed boxes that share with this one the cell where both begin.
    fn each_near(&self, bounds: &Bounds, mut meet: impl FnMut(u32)) {
        let [low, high] = self.corners_of(bounds);
        let buckets = self.starts.len() - 1;
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                let here = bucket([x, y], buckets);
                for &(k, first) in &self.listed[self.starts[here] as usize..self.starts[here + 1] as usize] {
                    if low[0].max(first[0]) == x && low[1].max(first[1]) == y {
                        meet(k);
                    }
                }
            }
        }
    }

    fn corners_of(&self, bounds: &Bounds) -> [[i32; 2]; 2] {
        let per_metre = 1.0 / self.cell;
        let corner = |at: Vector64| [column(at.x * per_metre), column(at.y * per_metre)];
        [corner(bounds.low), corner(bounds.high)]
    }

    fn median_extent(&mut self, fat: &[Bounds], sought: &[u32]) -> f64 {
        self.extents.clear();
        let extent = |&k: &u32| (fat[k as usize].high - fat[k as usize].low).max_element();
        self.extents.extend(sought.iter().map(extent));
        if self.extents.is_empty() {
            return 1.0;
        }
        let middle = self.extents.len() / 2;
        *self.extents.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// Rounding down by a comparison: without SSE 4.1 `floor` is a call.
fn column(at: f64) -> i32 {
    // Far beyond every body, and a cell more is still a number.
    let towards_zero = (at as i32).clamp(-FARTHEST, FARTHEST);
    towards_zero - i32::from(f64::from(towards_zero) > at)
}

fn bucket([x, y]: [i32; 2], buckets: usize) -> usize {
    let mixed = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    (mixed ^ (mixed >> 15)) as usize & (buckets - 1)
}

/// Smallest signed distance of a box from a half-plane.
fn depth_towards(bounds: &Bounds, point: Vector64, normal: Vector64) -> f64 {
    let (center, half) = ((bounds.low + bounds.high) * 0.5, (bounds.high - bounds.low) * 0.5);
    (center - point).dot(normal) - half.dot(normal.abs())
}
