//! A search that leaves the contacts of a large heap where they are: those that come lie behind all others, until so many
//! have come and gone that all are ordered anew.

use super::anchored::Anchored;
use super::blocks::{Blocks, sum_up, take};
use super::bounds::NONE;
use super::contact_block::Block;
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::narrow_phase::NarrowPhase;
use super::pairs::Span;
use crate::rigid::Bodies;
use crate::simd::wide::WIDE;

/// Contacts from which on they stay: fewer are ordered in no time.
const STAY_FROM: usize = 512;
/// Part of the contacts that come or go between two orderings.
const CHANGES: f64 = 0.25;
/// Pairs that are searched before their contacts go into lanes.
const NEAR: usize = 64;

impl Blocks {
    /// Whether so many contacts of so many bodies may stay.
    pub fn may_stay(&self, contacts: usize, bodies: usize) -> bool {
        contacts >= STAY_FROM
            && self.slots.len() == contacts
            && self.bodies as usize == bodies
            && f64::from(self.changes) <= CHANGES * contacts as f64
    }

    /// Orders all contacts in the next search.
    pub fn disband(&mut self) {
        self.slots.clear();
    }

    /// Whether lanes are known from a saved state, but not made.
    pub fn is_to_be_laid_out(&self) -> bool {
        self.holders.is_empty() && !self.slots.is_empty()
    }

    /// Makes the lanes of a saved state.
    pub fn lay_out_saved(&mut self, contacts: &[Contact], caches: &[ContactCache], bodies: &Bodies) {
        let held = || self.slots.iter().zip(0u32..).filter(|(slot, _)| **slot != NONE);
        let count = held().map(|(slot, _)| *slot as usize / WIDE + 1).max().unwrap_or(0);
        let mut holders = vec![[NONE; WIDE]; count.max(self.ordered as usize)];
        held().for_each(|(&slot, number)| holders[slot as usize / WIDE][slot as usize % WIDE] = number);
        self.holders = holders;
        self.lay_out(bodies.len());
        self.take(contacts, caches, &bodies.inverse_masses, &bodies.sizes);
    }

    /// Whether the lanes of a saved state can be those of these contacts.
    pub fn is_sound(&self, contacts: &[Contact]) -> bool {
        let held = |(slot, contact): (&u32, &Contact)| (*slot != NONE) == (contact.a != NONE);
        let mut slots: Vec<u32> = self.slots.iter().copied().filter(|slot| *slot != NONE).collect();
        slots.sort_unstable();
        let distinct = slots.windows(2).all(|two| two[0] < two[1]);
        let near = slots.last().is_none_or(|slot| (*slot as usize) < WIDE * contacts.len());
        let all = self.slots.len() == contacts.len() && self.slots.iter().zip(contacts).all(held);
        distinct && near && self.ordered as usize <= contacts.len() && (self.slots.is_empty() || all)
    }

    /// A contact has other places on its bodies.
    fn place(&mut self, number: usize, cache: &ContactCache) {
        let (at, lane) = self.slot(number);
        self.anchored[at].place(lane, cache);
    }

    /// A contact in the place of one of the same bodies.
    fn renew(&mut self, number: usize, contact: &Contact, cache: &ContactCache, bodies: &Bodies) {
        let (at, lane) = self.slot(number);
        let (block, anchored) = (&mut self.all[at], &mut self.anchored[at]);
        take((block, anchored), lane, (contact, cache), (&bodies.inverse_masses, &bodies.sizes));
        sum_up((block, anchored), &self.holders[at]);
    }

    /// A contact behind all that were ordered.
    fn add(&mut self, contact: &Contact, cache: &ContactCache, bodies: &Bodies) {
        let moved = |body: u32| body != NONE && bodies.is_dynamic(body as usize);
        let holds = |block: &Block, body: u32| moved(body) && block.bodies.iter().any(|side| side.contains(&body));
        let has_room = |at: &usize| {
            let block = &self.all[*at];
            self.holders[*at].contains(&NONE) && !holds(block, contact.a) && !holds(block, contact.b)
        };
        let at = (self.ordered as usize..self.all.len()).find(has_room).unwrap_or_else(|| {
            self.all.push(Block::idle(bodies.len()));
            self.anchored.push(Anchored::default());
            self.holders.push([NONE; WIDE]);
            self.all.len() - 1
        });
        let lane = self.holders[at].iter().position(|holder| *holder == NONE).expect("there is room");
        self.holders[at][lane] = self.slots.len() as u32;
        self.slots.push((WIDE * at + lane) as u32);
        self.changes += 1;
        self.renew(self.slots.len() - 1, contact, cache, bodies);
    }

