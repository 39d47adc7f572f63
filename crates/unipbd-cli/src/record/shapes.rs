//! Walls and bodies as shapes to draw and as clouds of samples.

use std::f64::consts::TAU;

use unipbd_core::math::Vector64;
use unipbd_core::observe::WallOutline;
use unipbd_core::rigid::Body;

use super::messages::{
    LinePrimitive, LineType, SceneEntity, SceneEntityDeletion, SceneUpdate, TriangleListPrimitive, WORLD, body_frame,
    color, identity, point, timestamp,
};

/// Colour of walls and their samples.
pub(crate) const WALL_COLOR: [u8; 4] = [150, 150, 150, 255];
/// Colour of bodies and their samples.
pub(crate) const BODY_COLOR: [u8; 4] = [214, 160, 92, 255];
const BODY_EDGE_COLOR: [u8; 4] = [110, 76, 36, 255];
/// Thickness of lines [pixels].
const LINE_THICKNESS: f64 = 2.0;
const DISC_CORNERS: u32 = 48;
/// Most samples of the boundary: an absurdly long wall gets coarser ones.
const MOST_BOUNDARY_SAMPLES: f64 = 100_000.0;

/// Walls and bodies as one update of the scene; `previous_bodies` were drawn before.
pub(crate) fn scene_update(time: u64, walls: &[WallOutline], bodies: &[Body], previous_bodies: usize) -> SceneUpdate {
    let deletion = |id: usize| SceneEntityDeletion {
        timestamp: Some(timestamp(time)),
        r#type: 0, // the entity with this id
        id: body_frame(id as u32),
    };
    let walls = walls.iter().enumerate().map(|(number, wall)| wall_entity(time, number, wall));
    let there = bodies.iter().enumerate().filter(|(_, body)| !body.removed);
    let drawn = there.map(|(id, body)| body_entity(time, id as u32, body));
    let gone = bodies.iter().enumerate().filter(|(_, body)| body.removed).map(|(id, _)| id);
    SceneUpdate {
        deletions: (bodies.len()..previous_bodies).chain(gone).map(deletion).collect(),
        entities: walls.chain(drawn).collect(),
    }
}

fn entity(time: u64, frame: String, id: String) -> SceneEntity {
    SceneEntity { timestamp: Some(timestamp(time)), frame_id: frame, id, frame_locked: true, ..Default::default() }
}

fn line(points: &[Vector64], kind: LineType, rgba: [u8; 4]) -> LinePrimitive {
    LinePrimitive {
        r#type: kind as i32,
        pose: Some(identity()),
        thickness: LINE_THICKNESS,
        scale_invariant: true,
        points: points.iter().copied().map(point).collect(),
        color: Some(color(rgba)),
        ..Default::default()
    }
}

fn wall_entity(time: u64, number: usize, wall: &WallOutline) -> SceneEntity {
    let kind = if wall.closed { LineType::LineLoop } else { LineType::LineStrip };
    let mut entity = entity(time, WORLD.to_owned(), format!("wall/{number}"));
    entity.lines.push(line(&wall.points, kind, WALL_COLOR));
    entity
}

fn body_entity(time: u64, id: u32, body: &Body) -> SceneEntity {
    let mut entity = entity(time, body_frame(id), body_frame(id));
    let outline = outline(body);
    entity.triangles.push(TriangleListPrimitive {
        pose: Some(identity()),
        points: outline.iter().copied().map(point).collect(),
        color: Some(color(BODY_COLOR)),
        indices: triangulate(&outline),
        ..Default::default()
    });
    entity.lines.push(line(&outline, LineType::LineLoop, BODY_EDGE_COLOR));
    if body.radius > 0.0 {
        // A spoke, so that one sees a disc turn.
        entity.lines.push(line(&[Vector64::ZERO, outline[0]], LineType::LineStrip, BODY_EDGE_COLOR));
    }
    entity
}

/// Corners of a body; those of a disc are spread around it.
pub(crate) fn outline(body: &Body) -> Vec<Vector64> {
    if body.radius <= 0.0 {
        return body.outline.clone();
    }
    let corner = |number: u32| Vector64::from_angle(TAU * f64::from(number) / f64::from(DISC_CORNERS)) * body.radius;
    (0..DISC_CORNERS).map(corner).collect()
}

