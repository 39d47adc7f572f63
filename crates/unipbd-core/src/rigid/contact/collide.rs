//! Narrow phase: contact features of two rounded convex pieces that touch or are close.
//!
//! Vertices of each piece are tested against the faces of the other, in both directions, so that
//! neither piece is preferred and a mirrored pair gives mirrored contacts. If the unrounded cores
//! overlap (deep starts), vertices would push in all directions: convex solids are then
//! separated over a single face. In a piece cut from a concave solid that face may point the wrong way.

use super::pieces::{HalfPlane, PieceView, Pieces};
use crate::math::Vector64;

/// A contact feature of two pieces that touch or are close.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Unit normal, towards the first piece.
    pub normal: Vector64,
    /// Point on the surface of the first piece [m].
    pub on_a: Vector64,
    /// Point on the surface of the second piece [m].
    pub on_b: Vector64,
    /// Distance of the surfaces along the normal, negative when they overlap [m].
    pub gap: f64,
    pub feature: FeaturePair,
}

/// The features of a contact point. They identify the point in the next substep, and allow a new measurement.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct FeaturePair {
    /// The contact vertex, with the flag [`OF_SECOND`] for a vertex of the second piece.
    pub vertex: u32,
    /// The face of the other piece below the vertex, or the closest vertex, with the flag [`VERTEX`].
    on: u32,
}

impl FeaturePair {
    /// Whether pieces with so many vertices have these features; a half-plane has no vertices.
    pub fn fits(self, first: usize, second: Option<usize>) -> bool {
        let Some(second) = second else { return (self.vertex as usize) < first };
        let (vertex, on) = ((self.vertex & !OF_SECOND) as usize, (self.on & !VERTEX) as usize);
        let (mine, other) = if self.vertex & OF_SECOND == 0 { (first, second) } else { (second, first) };
        vertex < mine && on < other
    }
}

/// Flag of a vertex of the second piece.
const OF_SECOND: u32 = 1 << 31;
/// Flag of a vertex in place of a face.
const VERTEX: u32 = 1 << 31;

/// Validity of the features found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Proximity {
    /// The distance exceeds the margin.
    Apart,
    /// The same vertices and faces stay in contact for small motions of the pieces.
    Near,
    /// Cores overlap: the separation direction must be searched again.
    Overlapping,
}

/// Contacts of a piece with a half-plane.
pub(super) fn against_half_plane(a: &PieceView, plane: &HalfPlane, margin: f64, out: &mut Vec<Touch>) {
    for (k, &p) in a.vertices.iter().enumerate().filter(|&(k, _)| a.sampled[k]) {
        let touch = on_half_plane(a, plane, p, k as u32);
        if touch.gap < margin {
            out.push(touch);
        }
    }
}

fn on_half_plane(a: &PieceView, plane: &HalfPlane, p: Vector64, vertex: u32) -> Touch {
    let height = (p - plane.point).dot(plane.normal);
    let (normal, on_a, on_b) = (plane.normal, p - plane.normal * a.radius, p - plane.normal * height);
    Touch { normal, on_a, on_b, gap: height - a.radius, feature: FeaturePair { vertex, on: 0 } }
}

/// Contacts of two pieces with gaps below `margin`.
pub(super) fn between(a: &PieceView, b: &PieceView, margin: f64, out: &mut Vec<Touch>) -> Proximity {
    let radii = a.radius + b.radius;
    let mut overlap = false;
    if !a.is_round() && !b.is_round() {
        let (Some(of_b), Some(of_a)) = (separation(a, b, radii + margin), separation(b, a, radii + margin)) else {
            return Proximity::Apart;
        };
        overlap = of_a.max(of_b) < 0.0;
    }
    if overlap && a.is_whole() && b.is_whole() {
        overlapping_cores(a, b, out);
        return Proximity::Overlapping;
    }
    let over_b = vertices_on_faces(a, b, margin, out, |touch| touch);
    let over_a = vertices_on_faces(b, a, margin, out, Touch::reversed);
    closest_vertices(a, b, (over_b, over_a), margin, out);
    if overlap && out.is_empty() {
        overlapping_cores(a, b, out);
    }
    if overlap { Proximity::Overlapping } else { Proximity::Near }
}