    /// Frees the lane of a contact that is over.
    fn remove(&mut self, number: usize, bodies: &Bodies) {
        let (at, lane) = self.slot(number);
        self.holders[at][lane] = NONE;
        self.renew(number, &Contact::over(), &ContactCache::over(), bodies);
        self.slots[number] = NONE;
        self.changes += 1;
    }
}

impl NarrowPhase {
    /// Searches the contacts of the bodies that need it; the others stay in their lanes. `false` if one can rebound: then
    /// all are to be searched.
    pub fn search_in_place(&mut self, blocks: &mut Blocks, bodies: &Bodies, last_dt: f64) -> bool {
        for span in std::mem::take(&mut self.pairs.dropped) {
            self.end(&span, blocks, bodies);
        }
        let count = self.pairs.active.len();
        // The contacts just found are still near the processor.
        let chunk = if self.is_parallel() { count } else { NEAR };
        (0..count).step_by(chunk.max(1)).all(|first| {
            self.collide(first..count.min(first + chunk), last_dt, Some(blocks));
            let steady = !self.coming.elastic;
            if steady {
                self.adopt_in_place(blocks, bodies);
            }
            steady
        })
    }

    fn adopt_in_place(&mut self, blocks: &mut Blocks, bodies: &Bodies) {
        let coming = std::mem::take(&mut self.coming);
        for moved in &coming.moved {
            let span = &mut self.pairs.spans[moved.pair as usize];
            span.searched = moved.searched;
            let cache = &mut self.found.caches[span.first as usize];
            (cache.normal, cache.anchors) = (moved.normal, moved.anchors);
            blocks.place(span.first as usize, cache);
        }
        let mut rows = coming.contacts.iter().zip(&coming.caches);
        for of_pair in &coming.found {
            let old = self.pairs.spans[of_pair.pair as usize];
            let mut span = Span { count: of_pair.count, searched: of_pair.searched, ..old };
            if old.count != span.count {
                self.end(&old, blocks, bodies);
                span.first = self.found.contacts.len() as u32;
            }
            for (number, (contact, cache)) in span.range().zip(&mut rows) {
                if old.count == span.count {
                    (self.found.contacts[number], self.found.caches[number]) = (*contact, *cache);
                    blocks.renew(number, contact, cache, bodies);
                } else {
                    self.found.contacts.push(*contact);
                    self.found.caches.push(*cache);
                    blocks.add(contact, cache, bodies);
                }
            }
            self.pairs.spans[of_pair.pair as usize] = span;
        }
        self.coming = coming;
    }

