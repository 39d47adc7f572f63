//! The convex pieces of all walls and bodies in world coordinates, as flat columns.

use super::bounds::{Bounds, HIDDEN, NONE};
use super::exposure::{self, Solid};
use super::frames::Frames;
use crate::math::{Vector64, direction};
use crate::rigid::{Bodies, BodyKind, CollisionFilter, Pose, Surface};
use crate::rigid::{Boundary, Wall};
use crate::scene::FrictionRule;
use crate::shapes::{Core, Shape};

/// The owner of a piece, and the range of its vertices.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Piece {
    /// Its body, or [`NONE`].
    pub body: u32,
    /// Its wall, or [`NONE`].
    pub wall: u32,
    first: u32,
    count: u32,
    /// Radius of a disc; 0 for a polygon \[m].
    pub radius: f64,
    /// Whether a part of its outline is covered by other solids.
    joined: bool,
    /// Size of its solid \[m].
    pub size: f64,
    pub surface: Surface,
    pub filter: CollisionFilter,
}

impl Piece {
    fn of(body: u32, wall: u32) -> Piece {
        let (surface, filter) = Default::default();
        Piece { body, wall, first: 0, count: 0, radius: 0.0, joined: false, size: 0.0, surface, filter }
    }

    fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// An infinite half-plane wall.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct HalfPlane {
    pub wall: u32,
    pub point: Vector64,
    pub normal: Vector64,
    pub surface: Surface,
}

impl HalfPlane {
    /// Whether a box reaches into the half-plane.
    pub fn meets(&self, bounds: &Bounds) -> bool {
        let (center, half) = ((bounds.low + bounds.high) * 0.5, (bounds.high - bounds.low) * 0.5);
        (center - self.point).dot(self.normal) - half.dot(self.normal.abs()) < 0.0
    }
}

/// View of one piece in the narrow phase.
#[derive(Clone, Copy)]
pub(super) struct PieceView<'a> {
    pub vertices: &'a [Vector64],
    pub normals: &'a [Vector64],
    /// The part of each edge that is surface, from the distance to the distance from its start \[m].
    pub exposed: &'a [[f64; 2]],
    /// Whether each vertex is a corner of the surface.
    pub corners: &'a [bool],
    pub radius: f64,
    /// Whether a part of its outline is covered by other solids.
    pub joined: bool,
}

impl PieceView<'_> {
    /// Whether it is a disc.
    pub fn is_round(&self) -> bool {
        self.vertices.len() == 1
    }

    /// Whether a part of its outline is no surface.
    pub fn hides(&self) -> bool {
        self.joined || self.exposed.contains(&HIDDEN)
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
    exposed: Vec<[f64; 2]>,
    corners: Vec<bool>,
    known_bodies: usize,
    /// How friction coefficients combine.
    pub rule: FrictionRule,
}

