//! The surface of solids that lie flush against each other: the parts of their outlines that no other covers.

use super::bounds::{Bounds, HIDDEN};
use crate::math::Vector64;

/// Distance from an edge at which another solid counts as lying on it, relative to the size of the solid.
const TOUCHING: f64 = 1e-3;

/// A convex piece of a solid that never moves.
pub(super) struct Solid<'a> {
    pub vertices: &'a [Vector64],
    pub normals: &'a [Vector64],
    pub bounds: Bounds,
    /// Size of the solid \[m].
    pub size: f64,
    /// Body and wall; pieces of one solid do not cover each other's outline.
    pub owner: (u32, u32),
}

/// The covered parts of the edges of each solid: edge, and the distances from its start \[m].
pub(super) fn covered(solids: &[Solid], planes: &[(Vector64, Vector64)]) -> Vec<Vec<(usize, [f64; 2])>> {
    let mut order: Vec<usize> = (0..solids.len()).collect();
    order.sort_by(|&i, &j| solids[i].bounds.low.x.total_cmp(&solids[j].bounds.low.x));
    let mut found: Vec<Vec<(usize, [f64; 2])>> = solids.iter().map(|solid| by_planes(solid, planes)).collect();
    for (place, &i) in order.iter().enumerate() {
        let reach = solids[i].bounds.grown(TOUCHING * solids[i].size);
        for &j in &order[place + 1..] {
            if solids[j].bounds.low.x > reach.high.x + TOUCHING * solids[j].size {
                break;
            }
            if solids[i].owner != solids[j].owner && reach.overlaps(&solids[j].bounds.grown(TOUCHING * solids[j].size))
            {
                by_solid(&solids[i], &solids[j], &mut found[i]);
                by_solid(&solids[j], &solids[i], &mut found[j]);
            }
        }
    }
    found
}

fn by_planes(solid: &Solid, planes: &[(Vector64, Vector64)]) -> Vec<(usize, [f64; 2])> {
    let mut found = Vec::new();
    for &(point, normal) in planes {
        let sides = [(point, normal)];
        (0..solid.vertices.len()).for_each(|edge| found.extend(inside(solid, edge, sides.into_iter())));
    }
    found
}

fn by_solid(solid: &Solid, other: &Solid, found: &mut Vec<(usize, [f64; 2])>) {
    for edge in 0..solid.vertices.len() {
        let sides = other.vertices.iter().copied().zip(other.normals.iter().copied());
        found.extend(inside(solid, edge, sides));
    }
}

/// The part of an edge whose outer side lies within these sides: the segment just outside the edge, clipped.
fn inside(solid: &Solid, edge: usize, sides: impl Iterator<Item = (Vector64, Vector64)>) -> Option<(usize, [f64; 2])> {
    let from = solid.vertices[edge];
    let way = solid.vertices[(edge + 1) % solid.vertices.len()] - from;
    let (length, room) = (way.length(), TOUCHING * solid.size);
    let (outside, along) = (from + solid.normals[edge] * (2.0 * room), way / length);
    let mut part = [0.0, length];
    for (point, normal) in sides {
        let (height, slope) = ((outside - point).dot(normal) - room, along.dot(normal));
        if slope.abs() < 1e-9 {
            if height > 0.0 {
                return None;
            }
        } else if slope > 0.0 {
            part[1] = part[1].min(-height / slope);
        } else {
            part[0] = part[0].max(-height / slope);
        }
    }
    (part[1] - part[0] > room).then_some((edge, part))
}

/// Takes the covered parts off the exposed ones, and the corners that end in a covered part; returns whether any
/// part was taken.
pub(super) fn cut(covered: &[(usize, [f64; 2])], exposed: &mut [[f64; 2]], corners: &mut [bool]) -> bool {
    let (mut parts, mut any, n) = (covered.to_vec(), false, exposed.len());
    parts.sort_by(|p, q| p.0.cmp(&q.0).then(p.1[0].total_cmp(&q.1[0])));
    let whole: Vec<f64> = exposed.iter().map(|part| part[1]).collect();
    // From both ends: an edge that is covered in its middle alone stays exposed there.
    for &(edge, [from, to]) in &parts {
        if from <= exposed[edge][0] + 1e-9 * whole[edge].abs() {
            exposed[edge][0] = exposed[edge][0].max(to);
            any = true;
        }
    }
    for &(edge, [from, to]) in parts.iter().rev() {
        if to >= exposed[edge][1] - 1e-9 * whole[edge].abs() {
            exposed[edge][1] = exposed[edge][1].min(from);
            any = true;
        }
    }
    for edge in 0..n {
        let (was, [from, to]) = (whole[edge], exposed[edge]);
        let gone = was.is_finite() && to - from < 1e-3 * was;
        if gone {
            exposed[edge] = HIDDEN;
        }
        if was.is_finite() && (gone || from > 0.0) {
            corners[edge] = false;
        }
        if was.is_finite() && (gone || to < was) {
            corners[(edge + 1) % n] = false;
        }
    }
    any
}
