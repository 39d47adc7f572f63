//! Narrow phase: the contact points of two convex pieces that touch or are close.
//!
//! Two polygons touch over the face of largest separation; the opposite edge of the other polygon is clipped to its
//! ends. Edges that are no surface (cuts through a concave solid, faces that a flush neighbour covers) give no
//! contact: beyond them the neighbouring piece does.

use super::bounds::HIDDEN;
use super::pieces::{HalfPlane, PieceView, Pieces};
use super::touch::{Reference, Touch, feature};
use crate::math::Vector64;

/// Distance, relative to an edge, below which two separations count as equal.
const EQUAL: f64 = 1e-4;

/// Depth of another face, relative to an edge, at which it is not tried in place of a covered one.
const DEEP: f64 = 0.25;

/// Contacts of a piece with a half-plane.
pub(super) fn against_half_plane(a: &PieceView, plane: &HalfPlane, margin: f64, out: &mut Vec<Touch>) {
    for (k, &p) in a.vertices.iter().enumerate().filter(|&(k, _)| a.corners[k]) {
        let height = (p - plane.point).dot(plane.normal);
        if height - a.radius < margin {
            let (reference, normal) = (Reference::Second, plane.normal);
            let (on_b, radii) = (p - normal * height, [a.radius, 0.0]);
            out.push(Touch { reference, normal, on_a: p, on_b, radii, feature: feature(k, 0) });
        }
    }
}

/// Contacts of two pieces with gaps below `margin`; returns the gap below which all were found.
pub(super) fn between(a: &PieceView, b: &PieceView, margin: f64, out: &mut Vec<Touch>) -> f64 {
    match (a.is_round(), b.is_round()) {
        (true, true) => out.extend(discs((a.vertices[0], a.radius), (b.vertices[0], b.radius), margin)),
        (true, false) => out.extend(disc_on_polygon(a, b, margin)),
        (false, true) => out.extend(disc_on_polygon(b, a, margin).map(Touch::reversed)),
        (false, false) => return polygons(a, b, margin, out),
    }
    margin
}

/// The same of two discs, the pieces with these indices.
pub(super) fn of_discs(pieces: &Pieces, (a, b): (u32, u32), margin: f64, out: &mut Vec<Touch>) -> f64 {
    let ((p, radius_a), (q, radius_b)) = (pieces.disc(a), pieces.disc(b));
    let gap = (p - q).length() - radius_a - radius_b;
    if gap < margin {
        out.extend(at_points((p, q), [radius_a, radius_b], 0));
    }
    if gap < margin { f64::INFINITY } else { gap }
}

/// Contact of two discs, if their gap is below `margin`.
fn discs((p, radius_a): (Vector64, f64), (q, radius_b): (Vector64, f64), margin: f64) -> Option<Touch> {
    at_points((p, q), [radius_a, radius_b], 0).filter(|touch| touch.gap() < margin)
}

/// Contact along the line between two points.
fn at_points((p, q): (Vector64, Vector64), radii: [f64; 2], feature: u32) -> Option<Touch> {
    let normal = (p - q).try_normalize().unwrap_or(Vector64::Y);
    Some(Touch { reference: Reference::Points, normal, on_a: p, on_b: q, radii, feature })
}

