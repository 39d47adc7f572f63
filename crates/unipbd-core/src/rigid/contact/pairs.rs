//! Pairs of pieces that may touch. The search is repeated only when a piece may have left its enlarged box.

use super::broad;
use super::manifold::entry;
use super::pieces::{Bounds, NONE, Pieces};
use crate::math::Vector64;
use crate::rigid::{Bodies, Surface, Twist};

/// Margin of the enlarged boxes, relative to the reach of a substep.
const ROOM: f64 = 4.0;

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
    /// Gap below which contacts are kept, in addition to the gap required by speed [m].
    pub near: f64,
    /// Motion of the pieces after which contact features are searched again [m].
    pub slack: f64,
}

/// The types of two colliding pieces.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) enum Kind {
    /// Two discs.
    Discs,
    /// A disc and a half-plane.
    DiscOnPlane,
    /// Any other piece and a half-plane.
    OnPlane,
    /// Two pieces that are not both discs.
    Pieces,
}

/// The contacts of a pair in the last substep, or at the time it fell asleep.
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

/// Relative position of the bodies of a pair.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Relation {
    /// From the centre of mass of the second body to that of the first [m].
    offset: Vector64,
    angles: [f64; 2],
}

/// Pose of the bodies at the last search for contact features, and its parameters.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct SearchRecord {
    pub at: Relation,
    /// Gap below which contacts were found [m].
    pub margin: f64,
    /// Relative motion of the bodies after which the contact features are no longer valid [m].
    pub room: f64,
}

impl Relation {
    pub fn of((a, b): (u32, u32), bodies: &Bodies) -> Relation {
        let (a, b) = (entry(&bodies.poses, a), entry(&bodies.poses, b));
        Relation { offset: a.position - b.position, angles: [a.angle, b.angle] }
    }

    /// Upper bound of the relative motion of any two points of the bodies since then [m].
    pub fn way(&self, since: &Relation, (a, b): (u32, u32), bodies: &Bodies) -> f64 {
        let turned = |k: usize, body: u32| (self.angles[k] - since.angles[k]).abs() * entry(&bodies.reaches, body);
        (self.offset - since.offset).length() + turned(0, a) + turned(1, b)
    }
}

impl SearchRecord {
    pub const NEVER: SearchRecord = SearchRecord {
        at: Relation { offset: Vector64::ZERO, angles: [0.0; 2] },
        margin: f64::NEG_INFINITY,
        room: f64::NEG_INFINITY,
    };
}

/// All pairs that may touch, and bounds on the motion of bodies.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Pairs {
    excluded: Vec<(u32, u32)>,
    /// Enlarged boxes: pieces may move within them before pairs are searched again.
    fat: Vec<Bounds>,
    pub all: Vec<Pair>,
    pub spans: Vec<Span>,
    pub sought: Vec<SearchRecord>,
    /// Pairs with at least one movable body.
    pub active: Vec<Active>,
    /// Flags of the bodies that were movable when `active` was listed.
    was_active: Vec<bool>,
    /// Linear speed of each body, and the speed of its fastest point by rotation about its centre [m/s].
    speeds: Vec<Twist>,
    /// Twice the relative motion of a body and a nearby body in the substep, the maximum over all nearby bodies [m].
    closing: Vec<f64>,
}

/// A pair with at least one movable body.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Active {
    pub index: u32,
    bodies: (u32, u32),
}