impl Pieces {
    pub fn of_walls(walls: &[Wall], rule: FrictionRule) -> Pieces {
        let mut pieces = Pieces { rule, ..Pieces::default() };
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
            let filter = CollisionFilter { layers: u32::MAX, collides_with: u32::MAX, group: 0 };
            let size = shape.moments().area.sqrt();
            let owner = Piece { size, surface: wall.surface, filter, ..Piece::of(NONE, index) };
            pieces.append(&shape.core(), &owner);
            pieces.place_last(&Pose { position, angle: 0.0 });
        }
        pieces.join(|_| false);
        pieces
    }

    /// Appends the pieces of bodies that were added since the last call; returns their number.
    pub fn append_bodies(&mut self, bodies: &Bodies) -> usize {
        let (known, pieces) = (self.known_bodies, self.all.len());
        for id in known..bodies.len() {
            let view = &bodies.views()[id];
            let (size, surface, filter) = (bodies.sizes[id], view.surface, view.filter);
            if view.sensor {
                continue;
            }
            let owner = Piece { size, surface, filter, ..Piece::of(id as u32, NONE) };
            self.append(&bodies.cores[id], &owner);
            self.place_last(&bodies.poses[id]);
        }
        let is_static = |id: usize| bodies.views()[id].kind == BodyKind::Static;
        if (known..bodies.len()).any(is_static) {
            self.join(|body| is_static(body as usize));
        }
        self.known_bodies = bodies.len();
        self.all.len() - pieces
    }

    /// Marks the parts of the outlines of walls and static bodies that are covered by other such solids: a body
    /// that slides over flush solids must not catch on the edges between them.
    fn join(&mut self, is_static: impl Fn(u32) -> bool) {
        let fixed = |piece: &Piece| piece.count > 1 && (piece.body == NONE || is_static(piece.body));
        let solids: Vec<usize> = (0..self.all.len()).filter(|&index| fixed(&self.all[index])).collect();
        let solid = |&index: &usize| {
            let (piece, range) = (&self.all[index], self.all[index].range());
            Solid {
                vertices: &self.vertices[range.clone()],
                normals: &self.normals[range],
                bounds: self.bounds[index],
                size: piece.size,
                owner: (piece.body, piece.wall),
            }
        };
        let planes: Vec<(Vector64, Vector64)> = self.half_planes.iter().map(|p| (p.point, p.normal)).collect();
        let covered = exposure::covered(&solids.iter().map(solid).collect::<Vec<_>>(), &planes);
        for (&index, covered) in solids.iter().zip(covered) {
            let range = self.all[index].range();
            self.all[index].joined =
                exposure::cut(&covered, &mut self.exposed[range.clone()], &mut self.corners[range]);
        }
    }

    fn append(&mut self, core: &Core, owner: &Piece) {
        for piece in &core.pieces {
            let (first, count) = (self.local.len() as u32, piece.vertices.len() as u32);
            let columns = piece.vertices.iter().zip(&piece.normals);
            self.local.extend(columns.map(|(&place, &normal)| Vertex { place, normal }));
            self.vertices.resize(self.local.len(), Vector64::ZERO);
            self.normals.resize(self.local.len(), Vector64::ZERO);
            let edges = piece.outer.iter().zip(crate::shapes::edges(&piece.vertices));
            self.exposed.extend(edges.map(|(&outer, (p, q))| if outer { [0.0, (q - p).length()] } else { HIDDEN }));
            self.corners.extend(&piece.corners);
            self.all.push(Piece { first, count, radius: core.radius, ..owner.clone() });
        }
    }

    /// Transforms the pieces whose bounds are not set yet.
    fn place_last(&mut self, pose: &Pose) {
        for index in self.bounds.len()..self.all.len() {
            self.bounds.push(Bounds::EMPTY);
            self.place(index, pose, direction(pose.angle));
        }
    }

    /// Updates the pieces of bodies that may have moved.
    pub fn update(&mut self, bodies: &Bodies, frames: &Frames) {
        for index in 0..self.all.len() {
            let body = self.all[index].body;
            if body != NONE && bodies.is_active(body as usize) {
                self.place(index, &bodies.poses[body as usize], frames.of(body).rotation);
            }
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
                    taken.place(index, pose, direction(pose.angle));
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

    /// Where each piece, and each half-plane behind them, is in other pieces; [`NONE`] for those of bodies that are gone.
    /// Bodies keep their shape and their order.
    pub fn places_in(&self, other: &Pieces) -> Vec<u32> {
        let mut places = Vec::with_capacity(self.count());
        let mut next = 0usize;
        for piece in &self.all {
            let owner = (piece.body, piece.wall);
            let same = other.all.get(next).is_some_and(|found| (found.body, found.wall) == owner);
            places.push(if same { next as u32 } else { NONE });
            next += usize::from(same);
        }
        places.extend((0..self.half_planes.len()).map(|k| (other.all.len() + k) as u32));
        places
    }

    /// Number of pieces and half-planes.
    pub fn count(&self) -> usize {
        self.all.len() + self.half_planes.len()
    }

    /// Number of walls, up to the last one with a piece.
    pub fn walls(&self) -> usize {
        let of_planes = self.half_planes.iter().map(|plane| plane.wall);
        let walls = of_planes.chain(self.all.iter().map(|piece| piece.wall)).filter(|wall| *wall != NONE);
        walls.max().map_or(0, |last| last as usize + 1)
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
        for k in piece.range() {
            let place = pose.position + rotation.rotate(self.local[k].place);
            self.vertices[k] = place;
            self.normals[k] = rotation.rotate(self.local[k].normal);
            bounds = Bounds { low: bounds.low.min(place), high: bounds.high.max(place) };
        }
        self.bounds[index] = bounds.grown(piece.radius);
    }

    /// First vertex of a piece \[m], and its radius.
    pub fn disc(&self, index: u32) -> (Vector64, f64) {
        let piece = &self.all[index as usize];
        (self.vertices[piece.first as usize], piece.radius)
    }

    pub fn view(&self, index: u32) -> PieceView<'_> {
        let piece = &self.all[index as usize];
        let range = piece.range();
        PieceView {
            vertices: &self.vertices[range.clone()],
            normals: &self.normals[range.clone()],
            exposed: &self.exposed[range.clone()],
            corners: &self.corners[range],
            radius: piece.radius,
            joined: piece.joined,
        }
    }
}
