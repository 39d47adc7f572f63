//! Contacts of one pair: those of the last search while they hold, else searched by the narrow phase.

use super::blocks::Blocks;
use super::bounds::NONE;
use super::collide;
use super::contact_cache::{ContactCache, Rebound};
use super::contact_set::{ContactSet, Found, Moved};
use super::frames::Frames;
use super::manifold::Contact;
use super::pair::{Kind, Meeting, Touching};
use super::pairs::{Active, Pairs, Searched, Span};
use super::pieces::Pieces;
use super::reach::Reach;
use super::touch::{Points, Touch};
use crate::math::Vector64;

/// Way of two bodies against each other after which their contacts are searched again, relative to the gap below which
/// contacts are kept.
const HOLD: f64 = 1.0;
/// The same of two discs, whose contact is measured anew in each substep.
const HOLD_OF_DISCS: f64 = 4.0;

/// Input of the contact search of a pair.
pub(super) struct PairContacts<'a> {
    pub pieces: &'a Pieces,
    pub pairs: &'a Pairs,
    pub reach: &'a Reach,
    pub frames: &'a Frames,
    /// Length of the last substep, whose impulses are kept \[s].
    pub dt: f64,
    /// Contacts of the last substep.
    pub last: &'a ContactSet,
    /// Contacts of sleeping bodies.
    pub frozen: &'a ContactSet,
    /// Where the contacts of the last search stay, with their impulses; `None` if all are put into a new order.
    pub staying: Option<&'a Blocks>,
}

