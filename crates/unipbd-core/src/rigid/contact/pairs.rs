//! Pairs of pieces that may touch. The search is repeated only when a piece may leave its enlarged box.

use super::bounds::{Bounds, NONE};
use super::broad;
use super::pieces::Pieces;
use super::reach::Reach;
use crate::math::Vector64;
use crate::rigid::{Bodies, Surface};

/// Frames for which the enlarged boxes hold a body that goes on as it does.
const ROOM: f64 = 2.0;

/// Two pieces, or a piece and a half-plane, that may touch.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Pair {
    /// Indices of both in increasing order; pairs are sorted by them.
    key: (u32, u32),
    /// The piece of the first body of a contact, and the other piece.
    pub pieces: (u32, u32),
    /// Their bodies; the second is `NONE` for a wall.
    pub bodies: (u32, u32),
    pub wall: u32,
    pub kind: Kind,
    pub surface: Surface,
    pub rolling_arm: f64,
    /// Gap below which contacts are kept, in addition to the gap required by motion [m].
    pub near: f64,
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

/// The contacts of a pair in the last search, or at the time it fell asleep.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Span {
    pub first: u32,
    pub count: u32,
    pub frozen: bool,
}

impl Span {
    /// Whether it lies within this many contacts.
    pub fn fits(&self, contacts: usize) -> bool {
        self.first as usize + self.count as usize <= contacts
    }

    pub fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// All pairs that may touch.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Pairs {
    excluded: Vec<(u32, u32)>,
    /// Enlarged boxes: pieces may move within them before pairs are searched again.
    fat: Vec<Bounds>,
    pub all: Vec<Pair>,
    pub spans: Vec<Span>,
    /// Pairs with at least one movable body.
    pub active: Vec<Active>,
    /// Flags of the bodies that were movable when `active` was listed.
    was_active: Vec<bool>,
}

/// A pair with at least one movable body.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Active {
    pub index: u32,
    pub bodies: (u32, u32),
}

impl Pairs {
    /// Disables collisions between these pairs of bodies, and enables all others; whether that changes anything.
    pub fn exclude_only(&mut self, mut pairs: Vec<(u32, u32)>) -> bool {
        pairs.iter_mut().for_each(|(a, b)| (*a, *b) = (*(a.min(b)), *(a.max(b))));
        pairs.sort_unstable();
        pairs.dedup();
        let changed = pairs != self.excluded;
        if changed {
            self.excluded = pairs;
            self.fat.clear();
        }
        changed
    }

    /// Pairs of a saved state, made anew between these pieces; `None` if the state makes no sense.
    pub fn at_saved(&self, saved: Pairs, pieces: &Pieces, bodies: &Bodies) -> Option<Pairs> {
        let count = saved.all.len();
        let ordered = saved.all.windows(2).all(|two| two[0].key < two[1].key);
        let known = |&(a, b): &(u32, u32)| {
            a < b && (b as usize) < pieces.count() && (a as usize) < pieces.all.len() && {
                let solid = pieces.all.get(b as usize).is_none() || pieces.body_of(b) != NONE;
                solid && may_touch(pieces, &self.excluded, bodies, a, b)
            }
        };
        let keys: Vec<(u32, u32)> = saved.all.iter().map(|pair| pair.key).collect();
        let spanned = saved.spans.len() == count;
        // Flags of bodies are read while boxes hold.
        let flagged = saved.fat.is_empty() || saved.was_active.len() == bodies.len();
        if !(ordered && spanned && flagged && keys.iter().all(known)) {
            return None;
        }
        let all: Vec<Pair> = keys.into_iter().map(|key| Pair::new(pieces, key)).collect();
        let listed = |active: &Active| all.get(active.index as usize).is_some_and(|pair| pair.bodies == active.bodies);
        let rising = saved.active.windows(2).all(|two| two[0].index < two[1].index);
        (rising && saved.active.iter().all(listed)).then(|| Pairs { all, excluded: self.excluded.clone(), ..saved })
    }

    /// Makes the list anew after pieces were, given the new place of each old piece; pairs that are left keep their
    /// contacts, with the surfaces of now. Returns their number.
    pub fn rebuild(&mut self, places: &[u32], pieces: &Pieces, bodies: &Bodies) -> usize {
        let spans = std::mem::take(&mut self.spans);
        for (pair, span) in std::mem::take(&mut self.all).into_iter().zip(spans) {
            let key = (places[pair.key.0 as usize], places[pair.key.1 as usize]);
            if key.0 != NONE && key.1 != NONE && may_touch(pieces, &self.excluded, bodies, key.0, key.1) {
                self.all.push(Pair::new(pieces, key));
                self.spans.push(span);
            }
        }
        self.fat.clear();
        self.list_active(bodies);
        self.all.len()
    }

    /// Half-planes follow all pieces: their indices increase with the number of pieces.
    pub fn renumber(&mut self, pieces: &Pieces, added: usize) {
        let first = (pieces.all.len() - added) as u32;
        for pair in self.all.iter_mut().filter(|pair| added > 0 && pair.key.1 >= first) {
            pair.key.1 += added as u32;
            pair.pieces.1 += added as u32;
        }
    }

    /// Bodies that became movable since the pairs were listed are searched.
    pub fn note_woken(&self, bodies: &Bodies, reach: &mut Reach) -> bool {
        let mut any = false;
        for (id, was) in self.was_active.iter().enumerate() {
            if !was && bodies.is_active(id) {
                (reach.wanted[id], any) = (true, true);
            }
        }
        any
    }

