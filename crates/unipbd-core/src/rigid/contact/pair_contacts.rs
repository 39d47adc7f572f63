//! Contacts of one pair: measured again if the features are known, else searched by the narrow phase.

use super::collide::{self, FeaturePair, Proximity, Touch};
use super::contact_cache::ContactCache;
use super::contact_set::{ContactSet, StepContext};
use super::manifold::Contact;
use super::pairs::{Kind, Pair, Pairs, Relation, SearchRecord, Span};
use super::pieces::Pieces;
use crate::math::Vector64;
use crate::rigid::Bodies;

/// Input of the contact search of a pair.
pub(super) struct PairContacts<'a> {
    pub pieces: &'a Pieces,
    pub pairs: &'a Pairs,
    pub bodies: &'a Bodies,
    pub moment: &'a StepContext,
    /// Contacts of the last substep.
    pub last: &'a ContactSet,
    /// Contacts of sleeping bodies.
    pub frozen: &'a ContactSet,
}

impl PairContacts<'_> {
    /// Appends the contacts of a pair.
    pub fn pair(&self, index: u32, out: &mut ContactSet) {
        let pair = &self.pairs.all[index as usize];
        let margin = self.pairs.margin(pair);
        let start = out.contacts.len();
        match pair.kind {
            Kind::Discs => {
                if let Some(touch) = collide::discs(self.pieces, pair.pieces, margin) {
                    self.add(index, pair, &touch, start, out);
                }
            }
            Kind::DiscOnPlane => self.seek(index, pair, margin, out),
            Kind::OnPlane | Kind::Pieces => {
                let sought = &self.pairs.sought[index as usize];
                let way = Relation::of(pair.bodies, self.bodies).way(&sought.at, pair.bodies, self.bodies);
                let known = way <= sought.room && way + margin <= sought.margin;
                if known && self.measure(index, pair, out) {
                    return;
                }
                out.truncate(start);
                self.seek(index, pair, margin + pair.slack, out);
            }
        }
        self.hand_on(self.pairs.spans[index as usize], start, out);
    }

    /// Measures the features of the last substep. Returns whether they still form one valid contact.
    fn measure(&self, index: u32, pair: &Pair, out: &mut ContactSet) -> bool {
        let span = self.pairs.spans[index as usize];
        if span.count == 0 {
            return true;
        }
        if span.frozen {
            return false;
        }
        let (a, centers) = (self.pieces.view(pair.pieces.0), self.centers(pair));
        let plane = self.pieces.half_plane(pair.pieces.1);
        let measure = |feature: FeaturePair| match plane {
            Some(plane) => collide::again_on_half_plane(&a, plane, feature),
            None => collide::again(&a, &self.pieces.view(pair.pieces.1), feature),
        };
        for (old, known) in self.last.contacts[span.range()].iter().zip(&self.last.caches[span.range()]) {
            let first = measure(known.features[0]);
            let mut contact = Contact::new(pair.bodies, first.normal, pair.rolling_arm);
            contact.add(&first, centers);
            if old.points().len() == 2 {
                let second = measure(known.features[1]);
                if !contact.is_along(second.normal) {
                    return false;
                }
                contact.add(&second, centers);
            }
            let mut cache = ContactCache::new(index, pair.wall, pair.surface);
            cache.features = known.features;
            let rebounded = known.rebound != [0.0; 2];
            contact.rolling_impulse = if rebounded { 0.0 } else { old.rolling_impulse * self.moment.kept };
            for (k, (point, old)) in contact.points_mut().iter_mut().zip(old.points()).enumerate() {
                if known.rebound[k] == 0.0 {
                    point.keep(old, self.moment.kept);
                }
            }
            contact.note_velocities(&mut cache, &self.bodies.velocities, self.moment.slow);
            out.contacts.push(contact);
            out.caches.push(cache);
        }
        true
    }

    /// Searches for contacts with gaps below `margin`.
    fn seek(&self, index: u32, pair: &Pair, margin: f64, out: &mut ContactSet) {
        let mut touches = std::mem::take(&mut out.touches);
        touches.clear();
        let mut margin = margin;
        let room = match self.pieces.half_plane(pair.pieces.1) {
            Some(plane) => {
                collide::against_half_plane(&self.pieces.view(pair.pieces.0), plane, margin, &mut touches);
                f64::INFINITY
            }
            None => {
                let bounds = |piece: u32| &self.pieces.bounds[piece as usize];
                let apart = bounds(pair.pieces.0).distance(bounds(pair.pieces.1));
                let view = |piece: u32| self.pieces.view(piece);
                let proximity = if apart > margin {
                    margin = apart;
                    Proximity::Apart
                } else {
                    collide::between(&view(pair.pieces.0), &view(pair.pieces.1), margin, &mut touches)
                };
                match proximity {
                    Proximity::Apart => f64::INFINITY,
                    Proximity::Near => pair.slack,
                    Proximity::Overlapping => f64::NEG_INFINITY,
                }
            }
        };
        let start = out.contacts.len();
        for touch in &touches {
            self.add(index, pair, touch, start, out);
        }
        out.touches = touches;
        if pair.kind != Kind::DiscOnPlane {
            out.renewed.push((index, SearchRecord { at: Relation::of(pair.bodies, self.bodies), margin, room }));
        }
    }

    fn centers(&self, pair: &Pair) -> (Vector64, Vector64) {
        let center = |id: u32| self.bodies.poses.get(id as usize).map_or(Vector64::ZERO, |pose| pose.position);
        (center(pair.bodies.0), center(pair.bodies.1))
    }

    /// Adds a point to the contacts of the pair, which begin at `start`.
    fn add(&self, index: u32, pair: &Pair, touch: &Touch, start: usize, out: &mut ContactSet) {
        let fitting = out.contacts[start..].iter().position(|contact| contact.has_room(touch.normal));
        let place = fitting.map_or(out.contacts.len(), |place| start + place);
        if place == out.contacts.len() {
            out.contacts.push(Contact::new(pair.bodies, touch.normal, pair.rolling_arm));
            out.caches.push(ContactCache::new(index, pair.wall, pair.surface));
        }
        let contact = &mut out.contacts[place];
        out.caches[place].features[contact.points().len()] = touch.feature;
        contact.add(touch, self.centers(pair));
    }

    /// Initialises the contacts from `start` on with the impulses of their pair, and stores velocities.
    fn hand_on(&self, span: Span, start: usize, out: &mut ContactSet) {
        let known = if span.frozen { self.frozen } else { self.last };
        let scale = if span.frozen { self.moment.dt * self.moment.dt } else { self.moment.kept };
        let known = (&known.contacts[span.range()], &known.caches[span.range()]);
        for (contact, cache) in out.contacts[start..].iter_mut().zip(&mut out.caches[start..]) {
            if span.count > 0 {
                let near = self.pairs.all[cache.pair as usize].near;
                keep((contact, cache), known, 5.0 * near, scale);
            }
            contact.note_velocities(cache, &self.bodies.velocities, self.moment.slow);
        }
    }
}