impl PairContacts<'_> {
    /// Appends the contacts of a pair, unless they stay.
    pub fn pair(&self, active: &Active, out: &mut ContactSet) {
        let (index, span) = (active.index, &self.pairs.spans[active.index as usize]);
        let keep = |out: &mut ContactSet| {
            if self.staying.is_none() {
                self.keep_all(index, *span, out);
            }
        };
        if !span.frozen && !self.is_wanted(active.bodies) {
            return keep(out);
        }
        let (need, lie) = (self.reach.margin(active.bodies), self.lie(active.bodies));
        if !span.frozen && self.holds(&span.searched, active.bodies, need, lie) {
            return keep(out);
        }
        let (pair, start) = (Meeting::of(self.pieces, &self.pairs.all[index as usize]), out.contacts.len());
        let margin = need + pair.near;
        let mut touches = std::mem::take(&mut out.touches);
        touches.clear();
        let room = self.touch(&pair, margin, &mut touches);
        let hold = match pair.kind {
            _ if touches.is_empty() => f64::INFINITY,
            Kind::Discs => HOLD_OF_DISCS * pair.near,
            _ => HOLD * pair.near,
        };
        let searched = Searched { place: lie.0, turn: lie.1, room, hold, points: Points::of(&touches) };
        if self.staying.is_some() && searched.points.stay(&span.searched.points) {
            self.move_contact((index, active.bodies), &touches, searched, out);
            out.touches = touches;
            return;
        }
        let near = 5.0 * pair.near;
        let pair = (!touches.is_empty()).then(|| Touching::of(self.pieces, &self.pairs.all[index as usize]));
        for (touch, pair) in touches.iter().zip(pair.iter().cycle()) {
            self.add(active.bodies, pair, touch, start, out);
        }
        out.touches = touches;
        self.hand_on(*span, near, start, out);
        let count = (out.contacts.len() - start) as u32;
        out.elastic |= pair.is_some_and(|pair| pair.surface.restitution > 0.0);
        out.found.push(Found { pair: index, count, searched });
    }

    /// Notes where the points of a contact lie now.
    fn move_contact(
        &self,
        (pair, bodies): (u32, (u32, u32)),
        touches: &[Touch],
        searched: Searched,
        out: &mut ContactSet,
    ) {
        let frames = self.frames.both(bodies);
        let mut anchors = [Default::default(); 2];
        for (anchors, touch) in anchors.iter_mut().zip(touches) {
            *anchors = touch.anchors(frames);
        }
        out.moved.push(Moved { pair, searched, normal: touches[0].fixed_normal(frames), anchors });
    }

    fn is_wanted(&self, (a, b): (u32, u32)) -> bool {
        self.reach.is_wanted(a) || self.reach.is_wanted(b)
    }

    /// Appends the contacts of the last search.
    fn keep_all(&self, index: u32, span: Span, out: &mut ContactSet) {
        out.found.push(Found { pair: index, count: span.count, searched: span.searched });
        if span.count == 0 {
            return;
        }
        out.contacts.extend_from_slice(&self.last.contacts[span.range()]);
        out.caches.extend_from_slice(&self.last.caches[span.range()]);
        out.elastic |= self.last.caches[span.range()].iter().any(|cache| cache.surface.restitution > 0.0);
    }

    /// Place of one body in the coordinates of the other, and their angle; the rotation of a disc does not count.
    #[inline]
    fn lie(&self, (a, b): (u32, u32)) -> (Vector64, f64) {
        let (of_a, of_b) = (self.frames.of(a), self.frames.of(b));
        let round = |body: u32| body != NONE && self.reach.lever(body) == 0.0;
        match (round(a), round(b)) {
            (true, true) => (of_a.position - of_b.position, 0.0),
            (false, true) => (of_a.local(of_b.position), 0.0),
            (true, false) => (of_b.local(of_a.position), 0.0),
            (false, false) => (of_b.local(of_a.position), self.frames.angle(a) - self.frames.angle(b)),
        }
    }

    /// Whether no contact with a gap below `need` is missing, and those found are still where they were.
    #[inline]
    fn holds(&self, of: &Searched, (a, _): (u32, u32), need: f64, (place, turn): (Vector64, f64)) -> bool {
        let moved = (place - of.place).length() + (turn - of.turn).abs() * self.reach.lever(a);
        moved <= of.hold && need + moved <= of.room
    }

    /// Searches for contacts with gaps below `margin`; returns the gap below which all were found.
    fn touch(&self, pair: &Meeting, margin: f64, touches: &mut Vec<Touch>) -> f64 {
        let (a, b) = pair.pieces;
        match (pair.kind, self.pieces.half_plane(b)) {
            (Kind::Discs, _) => return collide::of_discs(self.pieces, (a, b), margin, touches),
            (_, Some(plane)) => collide::against_half_plane(&self.pieces.view(a), plane, margin, touches),
            _ => {
                let bounds = |piece: u32| &self.pieces.bounds[piece as usize];
                let apart = bounds(a).distance(bounds(b));
                if apart > margin {
                    return apart;
                }
                let (a, b) = (self.pieces.view(a), self.pieces.view(b));
                let room = collide::between(&a, &b, margin, touches);
                // Where a part of an outline is no surface, contacts may begin anywhere.
                let may_begin = touches.is_empty() && room <= margin && (a.hides() || b.hides());
                return if may_begin { f64::NEG_INFINITY } else { room };
            }
        }
        margin
    }

    /// Adds a point to the contacts of the pair, which begin at `start`.
    fn add(&self, bodies: (u32, u32), pair: &Touching, touch: &Touch, start: usize, out: &mut ContactSet) {
        let frames = self.frames.both(bodies);
        let fitting = out.contacts[start..].iter().position(|contact| contact.has_room(touch.normal));
        let place = fitting.map_or(out.contacts.len(), |place| start + place);
        if place == out.contacts.len() {
            out.contacts.push(Contact::new(bodies, touch.normal, pair.rolling_arm));
            out.caches.push(ContactCache::new(pair.wall, pair.surface, touch, frames));
        }
        out.contacts[place].add(touch, &mut out.caches[place], frames);
    }

    /// Initialises the contacts from `start` on with the impulses of the same points in the last search.
    fn hand_on(&self, span: Span, near: f64, start: usize, out: &mut ContactSet) {
        if span.count == 0 {
            return;
        }
        let known = if span.frozen { self.frozen } else { self.last };
        let scale = if span.frozen { self.dt * self.dt } else { 1.0 };
        out.known.clear();
        out.known.extend_from_slice(&known.contacts[span.range()]);
        if let Some(blocks) = self.staying {
            span.range().zip(&mut out.known).for_each(|(number, contact)| blocks.give_back_to(number, contact, false));
        }
        for (contact, cache) in out.contacts[start..].iter_mut().zip(&out.caches[start..]) {
            keep((contact, cache), (&out.known, &known.caches[span.range()]), near, scale);
        }
    }
}

/// Copies the impulses of the same points in the last search to a contact: the same vertices, or else the same
/// position on a body.
fn keep((contact, cache): (&mut Contact, &ContactCache), known: (&[Contact], &[ContactCache]), near: f64, scale: f64) {
    let old = || {
        let rows = known.0.iter().zip(known.1);
        rows.flat_map(|(contact, cache)| (0..contact.points().len()).map(move |k| (contact, cache, k)))
    };
    for k in 0..contact.points().len() {
        let close = |&(_, old, j): &(&Contact, &ContactCache, usize)| {
            let (of_a, of_b) = (old.anchors[j].0 - cache.anchors[k].0, old.anchors[j].1 - cache.anchors[k].1);
            of_a.length_squared().min(of_b.length_squared()) < near * near
        };
        let same = old().find(|(_, old, j)| old.features[*j] == cache.features[k]).or_else(|| old().find(close));
        if let Some((old, old_cache, j)) = same {
            let kept = if old_cache.rebound[j] == Rebound::default() { scale } else { 0.0 };
            contact.points_mut()[k].keep(&old.points()[j], kept);
        }
    }
    if let (Some(first), Some(old_cache)) = (known.0.first(), known.1.first()) {
        contact.rolling_impulse = if old_cache.rebounded() { 0.0 } else { first.rolling_impulse * scale };
    }
}