    /// Updates the list to contain all pairs of wanted bodies that can touch until the end of the frame.
    pub fn update(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &mut Reach, gravity: f64) {
        reach.note(bodies);
        reach.allow(bodies, gravity, self.all.iter().map(|pair| pair.bodies));
        if !self.hold(pieces, bodies, reach) {
            self.pair_up(pieces, bodies, reach, gravity);
        } else if self.was_active.len() != bodies.len()
            || (0..bodies.len()).any(|id| self.was_active[id] != bodies.is_active(id))
        {
            self.list_active(bodies);
        }
    }

    /// Whether every wanted piece stays in its enlarged box.
    fn hold(&self, pieces: &Pieces, bodies: &Bodies, reach: &Reach) -> bool {
        let moved = pieces.all.iter().zip(&pieces.bounds);
        self.fat.len() == pieces.all.len()
            && moved.zip(&self.fat).all(|((piece, bounds), fat)| {
                !reach.is_wanted(piece.body)
                    || !bodies.is_active(piece.body as usize)
                    || fat.holds(&swept(bounds, reach, piece.body, 1.0, 0.0))
            })
    }

    /// Searches the pairs again, with room for several frames.
    fn pair_up(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &mut Reach, gravity: f64) {
        let mut found = self.seek(pieces, bodies, reach);
        // A body near a fast body can be as fast after a collision: with the pairs known, both get the same allowance.
        let of = |&(a, b): &(u32, u32)| (pieces.body_of(a), pieces.body_of(b));
        reach.allow(bodies, gravity, found.iter().map(of));
        if !self.hold(pieces, bodies, reach) {
            found = self.seek(pieces, bodies, reach);
            reach.allow(bodies, gravity, found.iter().map(of));
        }
        self.replace(pieces, &found);
        self.list_active(bodies);
    }

    /// Replaces the list of pairs; pairs that are in the old list keep their data.
    fn replace(&mut self, pieces: &Pieces, found: &[(u32, u32)]) {
        let spans = std::mem::take(&mut self.spans);
        let mut old = std::mem::take(&mut self.all).into_iter().zip(spans).peekable();
        for &key in found {
            while old.next_if(|(pair, _)| pair.key < key).is_some() {}
            let known = old.next_if(|(pair, _)| pair.key == key);
            let (pair, span) = known.unwrap_or_else(|| (Pair::new(pieces, key), Span::default()));
            self.all.push(pair);
            self.spans.push(span);
        }
    }

    fn seek(&mut self, pieces: &Pieces, bodies: &Bodies, reach: &Reach) -> Vec<(u32, u32)> {
        let mut fat = std::mem::take(&mut self.fat);
        fat.clear();
        fat.extend(pieces.all.iter().zip(&pieces.bounds).map(|(piece, bounds)| match piece.body {
            NONE => *bounds,
            body => swept(bounds, reach, body, ROOM, 0.05 * piece.size),
        }));
        self.fat = fat;
        broad::pairs(pieces, &self.fat, |a, b| may_touch(pieces, &self.excluded, bodies, a.min(b), a.max(b)))
    }

    fn list_active(&mut self, bodies: &Bodies) {
        self.was_active.clear();
        self.was_active.extend((0..bodies.len()).map(|id| bodies.is_active(id)));
        let moving = |body: u32| body != NONE && self.was_active[body as usize];
        let listed = self.all.iter().zip(0..).filter(|(pair, _)| moving(pair.bodies.0) || moving(pair.bodies.1));
        self.active.clear();
        self.active.extend(listed.map(|(pair, index)| Active { index, bodies: pair.bodies }));
    }
}

/// The box that a piece covers on its way, for so many frames, with room around it [m].
fn swept(bounds: &Bounds, reach: &Reach, body: u32, frames: f64, room: f64) -> Bounds {
    let (way, off) = reach.sweep(body);
    let way = way.linear * frames;
    let (low, high) = (bounds.low + way.min(Vector64::ZERO), bounds.high + way.max(Vector64::ZERO));
    Bounds { low, high }.grown(off * frames + room)
}

impl Pair {
    fn new(pieces: &Pieces, key: (u32, u32)) -> Pair {
        // Pieces of walls come first: the body must be the first of the contact.
        let (a, b) = if pieces.body_of(key.0) == NONE { (key.1, key.0) } else { key };
        let piece = &pieces.all[a as usize];
        let plane = pieces.half_plane(b);
        let round = |piece: u32| pieces.view(piece).is_round();
        let radius = |round: bool, radius: f64| if round { radius } else { f64::INFINITY };
        let (surface, wall, size, rolling) = match plane {
            Some(plane) => (&plane.surface, plane.wall, f64::INFINITY, f64::INFINITY),
            None => {
                let other = &pieces.all[b as usize];
                (&other.surface, other.wall, other.size, radius(round(b), other.radius))
            }
        };
        let surface = piece.surface.combined(surface, pieces.rule);
        let rolling = rolling.min(radius(round(a), piece.radius));
        let kind = match plane {
            Some(_) => Kind::OnPlane,
            None if round(a) && round(b) => Kind::Discs,
            None => Kind::Pieces,
        };
        Pair {
            key,
            pieces: (a, b),
            bodies: (piece.body, pieces.body_of(b)),
            wall,
            kind,
            surface,
            rolling_arm: if rolling.is_finite() { surface.rolling_friction * rolling } else { 0.0 },
            near: 0.01 * piece.size.min(size),
        }
    }
}

/// Whether two pieces (or a piece and a half-plane) can ever act on each other.
fn may_touch(pieces: &Pieces, excluded: &[(u32, u32)], bodies: &Bodies, a: u32, b: u32) -> bool {
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
