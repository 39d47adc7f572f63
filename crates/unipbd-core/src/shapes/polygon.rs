//! Simple polygons: moments, inside test, signed distance, cleanup.

use super::{Nearest, ShapeError};
use crate::math::Vector64;

/// Area, centroid and polar second moment of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Area [m^2].
    pub area: f64,
    /// Centroid \[m].
    pub centroid: Vector64,
    /// Integral of the squared distance to the centroid [m^4]; times density it is the moment of inertia.
    pub second: f64,
}

/// Edges of a closed outline as pairs of corners.
pub(crate) fn edges(corners: &[Vector64]) -> impl Iterator<Item = (Vector64, Vector64)> + '_ {
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]))
}

/// Twice the signed area, positive when counter-clockwise.
pub(super) fn doubled_area(corners: &[Vector64]) -> f64 {
    let Some(&origin) = corners.first() else { return 0.0 };
    edges(corners).map(|(p, q)| (p - origin).perp_dot(q - origin)).sum()
}

/// Exact moments by Green's theorem: a sum over the triangles from the first corner to each edge.
pub(super) fn moments(corners: &[Vector64]) -> Moments {
    let origin = corners[0];
    let (mut doubled, mut first, mut second) = (0.0, Vector64::ZERO, 0.0);
    for (p, q) in edges(corners) {
        let (p, q) = (p - origin, q - origin);
        let cross = p.perp_dot(q);
        doubled += cross;
        first += (p + q) * cross;
        second += cross * (p.dot(p) + p.dot(q) + q.dot(q));
    }
    let area = 0.5 * doubled;
    let centroid = first / (3.0 * doubled);
    let about_centroid = second / 12.0 - area * centroid.length_squared();
    Moments { area: area.abs(), centroid: origin + centroid, second: about_centroid.abs() }
}

/// Even-odd rule: counts the edges crossed by the ray towards +x.
pub(super) fn contains(corners: &[Vector64], point: Vector64) -> bool {
    let mut inside = false;
    for (p, q) in edges(corners) {
        if (p.y > point.y) != (q.y > point.y) && point.x < p.x + (q.x - p.x) * (point.y - p.y) / (q.y - p.y) {
            inside = !inside;
        }
    }
    inside
}

/// Signed distance and its gradient; on the boundary itself the normal of the edge.
pub(crate) fn nearest(corners: &[Vector64], point: Vector64) -> Nearest {
    let outwards = if doubled_area(corners) > 0.0 { -1.0 } else { 1.0 };
    let (mut best, mut offset, mut edge) = (f64::INFINITY, Vector64::ZERO, Vector64::X);
    for (p, q) in edges(corners) {
        let along = q - p;
        let t = ((point - p).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let away = point - (p + along * t);
        if away.length_squared() < best {
            (best, offset, edge) = (away.length_squared(), away, along);
        }
    }
    let distance = best.sqrt();
    let side = if contains(corners, point) { -1.0 } else { 1.0 };
    let tiny = 1e-12 * edge.length();
    let normal = if distance > tiny { offset * (side / distance) } else { edge.perp().normalize() * outwards };
    Nearest { distance: side * distance, normal }
}

/// The first edge crossed by an entering path, and the depth of the end of the path behind its line.
pub(crate) fn first_crossing(corners: &[Vector64], from: Vector64, to: Vector64) -> Option<Nearest> {
    let outwards = if doubled_area(corners) > 0.0 { -1.0 } else { 1.0 };
    let way = to - from;
    let mut first: Option<(f64, Nearest)> = None;
    for (p, q) in edges(corners) {
        let normal = (q - p).perp().normalize_or_zero() * outwards;
        let (height, towards) = ((from - p).dot(normal), way.dot(normal));
        // A path that starts on an edge, within rounding, starts outside.
        if towards >= 0.0 || height < -1e-6 * (q - p).length() || height + towards >= 0.0 {
            continue;
        }
        let t = height.max(0.0) / -towards;
        let along = (from + way * t - p).dot(q - p) / (q - p).length_squared();
        if (0.0..=1.0).contains(&along) && first.is_none_or(|(least, _)| t < least) {
            first = Some((t, Nearest { distance: height + towards, normal }));
        }
    }
    first.map(|(_, way)| way)
}

/// Counter-clockwise, without repeated corners and corners on a straight line.
pub(super) fn tidied(corners: &[Vector64]) -> Vec<Vector64> {
    let mut corners = corners.to_vec();
    if doubled_area(&corners) < 0.0 {
        corners.reverse();
    }
    let size = corners.iter().map(|c| (*c - corners[0]).length()).fold(0.0, f64::max);
    let straight = |before: Vector64, here: Vector64, after: Vector64| {
        let (incoming, outgoing) = (here - before, after - here);
        let tolerance = 1e-10 * size;
        incoming.length() <= tolerance
            || (incoming.perp_dot(outgoing).abs() <= tolerance * outgoing.length() && incoming.dot(outgoing) > 0.0)
    };
    let mut k = 0;
    while k < corners.len() && corners.len() > 3 {
        let n = corners.len();
        if straight(corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]) {
            corners.remove(k);
            k = k.saturating_sub(1);
        } else {
            k += 1;
        }
    }
    corners
}

/// Returns an error if the polygon is not simple or has no area.
pub(super) fn check(corners: &[Vector64]) -> Result<(), ShapeError> {
    if corners.len() < 3 {
        return Err(ShapeError::TooFewCorners);
    }
    if corners.iter().any(|c| !c.is_finite()) {
        return Err(ShapeError::NotFinite);
    }
    let size = corners.iter().map(|c| (*c - corners[0]).length()).fold(0.0, f64::max);
    if doubled_area(corners).abs() <= 1e-12 * size * size {
        return Err(ShapeError::NoArea);
    }
    if is_simple(&tidied(corners)) { Ok(()) } else { Err(ShapeError::SelfIntersecting) }
}

/// Whether no two edges meet, except adjacent edges at their common corner.
pub(super) fn is_simple(corners: &[Vector64]) -> bool {
    let n = corners.len();
    let edge = |k: usize| (corners[k], corners[(k + 1) % n]);
    (0..n).all(|i| (i + 2..n).filter(|j| (j + 1) % n != i).all(|j| !segments_meet(edge(i), edge(j))))
}

fn segments_meet(a: (Vector64, Vector64), b: (Vector64, Vector64)) -> bool {
    let side = |s: (Vector64, Vector64), p: Vector64| (s.1 - s.0).perp_dot(p - s.0);
    let apart = |s: (Vector64, Vector64), o: (Vector64, Vector64)| side(s, o.0) * side(s, o.1) > 0.0;
    let boxes = a.0.min(a.1).cmple(b.0.max(b.1)).all() && b.0.min(b.1).cmple(a.0.max(a.1)).all();
    boxes && !apart(a, b) && !apart(b, a)
}
