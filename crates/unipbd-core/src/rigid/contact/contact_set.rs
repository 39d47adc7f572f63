//! The contacts of a search, and the substep of the search.

use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::pairs::Pair;
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
}

/// Parameters of a substep for the search.
#[derive(Clone, Copy)]
pub(super) struct StepContext {
    /// Its length [s].
    pub dt: f64,
    /// Gravity [m/s^2].
    pub gravity: Vector64,
    /// Sliding speed below which a contact sticks [m/s].
    pub slow: f64,
}

/// The contacts of a substep with their cache data, row by row.
pub(crate) type Rows<'a> = (&'a mut [Contact], &'a mut [ContactCache]);

impl ContactSet {
    /// Whether the contacts of a saved state are those of these pairs. Their features serve for comparison alone.
    pub fn is_sound(&self, pairs: &[Pair]) -> bool {
        let sound = |(contact, cache): (&Contact, &ContactCache)| {
            pairs
                .get(cache.pair as usize)
                .is_some_and(|pair| contact.is_sound(pair.bodies) && cache.wall == pair.wall && cache.is_finite())
        };
        self.contacts.len() == self.caches.len() && self.contacts.iter().zip(&self.caches).all(sound)
    }

    pub fn clear(&mut self) {
        self.contacts.clear();
        self.caches.clear();
    }

    pub fn append(&mut self, other: &mut ContactSet) {
        self.contacts.append(&mut other.contacts);
        self.caches.append(&mut other.caches);
    }
}
