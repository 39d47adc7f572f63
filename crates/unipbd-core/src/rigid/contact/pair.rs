//! Two pieces, or a piece and a half-plane, that may touch.

use super::bounds::NONE;
use super::pieces::{Piece, Pieces};
use crate::rigid::{Bodies, Surface};

/// Two pieces, or a piece and a half-plane, that may touch.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Pair {
    /// Indices of both in increasing order; pairs are sorted by them.
    pub key: (u32, u32),
    /// Their bodies, that of the first contact side first; the second is `NONE` for a wall.
    pub bodies: (u32, u32),
}

/// Data of a pair for the search.
pub(super) struct Meeting {
    /// The piece of the first body of a contact, and the other piece.
    pub pieces: (u32, u32),
    pub kind: Kind,
    /// Gap below which contacts are kept, in addition to the gap required by motion \[m].
    pub near: f64,
}

/// Data of a pair for its contacts.
pub(super) struct Touching {
    pub wall: u32,
    pub surface: Surface,
    pub rolling_arm: f64,
}

/// The types of two colliding pieces.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) enum Kind {
    /// Two discs.
    Discs,
    /// A piece and a half-plane.
    OnPlane,
    /// Two pieces that are not both discs.
    Pieces,
}

impl Pair {
    pub fn new(pieces: &Pieces, key: (u32, u32)) -> Pair {
        let (a, b) = ordered(pieces, key);
        Pair { key, bodies: (pieces.body_of(a), pieces.body_of(b)) }
    }

    /// The wall of the pair, or `NONE`.
    pub fn wall(&self, pieces: &Pieces) -> u32 {
        let (_, b) = ordered(pieces, self.key);
        pieces.half_plane(b).map_or_else(|| pieces.all[b as usize].wall, |plane| plane.wall)
    }
}

/// The pieces of a pair with that of the first body of a contact in front: pieces of walls come first in a key.
fn ordered(pieces: &Pieces, (a, b): (u32, u32)) -> (u32, u32) {
    if pieces.body_of(a) == NONE { (b, a) } else { (a, b) }
}

impl Meeting {
    pub fn of(pieces: &Pieces, pair: &Pair) -> Meeting {
        let (a, b) = ordered(pieces, pair.key);
        let round = |piece: u32| pieces.view(piece).is_round();
        let (kind, size) = match pieces.all.get(b as usize) {
            None => (Kind::OnPlane, f64::INFINITY),
            Some(other) if round(a) && round(b) => (Kind::Discs, other.size),
            Some(other) => (Kind::Pieces, other.size),
        };
        Meeting { pieces: (a, b), kind, near: 0.01 * pieces.all[a as usize].size.min(size) }
    }
}

impl Touching {
    pub fn of(pieces: &Pieces, pair: &Pair) -> Touching {
        let (a, b) = ordered(pieces, pair.key);
        let radius = |index: u32, piece: &Piece| match pieces.view(index).is_round() {
            true => piece.radius,
            false => f64::INFINITY,
        };
        let piece = &pieces.all[a as usize];
        let (surface, wall, rolling) = match pieces.half_plane(b) {
            Some(plane) => (&plane.surface, plane.wall, f64::INFINITY),
            None => {
                let other = &pieces.all[b as usize];
                (&other.surface, other.wall, radius(b, other))
            }
        };
        let (surface, rolling) = (piece.surface.combined(surface, pieces.rule), rolling.min(radius(a, piece)));
        let rolling_arm = if rolling.is_finite() { surface.rolling_friction * rolling } else { 0.0 };
        Touching { wall, surface, rolling_arm }
    }
}

/// Whether two pieces (or a piece and a half-plane) can ever act on each other.
pub(super) fn may_touch(pieces: &Pieces, excluded: &[(u32, u32)], bodies: &Bodies, a: u32, b: u32) -> bool {
    let piece = &pieces.all[a as usize];
    let dynamic = |body: u32| body != NONE && bodies.is_dynamic(body as usize);
    let Some(other) = pieces.all.get(b as usize) else { return dynamic(piece.body) };
    let matched = |body: u32| body != NONE && bodies.elasticity(body as usize).is_some();
    piece.body != other.body
        && !matched(piece.body)
        && !matched(other.body)
        && (dynamic(piece.body) || dynamic(other.body))
        && piece.filter.allows(&other.filter)
        && excluded.binary_search(&(piece.body.min(other.body), piece.body.max(other.body))).is_err()
}