/// Contact of a disc with a polygon.
fn disc_on_polygon(a: &PieceView, b: &PieceView, margin: f64) -> Option<Touch> {
    let p = a.vertices[0];
    let (mut best, mut beyond): (Option<(usize, f64)>, f64) = (None, f64::NEG_INFINITY);
    for (k, (&v, &n)) in b.vertices.iter().zip(b.normals).enumerate() {
        let height = (p - v).dot(n);
        if b.exposed[k] == HIDDEN {
            beyond = beyond.max(height);
        } else if best.is_none_or(|(_, highest)| height > highest) {
            best = Some((k, height));
        }
    }
    // A point inside the solid beyond an edge that is no surface belongs to the neighbouring piece.
    let (face, height) = best.filter(|&(_, height)| height - a.radius < margin && (height >= 0.0 || beyond <= 0.0))?;
    let (from, normal) = (b.vertices[face], b.normals[face]);
    let (along, [first, last]) = ((p - from).dot(normal.perp()), b.exposed[face]);
    if along >= first && along <= last {
        let (on_b, radii, feature) = (p - normal * height, [a.radius, 0.0], feature(0, face));
        return Some(Touch { reference: Reference::Second, normal, on_a: p, on_b, radii, feature });
    }
    let corner = if along < first { face } else { (face + 1) % b.vertices.len() };
    let touch = at_points((p, b.vertices[corner]), [a.radius, 0.0], feature(1, corner));
    touch.filter(|touch| b.corners[corner] && touch.gap() < margin)
}

/// A face that may separate two polygons.
#[derive(Clone, Copy)]
struct Axis {
    of_first: bool,
    edge: usize,
    /// Separation of the other polygon from the face \[m].
    apart: f64,
}

/// The contact where an edge ends before a face begins.
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    /// The corners touch along their line.
    Corners,
    /// The polygons overlap: the corner touches the face.
    Overlap,
    /// None.
    None,
}

/// Contacts of two polygons; returns the gap below which all were found.
fn polygons(a: &PieceView, b: &PieceView, margin: f64, out: &mut Vec<Touch>) -> f64 {
    let (of_b, of_a) = match (widest(a, b, margin, None), widest(b, a, margin, None)) {
        (Ok(of_b), Ok(of_a)) => (of_b, of_a),
        (Err(apart), Ok(_)) | (Ok(_), Err(apart)) => return apart,
        (Err(apart), Err(other)) => return apart.max(other),
    };
    over_faces((a, b), (of_a, of_b), margin, out);
    margin
}

/// Contacts of two polygons over their widest faces.
fn over_faces((a, b): (&PieceView, &PieceView), (of_a, of_b): (Axis, Axis), margin: f64, out: &mut Vec<Touch>) {
    let edge = |piece: &PieceView| (piece.vertices[1] - piece.vertices[0]).length();
    let short = edge(a).min(edge(b));
    let prefers_a = of_a.apart > of_b.apart + EQUAL * short;
    let axis = if prefers_a { Axis { of_first: true, ..of_a } } else { of_b };
    let ends = if axis.apart > EQUAL * short { Ends::Corners } else { Ends::Overlap };
    if axis.apart == f64::NEG_INFINITY || over_face(a, b, axis, ends, margin, out) || !(a.joined || b.joined) {
        return;
    }
    // The face of largest separation is covered where the other polygon is: the next ones follow, unless the polygons
    // are apart, or the next face is so deep inside that the other polygon cannot have come in through it.
    let deepest = axis.apart - DEEP * short;
    if ends == Ends::Corners {
        return;
    }
    let mut last = axis;
    for _ in 0..a.vertices.len() + b.vertices.len() {
        let (Ok(of_b), Ok(of_a)) = (widest(a, b, margin, Some(last)), widest(b, a, margin, Some(last))) else {
            return;
        };
        last = if of_a.apart > of_b.apart { Axis { of_first: true, ..of_a } } else { of_b };
        if last.apart < deepest || over_face(a, b, last, Ends::None, margin, out) {
            return;
        }
    }
}

/// The face of `b` with the largest separation from `a`, or the next one after `last`; their distance if they are farther
/// apart than `margin`, and minus infinity if they are apart along an edge that is no surface: there, any motion counts.
fn widest(a: &PieceView, b: &PieceView, margin: f64, last: Option<Axis>) -> Result<Axis, f64> {
    let mut best = Axis { of_first: false, edge: 0, apart: f64::NEG_INFINITY };
    for (edge, (&v, &n)) in b.vertices.iter().zip(b.normals).enumerate() {
        let apart = least_height(a.vertices, v, n);
        let hidden = b.exposed[edge] == HIDDEN;
        if apart > margin || (hidden && apart > 0.0) {
            return Err(if apart > margin { apart } else { f64::NEG_INFINITY });
        }
        if !hidden && apart > best.apart && last.is_none_or(|last| apart < last.apart) {
            best = Axis { edge, apart, ..best };
        }
    }
    Ok(best)
}

