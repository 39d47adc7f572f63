//! The contacts of a search.

use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::pairs::{Pair, Searched};
use super::pieces::Pieces;
use super::touch::Touch;

/// Contacts by pair.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct ContactSet {
    pub contacts: Vec<Contact>,
    pub caches: Vec<ContactCache>,
    /// Buffer of the search.
    #[serde(skip)]
    pub touches: Vec<Touch>,
    /// The number of contacts of each pair of the search, and how its bodies lie.
    #[serde(skip)]
    pub spans: Vec<(u32, Searched)>,
    /// Whether a contact can rebound, as the search finds it.
    #[serde(skip)]
    pub elastic: bool,
}

/// The contacts of a substep with their cache data, row by row.
pub(crate) type Rows<'a> = (&'a mut [Contact], &'a mut [ContactCache]);

impl ContactSet {
    /// Whether the contacts of a saved state are those of these pairs. Their features serve for comparison alone.
    pub fn is_sound(&self, pairs: &[Pair], pieces: &Pieces) -> bool {
        let sound = |(contact, cache): (&Contact, &ContactCache)| {
            pairs.get(cache.pair as usize).is_some_and(|pair| {
                contact.is_sound(pair.bodies) && cache.wall == pair.wall(pieces) && cache.is_finite()
            })
        };
        self.contacts.len() == self.caches.len() && self.contacts.iter().zip(&self.caches).all(sound)
    }

    /// Whether one of them can rebound.
    pub fn is_elastic(&self) -> bool {
        self.caches.iter().any(|cache| cache.surface.restitution > 0.0)
    }

    pub fn clear(&mut self) {
        self.contacts.clear();
        self.caches.clear();
        self.spans.clear();
        self.elastic = false;
    }

    pub fn append(&mut self, other: &mut ContactSet) {
        self.contacts.append(&mut other.contacts);
        self.caches.append(&mut other.caches);
        self.spans.append(&mut other.spans);
        self.elastic |= std::mem::take(&mut other.elastic);
    }
}