/// The samples of all bodies where they are.
pub(crate) fn body_samples(bodies: &[Body]) -> Vec<Vector64> {
    let placed = |body: &Body| {
        let (place, turn) = (body.position, Vector64::from_angle(body.angle));
        body.samples.iter().map(move |sample| place + turn.rotate(*sample)).collect::<Vec<_>>()
    };
    bodies.iter().filter(|body| !body.removed).flat_map(placed).collect()
}

/// Corner triples that fill a simple counter-clockwise polygon, by cutting ears (Meisters 1975).
fn triangulate(polygon: &[Vector64]) -> Vec<u32> {
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::new();
    while left.len() >= 3 {
        let count = left.len();
        let corners = |ear: usize| [left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]];
        // Every simple polygon has an ear; for a faulty one any corner is as good.
        let ear = (0..count).find(|&ear| is_ear(polygon, &left, corners(ear))).unwrap_or(0);
        triangles.extend(corners(ear).map(|corner| corner as u32));
        left.remove(ear);
    }
    triangles
}

/// Whether the corner turns left and no other corner lies in its triangle.
fn is_ear(polygon: &[Vector64], left: &[usize], corners: [usize; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| polygon[corner]);
    let turn = |from: Vector64, to: Vector64, other: Vector64| (to - from).perp_dot(other - from);
    let inside = |p: Vector64| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    turn(a, b, c) > 0.0 && !left.iter().any(|corner| !corners.contains(corner) && inside(polygon[*corner]))
}

/// Points along the walls, a spacing apart.
pub(crate) fn boundary_samples(walls: &[WallOutline], spacing: f64) -> Vec<Vector64> {
    let total: f64 = walls.iter().flat_map(pieces).map(|(from, to)| from.distance(to)).sum();
    let step = spacing.max(total / MOST_BOUNDARY_SAMPLES);
    let mut samples = Vec::new();
    if !(step > 0.0 && total.is_finite()) {
        return samples;
    }
    for wall in walls {
        for (from, to) in pieces(wall) {
            let parts = (from.distance(to) / step).ceil().max(1.0);
            samples.extend((0..parts as usize).map(|part| from.lerp(to, part as f64 / parts)));
        }
        if !wall.closed {
            samples.extend(wall.points.last());
        }
    }
    samples
}

/// The straight pieces of a wall.
fn pieces(wall: &WallOutline) -> impl Iterator<Item = (Vector64, Vector64)> {
    let closing = wall.points.last().copied().zip(wall.points.first().copied()).filter(|_| wall.closed);
    wall.points.windows(2).map(|piece| (piece[0], piece[1])).chain(closing)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[Vector64], triangles: &[u32]) -> f64 {
        let corner = |index: u32| polygon[index as usize];
        let double = |t: &[u32]| (corner(t[1]) - corner(t[0])).perp_dot(corner(t[2]) - corner(t[0]));
        triangles.chunks(3).map(double).sum::<f64>() / 2.0
    }

    #[test]
    fn triangles_fill_a_polygon_with_a_notch() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 1.0], [0.0, 3.0]].map(Vector64::from);
        let triangles = triangulate(&corners);
        assert_eq!(triangles.len(), 9);
        assert!((area(&corners, &triangles) - 8.0).abs() < 1e-12);
        assert!(triangles.chunks(3).all(|triangle| area(&corners, triangle) > 0.0));
    }

    #[test]
    fn faulty_polygons_are_triangulated_without_end_or_panic() {
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(Vector64::from);
        assert_eq!(triangulate(&clockwise).len(), 6);
        assert!(triangulate(&clockwise[..2]).is_empty());
    }

    #[test]
    fn boundary_samples_lie_a_spacing_apart_on_the_walls() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vector64::from).to_vec();
        let closed = WallOutline { points: points.clone(), closed: true, endless: false };
        let open = WallOutline { points, closed: false, endless: false };
        assert_eq!(boundary_samples(&[closed], 0.25).len(), 16);
        assert_eq!(boundary_samples(&[open], 0.25).len(), 13);
    }

    #[test]
    fn absurdly_long_walls_get_coarse_samples() {
        let points = vec![Vector64::ZERO, Vector64::new(1e9, 0.0)];
        let wall = WallOutline { points, closed: false, endless: true };
        assert!(boundary_samples(&[wall], 0.01).len() <= 100_002);
    }
}
