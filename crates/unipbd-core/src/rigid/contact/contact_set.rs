//! The contacts of a search.

use super::bounds::NONE;
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::pair::Pair;
use super::pairs::{Searched, Span};
use super::pieces::Pieces;
use super::touch::Touch;
use crate::math::Vector64;

/// Contacts by pair.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct ContactSet {
    pub contacts: Vec<Contact>,
    pub caches: Vec<ContactCache>,
    /// Buffer of the search.
    #[serde(skip)]
    pub touches: Vec<Touch>,
    /// Contacts of a pair in the last search: a buffer.
    #[serde(skip)]
    pub known: Vec<Contact>,
    /// Results of the search, pair by pair.
    #[serde(skip)]
    pub found: Vec<Found>,
    /// Contacts that stay, but with other places on their bodies.
    #[serde(skip)]
    pub moved: Vec<Moved>,
    /// Whether a contact can rebound, as the search finds it.
    #[serde(skip)]
    pub elastic: bool,
}

/// Result of the search for a pair: the number of its contacts, and how its bodies lie.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub pair: u32,
    pub count: u32,
    pub searched: Searched,
}

/// The place of a contact whose vertices touch as in the last search.
#[derive(Clone, Copy)]
pub(super) struct Moved {
    pub pair: u32,
    pub searched: Searched,
    /// As of [`ContactCache`].
    pub normal: Vector64,
    pub anchors: [(Vector64, Vector64); 2],
}

/// The contacts of a substep with their cache data, row by row.
pub(crate) type Rows<'a> = (&'a mut [Contact], &'a mut [ContactCache]);

impl ContactSet {
    /// Whether the contacts of a saved state can be some of so many bodies and walls. Their features serve for
    /// comparison alone.
    pub fn is_sound(&self, bodies: usize, walls: usize) -> bool {
        let known = |index: u32, count: usize| index == NONE || (index as usize) < count;
        let sound = |(contact, cache): (&Contact, &ContactCache)| {
            let over = contact.a == NONE && contact.b == NONE && contact.points().is_empty();
            contact.is_sound()
                && cache.is_finite()
                && known(cache.wall, walls)
                && (over || (contact.a as usize) < bodies && known(contact.b, bodies))
        };
        self.contacts.len() == self.caches.len() && self.contacts.iter().zip(&self.caches).all(sound)
    }

    /// Whether the contacts of a span are those of this pair.
    pub fn is_of(&self, span: &Span, pair: &Pair, pieces: &Pieces) -> bool {
        span.fits(self.contacts.len())
            && self.contacts[span.range()].iter().all(|contact| (contact.a, contact.b) == pair.bodies)
            && self.caches[span.range()].iter().all(|cache| cache.wall == pair.wall(pieces))
    }

    /// Whether one of them can rebound.
    pub fn is_elastic(&self) -> bool {
        self.caches.iter().any(|cache| cache.surface.restitution > 0.0)
    }

    pub fn clear(&mut self) {
        self.contacts.clear();
        self.caches.clear();
        self.found.clear();
        self.moved.clear();
        self.elastic = false;
    }

    pub fn append(&mut self, other: &mut ContactSet) {
        self.contacts.append(&mut other.contacts);
        self.caches.append(&mut other.caches);
        self.found.append(&mut other.found);
        self.moved.append(&mut other.moved);
        self.elastic |= std::mem::take(&mut other.elastic);
    }
}
