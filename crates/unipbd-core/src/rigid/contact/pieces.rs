//! The convex pieces of all walls and bodies in world coordinates, as flat columns.

use crate::math::Vector64;
use crate::rigid::{Bodies, CollisionFilter, Pose, Surface};
use crate::rigid::{Boundary, Wall};
use crate::shapes::{Core, Shape};

/// Index value for "none".
pub(super) const NONE: u32 = u32::MAX;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Bounds {
    pub low: Vector64,
    pub high: Vector64,
}

impl Bounds {
    pub const EMPTY: Bounds = Bounds { low: Vector64::INFINITY, high: Vector64::NEG_INFINITY };

    pub fn grown(&self, by: f64) -> Bounds {
        Bounds { low: self.low - Vector64::splat(by), high: self.high + Vector64::splat(by) }
    }

    pub fn overlaps(&self, other: &Bounds) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Separation of two boxes along the axis of largest separation; negative if they overlap [m].
    pub fn distance(&self, other: &Bounds) -> f64 {
        (self.low - other.high).max(other.low - self.high).max_element()
    }

    pub fn holds(&self, other: &Bounds) -> bool {
        self.low.x <= other.low.x
            && self.low.y <= other.low.y
            && self.high.x >= other.high.x
            && self.high.y >= other.high.y
    }
}

/// The owner of a piece, and the range of its vertices.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Piece {
    /// Its body, or [`NONE`].
    pub body: u32,
    /// Its wall, or [`NONE`].
    pub wall: u32,
    first: u32,
    count: u32,
    /// Contact radius [m].
    pub radius: f64,
    /// Size of its solid [m].
    pub size: f64,
    pub surface: Surface,
    pub filter: CollisionFilter,
}

/// An infinite half-plane wall.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct HalfPlane {
    pub wall: u32,
    pub point: Vector64,
    pub normal: Vector64,
    pub surface: Surface,
}

/// View of one piece in the narrow phase.
#[derive(Clone, Copy)]
pub(super) struct PieceView<'a> {
    pub vertices: &'a [Vector64],
    pub normals: &'a [Vector64],
    pub outer: &'a [bool],
    pub sampled: &'a [bool],
    pub radius: f64,
}

impl PieceView<'_> {
    /// Whether it is a disc.
    pub fn is_round(&self) -> bool {
        self.vertices.len() == 1
    }

    /// Whether it is the whole of a convex solid, without cut sides.
    pub fn is_whole(&self) -> bool {
        self.outer.iter().all(|&outer| outer)
    }
}

#[derive(Clone, Copy, serde::Serialize, serde::Deserialize)]
struct Vertex {
    place: Vector64,
    normal: Vector64,
}

/// The convex pieces of all walls and bodies: those of walls first, then body by body.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Pieces {
    pub all: Vec<Piece>,
    pub bounds: Vec<Bounds>,
    pub half_planes: Vec<HalfPlane>,
    local: Vec<Vertex>,
    vertices: Vec<Vector64>,
    normals: Vec<Vector64>,
    outer: Vec<bool>,
    sampled: Vec<bool>,
    known_bodies: usize,
}

impl Pieces {
    pub fn of_walls(walls: &[Wall]) -> Pieces {
        let mut pieces = Pieces::default();
        for (wall, index) in walls.iter().zip(0u32..) {
            let (shape, position) = match &wall.boundary {
                Boundary::HalfPlane { point, normal } => {
                    let (point, normal, surface) = (*point, *normal, wall.surface);
                    pieces.half_planes.push(HalfPlane { wall: index, point, normal, surface });
                    continue;
                }
                Boundary::Disc { center, radius } => (Shape::Disc { radius: *radius }, *center),
                Boundary::Polygon(corners) => (Shape::Polygon(corners.clone()), Vector64::ZERO),
            };
            let filter = CollisionFilter { layers: u32::MAX, collides_with: u32::MAX };
            let size = shape.moments().area.sqrt();
            let owner =
                Piece { body: NONE, wall: index, first: 0, count: 0, radius: 0.0, size, surface: wall.surface, filter };
            pieces.append(&shape.core(0.0), &owner);
            pieces.place_last(&Pose { position, angle: 0.0 });
        }
        pieces
    }

    /// Appends the pieces of bodies that were added since the last call; returns their number.
    pub fn append_bodies(&mut self, bodies: &Bodies) -> usize {
        let (known, pieces) = (self.known_bodies, self.all.len());
        for id in known..bodies.len() {
            let view = &bodies.views()[id];
            let owner = Piece {
                body: id as u32,
                wall: NONE,
                first: 0,
                count: 0,
                radius: 0.0,
                size: bodies.sizes[id],
                surface: view.surface,
                filter: view.filter,
            };
            self.append(&bodies.cores[id], &owner);
            self.place_last(&bodies.poses[id]);
        }
        self.known_bodies = bodies.len();
        self.all.len() - pieces
    }

