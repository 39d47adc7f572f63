//! Finds the contacts of each substep and hands on the impulses of the last one.

use super::broad;
use super::manifold::{Contact, Point, Touching, entry};
use super::narrow::{self, Touch};
use super::pieces::{Bounds, NONE, Pieces};
use crate::bodies::{Bodies, Surface};
use crate::math::Vector64;
use crate::shapes::Wall;
use rayon::prelude::*;

/// Two pieces, or a piece and a half-plane, that may touch.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
struct Pair {
    a: u32,
    b: u32,
    surface: Surface,
    rolling_arm: f64,
    /// Gap below which contacts are kept beside what speed demands [m].
    near: f64,
    /// Its contacts of the last substep, or in `frozen`.
    first: u32,
    count: u32,
    frozen: bool,
}

/// Pairs per task, and how many pairs make tasks worth their while.
const CHUNK: usize = 512;
const PARALLEL_FROM: usize = 2048;

/// The pairs that may touch, and the contacts found among them.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Finder {
    pieces: Pieces,
    excluded: Vec<(u32, u32)>,
    /// Boxes within which pieces may move before pairs are sought anew.
    fat: Vec<Bounds>,
    pairs: Vec<Pair>,
    /// Pairs of which a body can move.
    active: Vec<u32>,
    /// Which bodies could move when `active` was listed.
    was_active: Vec<bool>,
    contacts: Vec<Contact>,
    /// Contacts of the coming substep, before they are given their impulses.
    candidates: Vec<Contact>,
    /// Contacts between sleeping bodies, kept until they wake.
    frozen: Vec<Contact>,
    /// What each task of the narrow phase found.
    #[serde(skip)]
    found: Vec<Found>,
    /// Twice the distance each body can go in the substep on its own [m].
    own_reach: Vec<f64>,
    /// The same for it or any body near it, which may hit it.
    reach: Vec<f64>,
}

/// Room for what one task finds.
#[derive(Clone, Default)]
struct Found {
    touches: Vec<Touch>,
    contacts: Vec<Contact>,
}

impl Finder {
    pub fn new(walls: &[Wall]) -> Finder {
        Finder { pieces: Pieces::of_walls(walls), ..Finder::default() }
    }

    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    pub fn contacts_mut(&mut self) -> &mut [Contact] {
        &mut self.contacts
    }

    /// Two bodies that no longer collide with each other.
    pub fn exclude(&mut self, a: u32, b: u32) {
        self.excluded.push((a.min(b), a.max(b)));
        self.excluded.sort_unstable();
        self.fat.clear();
    }

    /// Finds all contacts that can act in a substep of length `dt`.
    pub fn find(&mut self, bodies: &Bodies, dt: f64, gravity: f64) {
        self.pieces.append_bodies(bodies);
        self.pieces.update(bodies);
        self.estimate_reach(bodies, dt, gravity);
        if !self.pairs_hold(bodies) {
            self.pair_up(bodies);
        } else if (0..bodies.len()).any(|id| self.was_active[id] != bodies.is_active(id)) {
            self.list_active(bodies);
        }
        self.collide(bodies);
    }

    /// What was found, before [`Finder::keep_impulses`].
    pub fn candidates(&self) -> &[Contact] {
        &self.candidates
    }

    /// Ends the search: the contacts get the impulses of the last substep times `scale`, those of
    /// sleeping bodies the forces they fell asleep with times `square`, dt^2.
    pub fn keep_impulses(&mut self, scale: f64, square: f64) {
        for contact in &mut self.candidates {
            let pair = &self.pairs[contact.who.pair as usize];
            let (known, scale) = if pair.frozen { (&self.frozen, square) } else { (&self.contacts, scale) };
            let range = pair.first as usize..(pair.first + pair.count) as usize;
            keep(contact, &known[range], 5.0 * pair.near, scale);
        }
        std::mem::swap(&mut self.contacts, &mut self.candidates);
        for &index in &self.active {
            let pair = &mut self.pairs[index as usize];
            (pair.first, pair.count, pair.frozen) = (0, 0, false);
        }
        for (contact, index) in self.contacts.iter().zip(0u32..) {
            let pair = &mut self.pairs[contact.who.pair as usize];
            if pair.count == 0 {
                pair.first = index;
            }
            pair.count += 1;
        }
    }

    /// Keeps the contacts of sleeping pairs aside, with forces in place of impulses.
    pub fn freeze(&mut self, bodies: &Bodies, dt: f64) {
        let mut frozen = Vec::new();
        for pair in &mut self.pairs {
            let asleep = !is_active(&self.pieces, pair.a, bodies) && !is_active(&self.pieces, pair.b, bodies);
            if asleep && pair.count > 0 {
                let range = pair.first as usize..(pair.first + pair.count) as usize;
                let start = frozen.len();
                if pair.frozen {
                    frozen.extend_from_slice(&self.frozen[range]);
                } else {
                    frozen.extend_from_slice(&self.contacts[range]);
                    frozen[start..].iter_mut().for_each(|contact| scale_impulses(contact, 1.0 / (dt * dt)));
                }
                (pair.first, pair.frozen) = (start as u32, true);
            }
        }
        self.frozen = frozen;
    }