impl Pairs {
    /// Disables collisions between two bodies.
    pub fn exclude(&mut self, a: u32, b: u32) {
        self.excluded.push((a.min(b), a.max(b)));
        self.excluded.sort_unstable();
        self.fat.clear();
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
        let spanned = saved.spans.len() == count && saved.sought.len() == count;
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

    /// Half-planes follow all pieces: their indices increase with the number of pieces.
    pub fn renumber(&mut self, pieces: &Pieces, added: usize) {
        let first = (pieces.all.len() - added) as u32;
        for pair in self.all.iter_mut().filter(|pair| added > 0 && pair.key.1 >= first) {
            pair.key.1 += added as u32;
            pair.pieces.1 += added as u32;
        }
    }

    /// Updates the list to contain all pairs that can touch in a substep of length `dt`.
    pub fn update(&mut self, pieces: &Pieces, bodies: &Bodies, dt: f64, gravity: f64) {
        self.measure_speeds(bodies, gravity * dt);
        spread(&self.speeds, dt, self.active.iter().map(|active| active.bodies), &mut self.closing);
        if !self.hold(pieces, bodies, dt) {
            self.pair_up(pieces, bodies, dt);
        } else if (0..bodies.len()).any(|id| self.was_active[id] != bodies.is_active(id)) {
            self.list_active(bodies);
        } else {
            return;
        }
        spread(&self.speeds, dt, self.active.iter().map(|active| active.bodies), &mut self.closing);
    }

    /// Largest distance of a pair that can touch in the substep [m].
    pub fn margin(&self, pair: &Pair) -> f64 {
        let (a, b) = pair.bodies;
        entry(&self.closing, a).max(entry(&self.closing, b)) + pair.near
    }

    /// Velocity change by gravity in the substep [m/s].
    fn measure_speeds(&mut self, bodies: &Bodies, gain: f64) {
        self.speeds.clear();
        self.speeds.extend(bodies.velocities.iter().zip(&bodies.reaches).map(|(velocity, reach)| Twist {
            linear: velocity.linear,
            angular: velocity.angular.abs() * reach + gain,
        }));
    }

    /// Twice the maximum motion of a body in the substep: its own motion, or after a hit by a nearby body [m].
    fn reach(&self, body: u32, dt: f64) -> f64 {
        let own = entry(&self.speeds, body);
        (2.0 * (own.linear.length() + own.angular) * dt).max(entry(&self.closing, body))
    }

    /// Whether every piece stays in its enlarged box.
    fn hold(&self, pieces: &Pieces, bodies: &Bodies, dt: f64) -> bool {
        let moved = pieces.all.iter().zip(&pieces.bounds);
        self.fat.len() == pieces.all.len()
            && moved.zip(&self.fat).all(|((piece, bounds), fat)| {
                piece.body == NONE
                    || !bodies.is_active(piece.body as usize)
                    || fat.holds(&bounds.grown(self.reach(piece.body, dt) + 0.01 * piece.size))
            })
    }

    /// Searches the pairs again, with a margin for several substeps.
    fn pair_up(&mut self, pieces: &Pieces, bodies: &Bodies, dt: f64) {
        let mut found = self.seek(pieces, bodies, dt);
        // A body near a fast body can be as fast after a collision: both get the same margin.
        let before: Vec<f64> = (0..bodies.len() as u32).map(|body| self.reach(body, dt)).collect();
        let of_bodies = found.iter().map(|&(a, b)| (pieces.body_of(a), pieces.body_of(b)));
        spread(&self.speeds, dt, of_bodies, &mut self.closing);
        let lacks =
            |(body, &before): (u32, &f64)| self.reach(body, dt) > 2.0 * before + 0.01 * bodies.sizes[body as usize];
        if (0..).zip(&before).any(lacks) {
            found = self.seek(pieces, bodies, dt);
        }
        self.replace(pieces, &found);
        self.list_active(bodies);
    }

    /// Replaces the list of pairs; pairs that are in the old list keep their data.
    fn replace(&mut self, pieces: &Pieces, found: &[(u32, u32)]) {
        let (spans, sought) = (std::mem::take(&mut self.spans), std::mem::take(&mut self.sought));
        let mut old = std::mem::take(&mut self.all).into_iter().zip(spans.into_iter().zip(sought)).peekable();
        for &key in found {
            while old.next_if(|(pair, _)| pair.key < key).is_some() {}
            let known = old.next_if(|(pair, _)| pair.key == key);
            let (pair, (span, sought)) =
                known.unwrap_or_else(|| (Pair::new(pieces, key), (Span::default(), SearchRecord::NEVER)));
            self.all.push(pair);
            self.spans.push(span);
            self.sought.push(sought);
        }
    }

    fn seek(&mut self, pieces: &Pieces, bodies: &Bodies, dt: f64) -> Vec<(u32, u32)> {
        let mut fat = std::mem::take(&mut self.fat);
        fat.clear();
        fat.extend(pieces.all.iter().zip(&pieces.bounds).map(|(piece, bounds)| match piece.body {
            NONE => *bounds,
            body => bounds.grown(ROOM * self.reach(body, dt) + 0.05 * piece.size),
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

impl Pair {
    fn new(pieces: &Pieces, key: (u32, u32)) -> Pair {
        // Pieces of walls come first: the body must be the first of the contact.
        let (a, b) = if pieces.body_of(key.0) == NONE { (key.1, key.0) } else { key };
        let piece = &pieces.all[a as usize];
        let plane = pieces.half_plane(b);
        let round = |piece: u32| pieces.view(piece).is_round();
        let radius = |round: bool, radius: f64| if round { radius } else { f64::INFINITY };
        let (surface, wall, size, rounding, rolling) = match plane {
            Some(plane) => (&plane.surface, plane.wall, f64::INFINITY, 0.0, f64::INFINITY),
            None => {
                let other = &pieces.all[b as usize];
                (&other.surface, other.wall, other.size, other.radius, radius(round(b), other.radius))
            }
        };
        let surface = piece.surface.combined(surface);
        let rolling = rolling.min(radius(round(a), piece.radius));
        let kind = match (plane.is_some(), round(a), plane.is_none() && round(b)) {
            (true, true, _) => Kind::DiscOnPlane,
            (true, false, _) => Kind::OnPlane,
            (false, true, true) => Kind::Discs,
            _ => Kind::Pieces,
        };
        let least = |rounding: f64, round: bool| if round { f64::INFINITY } else { rounding };
        let rounding = if plane.is_some() { f64::INFINITY } else { least(rounding, round(b)) };
        Pair {
            key,
            pieces: (a, b),
            bodies: (piece.body, pieces.body_of(b)),
            wall,
            kind,
            surface,
            rolling_arm: if rolling.is_finite() { surface.rolling_friction * rolling } else { 0.0 },
            near: 0.01 * piece.size.min(size),
            slack: 0.5 * least(piece.radius, round(a)).min(rounding),
        }
    }
}

/// Fills `closing` from relative speeds: bodies with a common motion hardly collide, and a body that is hit by a
/// third body does not exceed the speed of the third body.
fn spread(speeds: &[Twist], dt: f64, pairs: impl Iterator<Item = (u32, u32)>, closing: &mut Vec<f64>) {
    closing.clear();
    closing.resize(speeds.len(), 0.0);
    for (a, b) in pairs {
        let (of_a, of_b) = (entry(speeds, a), entry(speeds, b));
        let way = 2.0 * ((of_a.linear - of_b.linear).length() + of_a.angular + of_b.angular) * dt;
        for body in [a, b] {
            if let Some(most) = closing.get_mut(body as usize) {
                *most = if way > *most { way } else { *most };
            }
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