    /// Ends the contacts of a pair.
    fn end(&mut self, span: &Span, blocks: &mut Blocks, bodies: &Bodies) {
        for number in span.range() {
            (self.found.contacts[number], self.found.caches[number]) = (Contact::over(), ContactCache::over());
            blocks.remove(number, bodies);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector64;
    use crate::rigid::contact::ContactSettings;
    use crate::rigid::contact::Contacts;
    use crate::rigid::{BodySpec, Pose, Surface, Wall};
    use crate::shapes::Shape;

    const DT: f64 = 1.0 / 120.0;
    const GRAVITY: Vector64 = Vector64::new(0.0, -9.81);

    /// Boxes and discs in columns over a floor, which come down on each other.
    fn heap(settings: ContactSettings) -> (Bodies, Contacts) {
        let floor = Wall::half_plane(Vector64::ZERO, Vector64::Y, Surface::with_friction(0.5));
        let (mut bodies, contacts) = (Bodies::new(0.1), Contacts::new(&[floor], settings));
        for k in 0..600 {
            let (column, row) = (f64::from(k % 60), f64::from(k / 60));
            let corners = [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)];
            let square = Shape::Polygon(corners.map(|(x, y)| Vector64::new(x, y)).to_vec());
            let shape = if k % 7 == 0 { Shape::Disc { radius: 0.2 } } else { square };
            let position = Vector64::new(0.42 * column + 0.15 * (row % 2.0), 0.2 + 0.45 * row);
            let pose = Pose { position, angle: 0.01 * f64::from(k % 5) };
            bodies.add(BodySpec { pose, ..BodySpec::new(shape) }).unwrap();
        }
        (bodies, contacts)
    }

    /// The rest of a substep whose contacts were found.
    fn finish(contacts: &mut Contacts, bodies: &mut Bodies, number: u32) {
        bodies.predict(DT, 0.0, GRAVITY);
        contacts.warm_start(bodies);
        contacts.iterate(bodies);
        bodies.integrate(DT);
        contacts.restitute(bodies);
        contacts.depenetrate(bodies);
        if number % 2 == 1 {
            contacts.finish_frame(bodies, 2.0 * DT);
            bodies.finish_frame(2.0 * DT);
        }
    }

    /// Bodies, features and impulses of all contacts, in order.
    fn list(contacts: &mut Contacts) -> Vec<(u32, u32, Vec<(u32, f64)>)> {
        contacts.note_impulses();
        let (found, caches) = (contacts.narrow_phase.contacts(), contacts.narrow_phase.caches());
        let points = |(contact, cache): (&Contact, &ContactCache)| {
            let pairs = cache.features.into_iter().zip(contact.points().iter().map(|point| point.normal_impulse));
            (contact.a, contact.b, pairs.collect::<Vec<_>>())
        };
        let mut list: Vec<_> =
            found.iter().zip(caches).map(points).filter(|(_, _, points)| !points.is_empty()).collect();
        list.sort_by(|one, other| one.partial_cmp(other).expect("impulses are numbers"));
        list
    }

    #[test]
    fn contacts_that_stay_are_those_of_a_search_that_orders_all() {
        let (mut bodies, mut contacts) = heap(ContactSettings::default());
        let (mut stayed, mut most) = (0, 0);
        for number in 0..120 {
            let (mut other_bodies, mut ordered) = (bodies.clone(), contacts.clone());
            ordered.note_impulses();
            ordered.blocks.disband();
            contacts.begin_substep(&mut bodies, DT, GRAVITY);
            ordered.begin_substep(&mut other_bodies, DT, GRAVITY);
            if contacts.blocks.changes > 0 {
                stayed += 1;
            }
            most = most.max(contacts.blocks.changes);
            assert_eq!(list(&mut contacts), list(&mut ordered), "substep {number}");
            for (slot, contact) in contacts.blocks.slots.iter().zip(contacts.narrow_phase.contacts()) {
                assert_eq!(*slot == NONE, contact.points().is_empty());
                if *slot != NONE {
                    let (block, lane) = (&contacts.blocks.all[*slot as usize / WIDE], *slot as usize % WIDE);
                    let others = (0..WIDE).filter(|other| *other != lane);
                    let here = [block.bodies[0][lane], block.bodies[1][lane]];
                    assert_eq!(here, [contact.a, contact.b.min(bodies.len() as u32)]);
                    for other in others {
                        let there = [block.bodies[0][other], block.bodies[1][other]];
                        let idle = bodies.len() as u32;
                        assert!(there.iter().all(|body| *body == idle || !here.contains(body)), "substep {number}");
                    }
                }
            }
            finish(&mut contacts, &mut bodies, number);
        }
        println!("{stayed} searches in place, {most} contacts came or went between two orderings at most");
        assert!(stayed > 60 && most > 20);
    }

    #[test]
    fn contacts_that_only_lanes_know_are_read_as_if_they_had_been_noted() {
        let (mut bodies, mut contacts) = heap(ContactSettings { sleep: None, ..ContactSettings::default() });
        for number in 0..40 {
            contacts.begin_substep(&mut bodies, DT, GRAVITY);
            finish(&mut contacts, &mut bodies, number);
        }
        assert!(contacts.lacks_impulses());
        let mut noted = contacts.clone();
        noted.note_impulses();
        let read = |contacts: &Contacts| contacts.points().collect::<Vec<_>>();
        assert!(read(&contacts).iter().any(|point| point.normal_force > 0.0));
        assert_eq!(read(&contacts), read(&noted));
        assert!(contacts.linked().eq(noted.linked()));
        assert!(contacts.linked().count() > 100);
    }
}
