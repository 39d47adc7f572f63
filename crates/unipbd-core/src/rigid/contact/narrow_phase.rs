//! Finds contacts and transfers the impulses of the last substep.
//!
//! Contacts are searched once per frame, and within a frame again where a body leaves its prediction. In each substep
//! their gaps and arms are measured at the poses of the bodies.

use super::blocks::Blocks;
use super::bounds::NONE;
use super::contact_block::Exact;
use super::contact_cache::ContactCache;
use super::contact_set::{ContactSet, Found, Rows};
use super::frames::Frames;
use super::manifold::Contact;
use super::pair::Touching;
use super::pair_contacts::PairContacts;
use super::pairs::{Pairs, Span};
use super::pieces::Pieces;
use super::reach::Reach;
use super::step_context::StepContext;
use crate::math::Vector64;
use crate::parallel::Parallelism;
use crate::rigid::{Bodies, Wall};
use crate::scene::FrictionRule;
use rayon::prelude::*;
use std::ops::Range;

/// Pairs per task, and the minimum number of pairs for parallel tasks.
const CHUNK: usize = 512;
const PARALLEL_FROM: usize = 2048;

/// The contacts of all bodies.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct NarrowPhase {
    pieces: Pieces,
    /// Those of the walls alone.
    #[serde(skip)]
    walls: Pieces,
    pub pairs: Pairs,
    reach: Reach,
    #[serde(skip)]
    frames: Frames,
    pub found: ContactSet,
    /// Whether a contact can rebound.
    #[serde(skip)]
    elastic: bool,
    /// Buffer of the search.
    #[serde(skip)]
    pub coming: ContactSet,
    /// Contacts between sleeping bodies, kept until they wake: they store forces in place of impulses.
    frozen: ContactSet,
    /// Contacts found by each task of the narrow phase.
    #[serde(skip)]
    tasks: Vec<ContactSet>,
    /// Where the search may run: set by the run, never saved.
    #[serde(skip)]
    pub parallelism: Parallelism,
}

impl NarrowPhase {
    pub fn new(walls: &[Wall], rule: FrictionRule) -> NarrowPhase {
        let walls = Pieces::of_walls(walls, rule);
        NarrowPhase { pieces: walls.clone(), walls, ..NarrowPhase::default() }
    }

    pub fn contacts(&self) -> &[Contact] {
        &self.found.contacts
    }

    pub fn caches(&self) -> &[ContactCache] {
        &self.found.caches
    }

