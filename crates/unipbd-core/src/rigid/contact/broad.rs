//! Broad phase: pairs of pieces that can touch. Boxes are listed in square cells, and cells in buckets; boxes much
//! larger than a cell are compared with all others.

use super::bounds::Bounds;
use super::pieces::Pieces;
use crate::math::Vector64;

/// Cells on either side of the origin: bodies farther away share the last one.
const FARTHEST: i32 = 1 << 30;

/// The boxes of all pieces by place.
#[derive(Clone, Default)]
pub(super) struct Broad {
    /// The corners of each box, in cells.
    corners: Vec<[[i32; 2]; 2]>,
    /// Boxes of bucket k: `listed[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    listed: Vec<u32>,
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
        self.list(fat);
        for &a in sought {
            let of_a = &fat[a as usize];
            let mut meet = |b: u32| {
                // A pair of two sought pieces is found from both.
                let once = b != a && (a < b || !is_sought[b as usize]);
                if once && of_a.overlaps(&fat[b as usize]) && allowed(a, b) {
                    found.push((a.min(b), a.max(b)));
                }
            };
            if self.large.binary_search(&a).is_ok() {
                (0..fat.len() as u32).for_each(meet);
                continue;
            }
            self.large.iter().for_each(|&b| meet(b));
            self.each_near(a, meet);
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

    /// Lists all boxes but the large ones in the buckets of the cells they cover.
    fn list(&mut self, fat: &[Bounds]) {
        let cell = 2.0 * self.median_extent(fat);
        let per_metre = 1.0 / cell;
        self.corners.clear();
        let corner = |at: Vector64| [column(at.x * per_metre), column(at.y * per_metre)];
        self.corners.extend(fat.iter().map(|bounds| [corner(bounds.low), corner(bounds.high)]));
        self.large.clear();
        let is_large = |bounds: &Bounds| {
            let extent = (bounds.high - bounds.low).max_element();
            extent > 4.0 * cell || extent.is_nan() || cell.is_nan()
        };
        self.large.extend((0..fat.len() as u32).filter(|&k| is_large(&fat[k as usize])));
        let buckets = (2 * fat.len()).next_power_of_two().max(2);
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        self.each_cell_of_small(fat.len(), |starts, _, bucket, _| starts[bucket + 1] += 1);
        for k in 0..buckets {
            self.starts[k + 1] += self.starts[k];
        }
        self.listed.clear();
        self.listed.resize(self.starts[buckets] as usize, 0);
        self.each_cell_of_small(fat.len(), |starts, listed, bucket, k| {
            listed[starts[bucket] as usize] = k;
            starts[bucket] += 1;
        });
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    fn each_cell_of_small(&mut self, boxes: usize, mut rule: impl FnMut(&mut [u32], &mut [u32], usize, u32)) {
        let mut large = self.large.iter().copied().peekable();
        let buckets = self.starts.len() - 1;
        for k in 0..boxes as u32 {
            if large.next_if_eq(&k).is_some() {
                continue;
            }
            let [[x0, y0], [x1, y1]] = self.corners[k as usize];
            for y in y0..=y1 {
                for x in x0..=x1 {
                    rule(&mut self.starts, &mut self.listed, bucket([x, y], buckets), k);
                }
            }
        }
    }

    /// Visits the small boxes that share with this one the cell where both begin.
    fn each_near(&self, a: u32, mut meet: impl FnMut(u32)) {
        let [low, high] = self.corners[a as usize];
        let buckets = self.starts.len() - 1;
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                let here = bucket([x, y], buckets);
                for &b in &self.listed[self.starts[here] as usize..self.starts[here + 1] as usize] {
                    let of_b = self.corners[b as usize][0];
                    if low[0].max(of_b[0]) == x && low[1].max(of_b[1]) == y {
                        meet(b);
                    }
                }
            }
        }
    }

    fn median_extent(&mut self, fat: &[Bounds]) -> f64 {
        self.extents.clear();
        self.extents.extend(fat.iter().map(|b| (b.high - b.low).max_element()));
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
