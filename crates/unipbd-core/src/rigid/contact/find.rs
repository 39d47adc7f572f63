//! Finds the contacts of each substep and hands on the impulses of the last one.
//!
//! What touches (which vertex over which face) is sought anew only where the pieces of a pair have moved: until
//! then the same places are measured again, which is exact. Discs are always measured.

use super::manifold::{Contact, Site};
use super::narrow_phase::Touch;
use super::pairs::{Pairs, Sought, Span};
use super::pieces::Pieces;
use super::search::Search;
use crate::rigid::Bodies;
use crate::rigid::Wall;
use rayon::prelude::*;

/// Pairs per task, and how many pairs make tasks worth their while.
const CHUNK: usize = 512;
const PARALLEL_FROM: usize = 2048;

/// The contacts of all bodies.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Finder {
    pieces: Pieces,
    pairs: Pairs,
    found: Found,
    /// What the coming substep finds.
    coming: Found,
    /// Contacts between sleeping bodies, kept until they wake: with forces in place of impulses.
    frozen: Found,
    /// What each task of the narrow phase found.
    #[serde(skip)]
    tasks: Vec<Found>,
}

/// Contacts by pair.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Found {
    pub contacts: Vec<Contact>,
    pub sites: Vec<Site>,
    /// Pairs that were sought anew, and what that was with.
    #[serde(skip)]
    pub renewed: Vec<(u32, Sought)>,
    /// Room for the search.
    #[serde(skip)]
    pub touches: Vec<Touch>,
}

/// A substep, as the search sees it.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    /// Its length [s].
    pub dt: f64,
    /// Gravity [m/s^2].
    pub gravity: f64,
    /// What the impulses of the last substep are worth in this one.
    pub kept: f64,
    /// What slides slower than this sticks [m/s].
    pub slow: f64,
}

/// The contacts of a substep with what belongs to them, row by row.
pub(super) type Rows<'a> = (&'a mut [Contact], &'a mut [Site]);

impl Finder {
    pub fn new(walls: &[Wall]) -> Finder {
        Finder { pieces: Pieces::of_walls(walls), ..Finder::default() }
    }

    pub fn contacts(&self) -> &[Contact] {
        &self.found.contacts
    }

    pub fn sites(&self) -> &[Site] {
        &self.found.sites
    }

    pub fn rows(&mut self) -> Rows<'_> {
        (&mut self.found.contacts, &mut self.found.sites)
    }

    /// Two bodies that no longer collide with each other.
    pub fn exclude(&mut self, a: u32, b: u32) {
        self.pairs.exclude(a, b);
    }

    /// Finds all contacts that can act in a substep, with the impulses of the last one. They are
    /// [`Finder::candidates`] until they are adopted.
    pub fn find(&mut self, bodies: &Bodies, moment: &Moment) {
        let added = self.pieces.append_bodies(bodies);
        self.pairs.renumber(&self.pieces, added);
        self.pieces.update(bodies);
        self.pairs.update(&self.pieces, bodies, moment.dt, moment.gravity);
        self.collide(bodies, moment);
    }

    /// What was found.
    pub fn candidates(&self) -> &[Contact] {
        &self.coming.contacts
    }

    /// Ends the search: what was found are the contacts.
    pub fn adopt(&mut self) {
        std::mem::swap(&mut self.found, &mut self.coming);
        for (pair, sought) in self.found.renewed.drain(..) {
            self.pairs.sought[pair as usize] = sought;
        }
        for active in &self.pairs.active {
            self.pairs.spans[active.index as usize] = Span::default();
        }
        for (site, index) in self.found.sites.iter().zip(0u32..) {
            let span = &mut self.pairs.spans[site.pair as usize];
            if span.count == 0 {
                span.first = index;
            }
            span.count += 1;
        }
    }

    /// Keeps the contacts of sleeping pairs aside, with forces in place of impulses.
    pub fn freeze(&mut self, bodies: &Bodies, dt: f64) {
        let mut frozen = Found::default();
        for (pair, span) in self.pairs.all.iter().zip(&mut self.pairs.spans) {
            let active = |body: u32| bodies.asleep.get(body as usize).is_some() && bodies.is_active(body as usize);
            if active(pair.bodies.0) || active(pair.bodies.1) || span.count == 0 {
                continue;
            }
            let start = frozen.contacts.len();
            let known = if span.frozen { &self.frozen } else { &self.found };
            frozen.contacts.extend_from_slice(&known.contacts[span.range()]);
            frozen.sites.extend_from_slice(&known.sites[span.range()]);
            if !span.frozen {
                frozen.contacts[start..].iter_mut().for_each(|contact| contact.scale_impulses(1.0 / (dt * dt)));
            }
            (span.first, span.frozen) = (start as u32, true);
        }
        self.frozen = frozen;
    }

    /// The narrow phase over all active pairs; contacts come in the order of the pairs.
    fn collide(&mut self, bodies: &Bodies, moment: &Moment) {
        let (mut coming, mut tasks) = (std::mem::take(&mut self.coming), std::mem::take(&mut self.tasks));
        coming.clear();
        let (pieces, pairs, last, frozen) = (&self.pieces, &self.pairs, &self.found, &self.frozen);
        let search = Search { pieces, pairs, bodies, moment, last, frozen };
        let active = &pairs.active;
        if active.len() < PARALLEL_FROM || rayon::current_num_threads() == 1 {
            active.iter().for_each(|pair| search.pair(pair.index, &mut coming));
        } else {
            tasks.resize_with(tasks.len().max(active.len().div_ceil(CHUNK)), Found::default);
            tasks.par_iter_mut().zip(active.par_chunks(CHUNK)).for_each(|(task, pairs)| {
                pairs.iter().for_each(|pair| search.pair(pair.index, task));
            });
            tasks.iter_mut().for_each(|task| coming.append(task));
        }
        (self.tasks, self.coming) = (tasks, coming);
    }
}

impl Found {
    fn clear(&mut self) {
        self.contacts.clear();
        self.sites.clear();
        self.renewed.clear();
    }

    fn append(&mut self, other: &mut Found) {
        self.contacts.append(&mut other.contacts);
        self.sites.append(&mut other.sites);
        self.renewed.append(&mut other.renewed);
    }

    /// Forgets contacts beyond so many.
    pub fn truncate(&mut self, length: usize) {
        self.contacts.truncate(length);
        self.sites.truncate(length);
    }
}