    fn append(&mut self, core: &Core, owner: &Piece) {
        for piece in &core.pieces {
            let (first, count) = (self.local.len() as u32, piece.vertices.len() as u32);
            let columns = piece.vertices.iter().zip(&piece.normals);
            self.local.extend(columns.map(|(&place, &normal)| Vertex { place, normal }));
            self.vertices.resize(self.local.len(), Vector64::ZERO);
            self.normals.resize(self.local.len(), Vector64::ZERO);
            self.outer.extend(&piece.outer);
            self.sampled.extend(&piece.sampled);
            self.all.push(Piece { first, count, radius: core.radius, ..owner.clone() });
        }
    }

    /// Transforms the pieces whose bounds are not set yet.
    fn place_last(&mut self, pose: &Pose) {
        for index in self.bounds.len()..self.all.len() {
            self.bounds.push(Bounds::EMPTY);
            self.place(index, pose, Vector64::from_angle(pose.angle));
        }
    }

    /// Updates the pieces of bodies that may have moved.
    pub fn update(&mut self, bodies: &Bodies) {
        let (mut turned, mut rotation) = (NONE, Vector64::X);
        for index in 0..self.all.len() {
            let Piece { body, first, count, .. } = self.all[index];
            if body == NONE || !bodies.is_active(body as usize) {
                continue;
            }
            let pose = &bodies.poses[body as usize];
            let looks_the_same = count == 1 && self.local[first as usize].place == Vector64::ZERO;
            if !looks_the_same && turned != body {
                (turned, rotation) = (body, Vector64::from_angle(pose.angle));
            }
            self.place(index, pose, rotation);
        }
    }

    /// These pieces, where those of a saved state are; `None` if the state has other pieces.
    pub fn at_saved(&self, saved: &Pieces, bodies: &Bodies) -> Option<Pieces> {
        let mut taken = self.clone();
        taken.append_bodies(bodies);
        if saved.known_bodies == 0 {
            // Saved before the first substep.
            for index in 0..taken.all.len() {
                if let Some(pose) = bodies.poses.get(taken.all[index].body as usize) {
                    taken.place(index, pose, Vector64::from_angle(pose.angle));
                }
            }
            return Some(taken);
        }
        let lengths = |pieces: &Pieces| {
            let columns = [pieces.vertices.len(), pieces.normals.len(), pieces.bounds.len()];
            (pieces.known_bodies, pieces.all.len(), columns)
        };
        let finite = saved.vertices.iter().chain(&saved.normals).all(|vector| vector.is_finite())
            && saved.bounds.iter().all(|bounds| bounds.low.is_finite() && bounds.high.is_finite());
        let fits = finite && lengths(&taken) == lengths(saved);
        fits.then(|| {
            taken.vertices.clone_from(&saved.vertices);
            taken.normals.clone_from(&saved.normals);
            taken.bounds.clone_from(&saved.bounds);
            taken
        })
    }

    /// Number of pieces and half-planes.
    pub fn count(&self) -> usize {
        self.all.len() + self.half_planes.len()
    }

    /// The body a piece belongs to; half-planes and walls have none.
    pub fn body_of(&self, piece: u32) -> u32 {
        self.all.get(piece as usize).map_or(NONE, |piece| piece.body)
    }

    /// The half-plane of this index among pieces, which come first.
    pub fn half_plane(&self, piece: u32) -> Option<&HalfPlane> {
        (piece as usize).checked_sub(self.all.len()).map(|k| &self.half_planes[k])
    }

    fn place(&mut self, index: usize, pose: &Pose, rotation: Vector64) {
        let piece = &self.all[index];
        let mut bounds = Bounds::EMPTY;
        for k in piece.first as usize..(piece.first + piece.count) as usize {
            let place = pose.position + rotation.rotate(self.local[k].place);
            self.vertices[k] = place;
            self.normals[k] = rotation.rotate(self.local[k].normal);
            bounds = Bounds { low: bounds.low.min(place), high: bounds.high.max(place) };
        }
        self.bounds[index] = bounds.grown(piece.radius);
    }

    /// First vertex of a piece [m], and its radius.
    pub fn disc(&self, index: u32) -> (Vector64, f64) {
        let piece = &self.all[index as usize];
        (self.vertices[piece.first as usize], piece.radius)
    }

    pub fn view(&self, index: u32) -> PieceView<'_> {
        let piece = &self.all[index as usize];
        let range = piece.first as usize..(piece.first + piece.count) as usize;
        PieceView {
            vertices: &self.vertices[range.clone()],
            normals: &self.normals[range.clone()],
            outer: &self.outer[range.clone()],
            sampled: &self.sampled[range],
            radius: piece.radius,
        }
    }
}