    /// A body near a faster one may be hit by it, and must see what is behind it as early.
    fn estimate_reach(&mut self, bodies: &Bodies, dt: f64, gravity: f64) {
        self.own_reach.clear();
        self.own_reach.extend((0..bodies.len()).map(|id| {
            let velocity = &bodies.velocities[id];
            let speed = velocity.linear.length() + velocity.angular.abs() * bodies.reaches[id];
            2.0 * (speed + gravity * dt) * dt
        }));
        let pairs = self.active.iter().map(|&index| &self.pairs[index as usize]);
        spread_reach(&self.own_reach, &self.pieces, pairs.map(|pair| (pair.a, pair.b)), &mut self.reach);
    }

    /// Whether no piece can leave the box that pairs were sought with.
    fn pairs_hold(&self, bodies: &Bodies) -> bool {
        let pieces = self.pieces.all.iter().zip(&self.pieces.bounds);
        self.fat.len() == self.pieces.all.len()
            && pieces.zip(&self.fat).all(|((piece, bounds), fat)| {
                piece.body == NONE
                    || !bodies.is_active(piece.body as usize)
                    || fat.holds(&bounds.grown(self.reach[piece.body as usize] + 0.01 * piece.size))
            })
    }

    /// Seeks the pairs anew, with room for several substeps.
    fn pair_up(&mut self, bodies: &Bodies) {
        let mut found = self.seek_pairs(bodies);
        // Bodies near a fast one move as far as it does, once hit: give them the same room.
        let mut spread = Vec::new();
        spread_reach(&self.own_reach, &self.pieces, found.iter().copied(), &mut spread);
        let lacking = (0..bodies.len()).any(|id| spread[id] > 2.0 * self.reach[id] + 0.01 * bodies.sizes[id]);
        self.reach = spread;
        if lacking {
            found = self.seek_pairs(bodies);
        }
        let mut old = std::mem::take(&mut self.pairs).into_iter().peekable();
        for (a, b) in found {
            while old.next_if(|pair| (pair.a, pair.b) < (a, b)).is_some() {}
            let known = old.next_if(|pair| (pair.a, pair.b) == (a, b));
            let pair = known.unwrap_or_else(|| self.new_pair(a, b));
            self.pairs.push(pair);
        }
        self.list_active(bodies);
    }

    fn seek_pairs(&mut self, bodies: &Bodies) -> Vec<(u32, u32)> {
        let pieces = &self.pieces;
        self.fat.clear();
        self.fat.extend(pieces.all.iter().zip(&pieces.bounds).map(|(piece, bounds)| {
            let reach = entry(&self.reach, piece.body);
            if piece.body == NONE { *bounds } else { bounds.grown(4.0 * reach + 0.05 * piece.size) }
        }));
        broad::pairs(pieces, &self.fat, |a, b| may_touch(pieces, &self.excluded, bodies, a.min(b), a.max(b)))
    }

    fn new_pair(&self, a: u32, b: u32) -> Pair {
        let piece = &self.pieces.all[a as usize];
        let round = |piece: u32| self.pieces.view(piece).is_round();
        let radius = |round: bool, radius: f64| if round { radius } else { f64::INFINITY };
        let (surface, size, other) = match self.pieces.all.get(b as usize) {
            Some(other) => (&other.surface, other.size, radius(round(b), other.radius)),
            None => {
                (&self.pieces.half_planes[b as usize - self.pieces.all.len()].surface, f64::INFINITY, f64::INFINITY)
            }
        };
        let surface = piece.surface.combined(surface);
        let rolling_radius = other.min(radius(round(a), piece.radius));
        let rolling_arm = if rolling_radius.is_finite() { surface.rolling_friction * rolling_radius } else { 0.0 };
        let near = 0.01 * piece.size.min(size);
        Pair { a, b, surface, rolling_arm, near, first: 0, count: 0, frozen: false }
    }

    fn list_active(&mut self, bodies: &Bodies) {
        self.was_active.clear();
        self.was_active.extend((0..bodies.len()).map(|id| bodies.is_active(id)));
        let moving = |pair: &Pair| is_active(&self.pieces, pair.a, bodies) || is_active(&self.pieces, pair.b, bodies);
        self.active.clear();
        self.active.extend(self.pairs.iter().zip(0..).filter(|(pair, _)| moving(pair)).map(|(_, index)| index));
    }