/// Measures a feature of [`between`] again, at the current position of the pieces.
pub(super) fn again(a: &PieceView, b: &PieceView, feature: FeaturePair) -> Touch {
    if feature.vertex & OF_SECOND != 0 {
        return again(b, a, FeaturePair { vertex: feature.vertex ^ OF_SECOND, on: feature.on }).reversed();
    }
    let (p, on) = (a.vertices[feature.vertex as usize], (feature.on & !VERTEX) as usize);
    if feature.on & VERTEX != 0 {
        return at_vertices(a, b, p, b.vertices[on], feature);
    }
    let normal = b.normals[on];
    over_face(a, b, p, ((p - b.vertices[on]).dot(normal), normal), feature)
}

/// The same for a half-plane.
pub(super) fn again_on_half_plane(a: &PieceView, plane: &HalfPlane, feature: FeaturePair) -> Touch {
    on_half_plane(a, plane, a.vertices[feature.vertex as usize], feature.vertex)
}

/// Contact of the vertex `p` of `a` at a height over a face of `b` with this normal.
fn over_face(
    a: &PieceView,
    b: &PieceView,
    p: Vector64,
    (height, normal): (f64, Vector64),
    feature: FeaturePair,
) -> Touch {
    let (on_a, on_b) = (p - normal * a.radius, p - normal * (height - b.radius));
    Touch { normal, on_a, on_b, gap: height - a.radius - b.radius, feature }
}

/// Contact of the vertices `p` of `a` and `q` of `b`.
fn at_vertices(a: &PieceView, b: &PieceView, p: Vector64, q: Vector64, feature: FeaturePair) -> Touch {
    let distance = (p - q).length();
    let normal = if distance > 0.0 { (p - q) / distance } else { Vector64::Y };
    let (on_a, on_b) = (p - normal * a.radius, q + normal * b.radius);
    Touch { normal, on_a, on_b, gap: distance - a.radius - b.radius, feature }
}

/// Contact of two discs, if their gap is below `margin`.
pub(super) fn discs(pieces: &Pieces, (a, b): (u32, u32), margin: f64) -> Option<Touch> {
    let ((p, radius_a), (q, radius_b)) = (pieces.disc(a), pieces.disc(b));
    let (distance, radii) = ((p - q).length(), radius_a + radius_b);
    let normal = if distance > 0.0 { (p - q) / distance } else { Vector64::Y };
    let (on_a, on_b, feature) = (p - normal * radius_a, q + normal * radius_b, FeaturePair { vertex: 0, on: VERTEX });
    (distance < radii + margin).then_some(Touch { normal, on_a, on_b, gap: distance - radii, feature })
}

impl Touch {
    /// The same contact with the pieces swapped.
    pub fn reversed(self) -> Touch {
        Touch {
            normal: -self.normal,
            on_a: self.on_b,
            on_b: self.on_a,
            gap: self.gap,
            feature: FeaturePair { vertex: self.feature.vertex ^ OF_SECOND, on: self.feature.on },
        }
    }
}

/// Largest separation of `a` from the faces of `b`; `None` as soon as it exceeds `limit`.
fn separation(a: &PieceView, b: &PieceView, limit: f64) -> Option<f64> {
    let mut largest = f64::NEG_INFINITY;
    for (&v, &n) in b.vertices.iter().zip(b.normals) {
        let distance = lowest(a, v, n);
        if distance > limit {
            return None;
        }
        largest = largest.max(distance);
    }
    Some(largest)
}

fn lowest(a: &PieceView, point: Vector64, normal: Vector64) -> f64 {
    a.vertices.iter().map(|&p| (p - point).dot(normal)).fold(f64::INFINITY, f64::min)
}

/// Adds the vertices of `a` that lie over a face of `b`, and returns a bit mask of all such vertices, near or
/// far. `named` restores the order of the pieces.
fn vertices_on_faces(
    a: &PieceView,
    b: &PieceView,
    margin: f64,
    out: &mut Vec<Touch>,
    named: impl Fn(Touch) -> Touch,
) -> u64 {
    let mut over = 0;
    let radii = a.radius + b.radius;
    // A rounded vertex may lie slightly beyond the end of a face; a disc must not.
    let overhang = if a.is_round() { 0.0 } else { 0.25 * radii };
    for (k, &p) in a.vertices.iter().enumerate().filter(|&(k, _)| a.sampled[k]) {
        let Some((face, height)) = face_below(p, b) else { continue };
        let (from, to, normal) = (b.vertices[face], b.vertices[(face + 1) % b.vertices.len()], b.normals[face]);
        let tangent = normal.perp();
        let (along, length) = ((p - from).dot(tangent), (to - from).dot(tangent));
        let gap = height - radii;
        let is_over = along >= -overhang && along <= length + overhang;
        let known = |touch: &Touch| ((touch.on_a + touch.on_b) * 0.5 - p).dot(tangent).abs() < 0.5 * radii;
        over |= u64::from(is_over) << (k % 64);
        if is_over && gap < margin && !out.iter().any(known) {
            let feature = FeaturePair { vertex: k as u32, on: face as u32 };
            out.push(named(over_face(a, b, p, (height, normal), feature)));
        }
    }
    over
}

