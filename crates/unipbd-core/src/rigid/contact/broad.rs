//! Broad phase: pairs of pieces that can touch. Boxes are sorted into square cells; boxes much larger than
//! a cell are compared with all others.

use super::bounds::Bounds;
use super::pieces::Pieces;
use crate::math::Vector64;

/// Pairs of pieces (the smaller index first) and of pieces with half-planes, with overlapping boxes
/// and accepted by `allowed`; sorted. Half-plane k has the index `pieces + k`.
pub(super) fn pairs(pieces: &Pieces, fat: &[Bounds], allowed: impl Fn(u32, u32) -> bool) -> Vec<(u32, u32)> {
    let mut found = Vec::with_capacity(3 * fat.len());
    let cell = 2.0 * median_extent(fat);
    let extent = |k: usize| (fat[k].high - fat[k].low).max_element();
    let (small, large): (Vec<u32>, Vec<u32>) = (0..fat.len() as u32).partition(|&k| extent(k as usize) <= 4.0 * cell);
    pairs_in_cells(fat, &small, cell, |a, b| {
        if allowed(a, b) {
            found.push((a.min(b), a.max(b)));
        }
    });
    for (k, &a) in large.iter().enumerate() {
        for &b in small.iter().chain(&large[k + 1..]) {
            if fat[a as usize].overlaps(&fat[b as usize]) && allowed(a, b) {
                found.push((a.min(b), a.max(b)));
            }
        }
    }
    for (plane, index) in pieces.half_planes.iter().zip(fat.len() as u32..) {
        for a in 0..fat.len() as u32 {
            if depth_towards(&fat[a as usize], plane.point, plane.normal) < 0.0 && allowed(a, index) {
                found.push((a, index));
            }
        }
    }
    found.sort_unstable();
    found
}

/// Smallest signed distance of a box from a half-plane.
fn depth_towards(bounds: &Bounds, point: Vector64, normal: Vector64) -> f64 {
    let (center, half) = ((bounds.low + bounds.high) * 0.5, (bounds.high - bounds.low) * 0.5);
    (center - point).dot(normal) - half.dot(normal.abs())
}

/// Cells on either side of the origin: bodies farther away share the last one.
const FARTHEST: i32 = 1 << 30;

fn median_extent(fat: &[Bounds]) -> f64 {
    let mut extents: Vec<f64> = fat.iter().map(|b| (b.high - b.low).max_element()).collect();
    if extents.is_empty() {
        return 1.0;
    }
    let middle = extents.len() / 2;
    *extents.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Every box is listed in each cell it covers; a pair is reported only in the cell where both begin.
fn pairs_in_cells(fat: &[Bounds], small: &[u32], cell: f64, mut found: impl FnMut(u32, u32)) {
    // Rounding down by a comparison: without SSE 4.1 `floor` is a call.
    let column = |x: f64| {
        // Far beyond every body, and a cell more is still a number.
        let towards_zero = ((x / cell) as i32).clamp(-FARTHEST, FARTHEST);
        towards_zero - i32::from(f64::from(towards_zero) > x / cell)
    };
    let corner = |k: u32| (column(fat[k as usize].low.x), column(fat[k as usize].low.y));
    let mut listed: Vec<(u64, u32)> = Vec::with_capacity(3 * small.len());
    for &k in small {
        let (x0, y0) = corner(k);
        for y in y0..=column(fat[k as usize].high.y) {
            for x in x0..=column(fat[k as usize].high.x) {
                listed.push((key(x, y), k));
            }
        }
    }
    listed.sort_unstable();
    for group in listed.chunk_by(|p, q| p.0 == q.0) {
        for (i, &(here, a)) in group.iter().enumerate() {
            for &(_, b) in &group[i + 1..] {
                let ((ax, ay), (bx, by)) = (corner(a), corner(b));
                if key(ax.max(bx), ay.max(by)) == here && fat[a as usize].overlaps(&fat[b as usize]) {
                    found(a, b);
                }
            }
        }
    }
}

fn key(x: i32, y: i32) -> u64 {
    (u64::from(y as u32) << 32) | u64::from(x as u32)
}