/// Copies the impulses of the same points in the last substep to a contact: the same vertex, or else the
/// same position. After a rebound the old impulses are not used as an initial guess.
fn keep((contact, cache): (&mut Contact, &ContactCache), known: (&[Contact], &[ContactCache]), near: f64, scale: f64) {
    let old = || {
        let rows = known.0.iter().zip(known.1);
        rows.flat_map(|(contact, cache)| (0..contact.points().len()).map(move |k| (contact, cache, k)))
    };
    for k in 0..contact.points().len() {
        let arm = contact.arm_a(&contact.points()[k]);
        let named =
            |&(_, known, j): &(&Contact, &ContactCache, usize)| known.features[j].vertex == cache.features[k].vertex;
        let close = |&(contact, _, j): &(&Contact, &ContactCache, usize)| {
            (contact.arm_a(&contact.points()[j]) - arm).length_squared() < near * near
        };
        let same = old().find(named).or_else(|| old().find(close));
        if let Some((old, _, j)) = same.filter(|(_, cache, j)| cache.rebound[*j] == 0.0) {
            contact.points_mut()[k].keep(&old.points()[j], scale);
        }
    }
    let rebounded = known.1.iter().any(|cache| cache.rebound != [0.0; 2]);
    if let Some(first) = known.0.first().filter(|_| !rebounded) {
        contact.rolling_impulse = first.rolling_impulse * scale;
    }
}