/// The face of a piece with the largest signed distance from a point, and the distance.
fn face_below(p: Vector64, piece: &PieceView) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    let mut cut = f64::NEG_INFINITY;
    for (k, (&v, &n)) in piece.vertices.iter().zip(piece.normals).enumerate() {
        let height = (p - v).dot(n);
        if !piece.outer[k] {
            cut = cut.max(height);
        } else if best.is_none_or(|(_, highest)| height > highest) {
            best = Some((k, height));
        }
    }
    // A point inside the solid beyond a cut belongs to another piece of the solid, which handles it.
    best.filter(|&(_, height)| !piece.is_round() && (height >= 0.0 || cut <= 0.0))
}

/// Adds the closest pair of vertices if neither is over a face: for discs, and for corner contacts.
/// Without this rule the corners of flush boxes would collide.
fn closest_vertices(a: &PieceView, b: &PieceView, over: (u64, u64), margin: f64, out: &mut Vec<Touch>) {
    let free = |piece: &PieceView, over: u64, k: usize| piece.sampled[k] && over >> (k % 64) & 1 == 0;
    let mut best: Option<(f64, usize, usize)> = None;
    for (i, &p) in a.vertices.iter().enumerate().filter(|&(i, _)| free(a, over.0, i)) {
        for (j, &q) in b.vertices.iter().enumerate().filter(|&(j, _)| free(b, over.1, j)) {
            let square = (p - q).length_squared();
            if best.is_none_or(|(least, ..)| square < least) {
                best = Some((square, i, j));
            }
        }
    }
    let Some((square, i, j)) = best else { return };
    let (p, q) = (a.vertices[i], b.vertices[j]);
    let reach = a.radius + b.radius;
    let known = |touch: &Touch| (touch.on_a - p).length_squared() < reach * reach;
    if square.sqrt() - reach < margin && !out.iter().any(known) {
        // A disc has one vertex: the corner of the other piece identifies the contact better.
        out.push(if b.is_round() && !a.is_round() {
            at_vertices(b, a, q, p, FeaturePair { vertex: j as u32, on: i as u32 | VERTEX }).reversed()
        } else {
            at_vertices(a, b, p, q, FeaturePair { vertex: i as u32, on: j as u32 | VERTEX })
        });
    }
}

/// Overlapping cores: one separation direction, over the face of least penetration.
fn overlapping_cores(a: &PieceView, b: &PieceView, out: &mut Vec<Touch>) {
    let (over_b, over_a) = (shallowest_face(a, b), shallowest_face(b, a));
    let least = |way: Option<(usize, f64)>| way.map_or(f64::NEG_INFINITY, |(_, depth)| depth);
    let radii = a.radius + b.radius;
    let mut push_out = |a: &PieceView, b: &PieceView, face: usize, named: fn(Touch) -> Touch| {
        let (from, normal) = (b.vertices[face], b.normals[face]);
        for (k, &p) in a.vertices.iter().enumerate() {
            let height = (p - from).dot(normal);
            if height < radii {
                let feature = FeaturePair { vertex: k as u32, on: face as u32 };
                out.push(named(over_face(a, b, p, (height, normal), feature)));
            }
        }
    };
    match (over_b, over_a) {
        (Some((face, depth)), _) if depth >= least(over_a) => push_out(a, b, face, |touch| touch),
        (_, Some((face, _))) => push_out(b, a, face, Touch::reversed),
        _ => {}
    }
}

/// The outer face of `b` with the largest separation from `a`.
fn shallowest_face(a: &PieceView, b: &PieceView) -> Option<(usize, f64)> {
    let faces = (0..b.vertices.len()).filter(|&k| b.outer[k]);
    faces.map(|k| (k, lowest(a, b.vertices[k], b.normals[k]))).reduce(|x, y| if y.1 > x.1 { y } else { x })
}