    pub fn rows(&mut self) -> Rows<'_> {
        (&mut self.found.contacts, &mut self.found.caches)
    }

    /// The search of a saved state, between the pieces of this one; `None` if the state makes no sense.
    pub fn at_saved(&self, saved: NarrowPhase, bodies: &Bodies) -> Option<NarrowPhase> {
        // Bodies may have come and gone since.
        let pieces = self.walls.at_saved(&saved.pieces, bodies)?;
        let mut pairs = self.pairs.at_saved(saved.pairs, &pieces, bodies)?;
        let walls = pieces.walls();
        if ![&saved.found, &saved.frozen].into_iter().all(|set| set.is_sound(bodies.len(), walls)) {
            return None;
        }
        let mut active = pairs.active.iter().map(|active| active.index).peekable();
        let mut claimed = vec![false; saved.found.contacts.len()];
        for (span, index) in pairs.spans.iter_mut().zip(0u32..) {
            let is_active = active.next_if_eq(&index).is_some();
            let set = if span.frozen { &saved.frozen } else { &saved.found };
            let whole = set.is_of(span, &pairs.all[index as usize], &pieces);
            if !whole && (is_active || span.frozen) {
                return None;
            }
            if !whole {
                *span = Span::default();
            }
            // Each contact belongs to one pair.
            if is_active
                && !span.frozen
                && claimed[span.range()].iter_mut().any(|claimed| std::mem::replace(claimed, true))
            {
                return None;
            }
        }
        let (found, frozen, parallelism) = (saved.found, saved.frozen, self.parallelism);
        let reach = saved.reach.at_saved(bodies.len())?;
        let walls = self.walls.clone();
        let elastic = found.is_elastic();
        Some(NarrowPhase { pieces, walls, pairs, reach, found, elastic, frozen, parallelism, ..NarrowPhase::default() })
    }

    /// Disables collisions between these pairs of bodies, and enables all others.
    pub fn exclude_only(&mut self, pairs: Vec<(u32, u32)>) {
        if self.pairs.exclude_only(pairs) {
            self.reach.restart();
        }
    }

    /// Bodies were added, changed, moved or taken away between two frames: pieces are made anew, and the contacts of
    /// pairs that are left keep their impulses.
    pub fn rebuild(&mut self, bodies: &Bodies) {
        let old = std::mem::replace(&mut self.pieces, self.walls.clone());
        self.pieces.append_bodies(bodies);
        let places = old.places_in(&self.pieces);
        let kept = self.pairs.rebuild(&places, &self.pieces, bodies);
        let (found, frozen) = (std::mem::take(&mut self.found), std::mem::take(&mut self.frozen));
        for (span, index) in self.pairs.spans.iter_mut().zip(0u32..).filter(|(span, _)| span.count > 0) {
            let (from, to) = match span.frozen {
                true => (&frozen, &mut self.frozen),
                false => (&found, &mut self.found),
            };
            let start = to.contacts.len() as u32;
            to.contacts.extend_from_slice(&from.contacts[span.range()]);
            let surface = Touching::of(&self.pieces, &self.pairs.all[index as usize]).surface;
            let caches = from.caches[span.range()].iter();
            to.caches.extend(caches.map(|cache| ContactCache { surface, ..*cache }));
            span.first = start;
        }
        debug_assert!(kept == self.pairs.all.len());
        self.reach.restart();
    }

    /// Begins a frame of this length \[s].
    pub fn begin_frame(&mut self, frame: f64) {
        self.reach.begin_frame(frame);
    }

    /// Whether a contact can rebound.
    pub fn is_elastic(&self) -> bool {
        self.elastic
    }

    /// Evaluates the poses of a substep; whether bodies must be searched before it.
    pub fn wants(&mut self, bodies: &Bodies, moment: &StepContext) -> bool {
        let added = self.pieces.append_bodies(bodies);
        self.pairs.renumber(&self.pieces, added);
        self.frames.update(bodies);
        let marked = self.reach.mark(bodies, moment.dt, moment.gravity.length());
        self.pairs.note_woken(bodies, &mut self.reach) | marked
    }

    /// Finds the pairs that may touch until the end of the frame; whether bodies have begun or ceased to move.
    pub fn find_pairs(&mut self, bodies: &Bodies, moment: &StepContext) -> bool {
        self.pieces.update(bodies, &self.frames);
        self.pairs.update(&self.pieces, bodies, &mut self.reach, moment.gravity.length())
    }

    /// Searches the contacts of the bodies that need it, with the impulses of the last substep, and orders all by pair.
    pub fn search(&mut self, moment: &StepContext) {
        self.collide(0..self.pairs.active.len(), moment.last_dt, None);
        self.adopt();
    }

    /// Centre of mass, cosine and sine of the angle of all bodies; the last row is the world.
    pub fn places(&self) -> &[Exact] {
        &self.frames.places
    }

    /// Measures all contacts at the poses of the search.
    pub fn measure(&mut self) {
        let (rows, frames) = ((&mut self.found.contacts[..], &mut self.found.caches[..]), &self.frames);
        each(rows, self.parallelism, |contact, cache| contact.measure(cache, frames.both((contact.a, contact.b))));
    }

    /// Opens a substep contact by contact: measures all, scales their impulses by `kept`, and prepares them. Their rows
    /// go to `and_then`, in order.
    pub fn open(&mut self, bodies: &Bodies, (moment, kept): (&StepContext, f64), mut and_then: impl FnMut(&[Contact])) {
        let (frames, active) = (&self.frames, |body: u32| body != NONE && bodies.is_active(body as usize));
        let pull = |body: u32| if active(body) { bodies.pull(body as usize, moment.gravity) } else { Vector64::ZERO };
        let open = |contact: &mut Contact, cache: &mut ContactCache| {
            contact.age(cache, kept);
            contact.measure(cache, frames.both((contact.a, contact.b)));
            if cache.surface.restitution > 0.0 {
                cache.pull = (pull(contact.a) - pull(contact.b)).dot(contact.normal);
            }
            contact.note_velocities(cache, &bodies.velocities, moment);
            contact.prepare(&bodies.inverse_masses);
        };
        let ContactSet { contacts, caches, .. } = &mut self.found;
        if is_parallel(contacts, self.parallelism) {
            each((contacts, caches), self.parallelism, open);
            and_then(contacts);
            return;
        }
        // The contacts just prepared are still near the processor.
        for (contacts, caches) in contacts.chunks_mut(CHUNK).zip(caches.chunks_mut(CHUNK)) {
            contacts.iter_mut().zip(caches).for_each(|(contact, cache)| open(contact, cache));
            and_then(contacts);
        }
    }

    /// Ends a substep of this length \[s].
    pub fn pass(&mut self, dt: f64) {
        self.reach.pass(dt);
    }

    /// Ends the search: the contacts found replace the current ones.
    fn adopt(&mut self) {
        std::mem::swap(&mut self.found, &mut self.coming);
        self.elastic = self.found.elastic;
        let mut first = 0;
        for &Found { pair, count, searched } in &self.found.found {
            self.pairs.spans[pair as usize] = Span { first, count, frozen: false, searched };
            first += count;
        }
    }

    /// The contacts of sleeping pairs: they store forces in place of impulses.
    pub fn frozen(&self) -> impl Iterator<Item = (&Contact, &ContactCache)> {
        let spans = if self.frozen.contacts.is_empty() { &[][..] } else { &self.pairs.spans[..] };
        let rows = spans.iter().filter(|span| span.frozen).flat_map(Span::range);
        rows.map(|row| (&self.frozen.contacts[row], &self.frozen.caches[row]))
    }

    /// Stores the contacts of sleeping pairs, with forces in place of impulses.
    pub fn freeze(&mut self, bodies: &Bodies, dt: f64) {
        let mut frozen = ContactSet::default();
        for (pair, span) in self.pairs.all.iter().zip(&mut self.pairs.spans) {
            let active = |body: u32| bodies.asleep.get(body as usize).is_some() && bodies.is_active(body as usize);
            if active(pair.bodies.0) || active(pair.bodies.1) || span.count == 0 {
                continue;
            }
            let start = frozen.contacts.len();
            let known = if span.frozen { &self.frozen } else { &self.found };
            frozen.contacts.extend_from_slice(&known.contacts[span.range()]);
            frozen.caches.extend_from_slice(&known.caches[span.range()]);
            if !span.frozen {
                frozen.contacts[start..].iter_mut().for_each(|contact| contact.scale_impulses(1.0 / (dt * dt)));
            }
            (span.first, span.frozen) = (start as u32, true);
        }
        self.frozen = frozen;
    }

    /// Whether the search is worth several threads.
    pub fn is_parallel(&self) -> bool {
        self.pairs.active.len() >= PARALLEL_FROM && self.parallelism != Parallelism::Serial
    }

    /// The narrow phase over these active pairs; contacts come in the order of the pairs, with the impulses of a substep of
    /// length `dt`, but for those that stay.
    pub fn collide(&mut self, range: Range<usize>, dt: f64, staying: Option<&Blocks>) {
        let is_parallel = self.is_parallel();
        let (mut coming, mut tasks) = (std::mem::take(&mut self.coming), std::mem::take(&mut self.tasks));
        coming.clear();
        let (pieces, pairs, last, frozen) = (&self.pieces, &self.pairs, &self.found, &self.frozen);
        let (reach, frames) = (&self.reach, &self.frames);
        let search = PairContacts { pieces, pairs, reach, frames, dt, last, frozen, staying };
        let active = &pairs.active[range];
        if !is_parallel {
            active.iter().for_each(|pair| search.pair(pair, &mut coming));
        } else {
            tasks.resize_with(tasks.len().max(active.len().div_ceil(CHUNK)), ContactSet::default);
            tasks.par_iter_mut().zip(active.par_chunks(CHUNK)).for_each(|(task, pairs)| {
                pairs.iter().for_each(|pair| search.pair(pair, task));
            });
            tasks.iter_mut().for_each(|task| coming.append(task));
        }
        (self.tasks, self.coming) = (tasks, coming);
    }
}

/// Applies a rule to each contact on its own.
fn each((contacts, caches): Rows<'_>, parallelism: Parallelism, rule: impl Fn(&mut Contact, &mut ContactCache) + Sync) {
    if is_parallel(contacts, parallelism) {
        let rows = contacts.par_chunks_mut(CHUNK).zip(caches.par_chunks_mut(CHUNK));
        rows.for_each(|(contacts, caches)| contacts.iter_mut().zip(caches).for_each(|(c, cache)| rule(c, cache)));
    } else {
        contacts.iter_mut().zip(caches).for_each(|(contact, cache)| rule(contact, cache));
    }
}

fn is_parallel(contacts: &[Contact], parallelism: Parallelism) -> bool {
    contacts.len() >= PARALLEL_FROM && parallelism != Parallelism::Serial
}
