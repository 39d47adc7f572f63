//! Contacts of one pair: those of the last search while they hold, else searched by the narrow phase.

use super::collide;
use super::contact_cache::{ContactCache, Rebound};
use super::contact_set::ContactSet;
use super::frames::Frames;
use super::manifold::Contact;
use super::pairs::{Active, Kind, Pair, Pairs, Span};
use super::pieces::Pieces;
use super::reach::Reach;
use super::touch::Touch;

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
}

impl PairContacts<'_> {
    /// Appends the contacts of a pair.
    pub fn pair(&self, active: &Active, out: &mut ContactSet) {
        let (index, span) = (active.index, self.pairs.spans[active.index as usize]);
        if !self.reach.is_wanted(active.bodies.0) && !self.reach.is_wanted(active.bodies.1) && !span.frozen {
            out.contacts.extend_from_slice(&self.last.contacts[span.range()]);
            // The number of a pair changes with the list of pairs.
            let caches = self.last.caches[span.range()].iter();
            out.caches.extend(caches.map(|cache| ContactCache { pair: index, ..cache.clone() }));
            return;
        }
        let (pair, start) = (&self.pairs.all[index as usize], out.contacts.len());
        let mut touches = std::mem::take(&mut out.touches);
        touches.clear();
        self.touch(pair, self.reach.margin(pair.bodies) + pair.near, &mut touches);
        for touch in &touches {
            self.add(index, pair, touch, start, out);
        }
        out.touches = touches;
        self.hand_on(span, start, out);
    }

    /// Searches for contacts with gaps below `margin`.
    fn touch(&self, pair: &Pair, margin: f64, touches: &mut Vec<Touch>) {
        let (a, b) = pair.pieces;
        match (pair.kind, self.pieces.half_plane(b)) {
            (Kind::Discs, _) => touches.extend(collide::of_discs(self.pieces, (a, b), margin)),
            (_, Some(plane)) => collide::against_half_plane(&self.pieces.view(a), plane, margin, touches),
            _ => {
                let bounds = |piece: u32| &self.pieces.bounds[piece as usize];
                if bounds(a).distance(bounds(b)) <= margin {
                    collide::between(&self.pieces.view(a), &self.pieces.view(b), margin, touches);
                }
            }
        }
    }

    /// Adds a point to the contacts of the pair, which begin at `start`.
    fn add(&self, index: u32, pair: &Pair, touch: &Touch, start: usize, out: &mut ContactSet) {
        let frames = self.frames.both(pair.bodies);
        let fitting = out.contacts[start..].iter().position(|contact| contact.has_room(touch.normal));
        let place = fitting.map_or(out.contacts.len(), |place| start + place);
        if place == out.contacts.len() {
            out.contacts.push(Contact::new(pair.bodies, touch.normal, pair.rolling_arm));
            out.caches.push(ContactCache::new((index, pair.wall), pair.surface, touch, frames));
        }
        out.contacts[place].add(touch, &mut out.caches[place], frames);
    }

    /// Initialises the contacts from `start` on with the impulses of the same points in the last search.
    fn hand_on(&self, span: Span, start: usize, out: &mut ContactSet) {
        if span.count == 0 {
            return;
        }
        let known = if span.frozen { self.frozen } else { self.last };
        let scale = if span.frozen { self.dt * self.dt } else { 1.0 };
        let (contacts, caches) = (&known.contacts[span.range()], &known.caches[span.range()]);
        for (contact, cache) in out.contacts[start..].iter_mut().zip(&out.caches[start..]) {
            let near = 5.0 * self.pairs.all[cache.pair as usize].near;
            keep((contact, cache), (contacts, caches), near, scale);
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