    /// The narrow phase over all active pairs; contacts come in the order of the pairs.
    fn collide(&mut self, bodies: &Bodies) {
        let mut contacts = std::mem::take(&mut self.candidates);
        contacts.clear();
        let mut found = std::mem::take(&mut self.found);
        found.resize_with(found.len().max(self.active.len().div_ceil(CHUNK)), Found::default);
        let seek = |(found, pairs): (&mut Found, &[u32])| {
            found.contacts.clear();
            pairs.iter().for_each(|&index| self.collide_pair(index, bodies, found));
        };
        if self.active.len() < PARALLEL_FROM {
            found.iter_mut().zip(self.active.chunks(CHUNK)).for_each(seek);
        } else {
            found.par_iter_mut().zip(self.active.par_chunks(CHUNK)).for_each(seek);
        }
        found.iter_mut().for_each(|found| contacts.append(&mut found.contacts));
        (self.found, self.candidates) = (found, contacts);
    }

    fn collide_pair(&self, index: u32, bodies: &Bodies, found: &mut Found) {
        let Found { touches, contacts } = found;
        let pair = &self.pairs[index as usize];
        let (a, b) = (body_of(&self.pieces, pair.a), body_of(&self.pieces, pair.b));
        let margin = entry(&self.reach, a) + entry(&self.reach, b) + pair.near;
        touches.clear();
        let plane = (pair.b as usize).checked_sub(self.pieces.all.len()).map(|k| &self.pieces.half_planes[k]);
        let wall = match plane {
            Some(plane) => {
                narrow::against_half_plane(&self.pieces.view(pair.a), plane, margin, touches);
                plane.wall
            }
            None => {
                let bounds = &self.pieces.bounds;
                if bounds[pair.a as usize].grown(margin).overlaps(&bounds[pair.b as usize]) {
                    narrow::between(&self.pieces.view(pair.a), &self.pieces.view(pair.b), margin, touches);
                }
                let wall = |piece: u32| self.pieces.all[piece as usize].wall;
                wall(pair.a).min(wall(pair.b))
            }
        };
        // Pieces of walls come first: the body must be the first of the contact.
        let swapped = a == NONE;
        let (a, b) = if swapped { (b, a) } else { (a, b) };
        let center = |id: u32| bodies.poses.get(id as usize).map_or(Vector64::ZERO, |pose| pose.position);
        let who = Touching { pair: index, a, b, wall, surface: pair.surface, rolling_arm: pair.rolling_arm };
        let (start, centers) = (contacts.len(), (center(a), center(b)));
        for touch in touches.iter() {
            let touch = if swapped { touch.reversed() } else { *touch };
            let fitting = contacts[start..].iter().position(|contact| contact.has_room(touch.normal));
            let place = fitting.map_or(contacts.len(), |place| start + place);
            if place == contacts.len() {
                contacts.push(Contact::new(&who, touch.normal));
            }
            contacts[place].add(&touch, centers);
        }
    }
}

/// Gives a contact the impulses of the same points in the last substep: the same vertex, or else the
/// same place. Where something rebounded they are no guess of what comes.
fn keep(contact: &mut Contact, known: &[Contact], near: f64, scale: f64) {
    let old = || known.iter().flat_map(Contact::points);
    for point in contact.points_mut() {
        let close = |old: &&Point| (old.arm_a - point.arm_a).length_squared() < near * near;
        let same = old().find(|old| old.feature == point.feature).or_else(|| old().find(close));
        if let Some(old) = same.filter(|old| old.rebound == 0.0) {
            point.normal_impulse = old.normal_impulse * scale;
            point.tangent_impulse = old.tangent_impulse * scale;
        }
    }
    let rebounded = old().any(|point| point.rebound != 0.0);
    if let Some(first) = known.first().filter(|_| !rebounded) {
        contact.rolling_impulse = first.rolling_impulse * scale;
    }
}

fn scale_impulses(contact: &mut Contact, factor: f64) {
    contact.rolling_impulse *= factor;
    for point in contact.points_mut() {
        point.normal_impulse *= factor;
        point.tangent_impulse *= factor;
    }
}

/// Fills `reach` with each body's own, or that of a faster one it is paired with.
fn spread_reach(own: &[f64], pieces: &Pieces, pairs: impl Iterator<Item = (u32, u32)>, reach: &mut Vec<f64>) {
    reach.clear();
    reach.extend_from_slice(own);
    for (a, b) in pairs.map(|(a, b)| (body_of(pieces, a), body_of(pieces, b))) {
        if a != NONE && b != NONE {
            reach[a as usize] = reach[a as usize].max(own[b as usize]);
            reach[b as usize] = reach[b as usize].max(own[a as usize]);
        }
    }
}

/// The body a piece belongs to; half-planes and walls have none.
fn body_of(pieces: &Pieces, piece: u32) -> u32 {
    pieces.all.get(piece as usize).map_or(NONE, |piece| piece.body)
}

fn is_active(pieces: &Pieces, piece: u32, bodies: &Bodies) -> bool {
    let body = body_of(pieces, piece);
    body != NONE && bodies.is_active(body as usize)
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