/// The least height of points over a line through `v`.
#[inline]
fn least_height(points: &[Vector64], v: Vector64, normal: Vector64) -> f64 {
    let height = |p: &Vector64| (*p - v).dot(normal);
    // Not `min`, which looks for what is no number.
    let less = |a: f64, b: f64| if a < b { a } else { b };
    match points {
        // The most frequent case, without a loop.
        [p, q, r, s] => less(less(height(p), height(q)), less(height(r), height(s))),
        _ => points.iter().map(height).fold(f64::INFINITY, less),
    }
}

/// The contacts over a face; returns whether there are any.
fn over_face(a: &PieceView, b: &PieceView, axis: Axis, ends: Ends, margin: f64, out: &mut Vec<Touch>) -> bool {
    let first = out.len();
    if axis.of_first {
        clip(b, a, axis.edge, ends, margin, |touch| out.push(touch.reversed()));
    } else {
        clip(a, b, axis.edge, ends, margin, |touch| out.push(touch));
    }
    out.len() > first
}

/// Clips the edge of `a` that is most opposite to a face of `b`.
fn clip(a: &PieceView, b: &PieceView, face: usize, ends: Ends, margin: f64, mut push: impl FnMut(Touch)) {
    let (from, normal, end) = (b.vertices[face], b.normals[face], (face + 1) % b.vertices.len());
    let opposite =
        |best: usize, k: usize| if a.normals[k].dot(normal) < a.normals[best].dot(normal) { k } else { best };
    let edge = (0..a.normals.len()).fold(0, opposite);
    let next = (edge + 1) % a.vertices.len();
    let along = |p: Vector64| (p - from).dot(normal.perp());
    let (p, q, [low, high]) = (a.vertices[edge], a.vertices[next], b.exposed[face]);
    let (at_p, at_q) = (along(p), along(q));
    // The edge runs against the face: `at_p` is the larger coordinate.
    if at_q > high || at_p < low {
        let (mine, other) = if at_q > high { (next, end) } else { (edge, face) };
        let on_a = a.vertices[mine];
        let touch = match ends {
            Ends::Corners if a.corners[mine] && b.corners[other] => {
                at_points((on_a, b.vertices[other]), [0.0; 2], feature(mine, other))
            }
            Ends::Overlap if !(a.joined || b.joined) => Some(on_face(on_a, (from, normal), feature(mine, other))),
            _ => None,
        };
        touch.into_iter().filter(|touch| touch.gap() < margin).for_each(push);
        return;
    }
    let (way, [shown, hidden]) = (q - p, a.exposed[edge]);
    let (length, run) = (way.length(), at_p - at_q);
    // Fractions of the edge at the ends of the face.
    let at = |coordinate: f64, limit: f64| if run > 0.0 { (at_p - coordinate) / run } else { limit };
    let begin = at(high, 0.0).max(shown / length).max(0.0);
    let finish = at(low, 1.0).min(hidden / length).min(1.0);
    if begin > finish {
        return;
    }
    let mut add = |fraction: f64, feature: u32| {
        let touch = on_face(p + way * fraction, (from, normal), feature);
        if touch.gap() < margin {
            push(touch);
        }
    };
    add(begin, feature(edge, end));
    if finish - begin > 1e-6 {
        add(finish, feature(next, face));
    }
}

/// Contact of a point of the first polygon over a face of the second.
fn on_face(on_a: Vector64, (from, normal): (Vector64, Vector64), feature: u32) -> Touch {
    let on_b = on_a - normal * (on_a - from).dot(normal);
    Touch { reference: Reference::Second, normal, on_a, on_b, radii: [0.0; 2], feature }
}
