//! The contacts of a search, and the substep of the search.

use super::collide::{FeaturePair, Touch};
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::pairs::{Pair, SearchRecord};
use super::pieces::Pieces;

/// Contacts by pair.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct ContactSet {
    pub contacts: Vec<Contact>,
    pub caches: Vec<ContactCache>,
    /// Pairs that were searched again, with the record of the search.
    #[serde(skip)]
    pub renewed: Vec<(u32, SearchRecord)>,
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
    pub gravity: f64,
    /// Scale factor of the impulses of the last substep in this one.
    pub kept: f64,
    /// Sliding speed below which a contact sticks [m/s].
    pub slow: f64,
}

/// The contacts of a substep with their cache data, row by row.
pub(crate) type Rows<'a> = (&'a mut [Contact], &'a mut [ContactCache]);

impl ContactSet {
    /// Whether the contacts of a saved state are those of these pairs.
    pub fn is_sound(&self, pieces: &Pieces, pairs: &[Pair]) -> bool {
        let sound = |(contact, cache): (&Contact, &ContactCache)| {
            pairs.get(cache.pair as usize).is_some_and(|pair| {
                let first = pieces.view(pair.pieces.0).vertices.len();
                let second = pieces.half_plane(pair.pieces.1).is_none();
                let second = second.then(|| pieces.view(pair.pieces.1).vertices.len());
                let fits = |feature: &FeaturePair| feature.fits(first, second);
                contact.is_sound(pair.bodies)
                    && cache.wall == pair.wall
                    && cache.is_finite()
                    && cache.features[..contact.points().len()].iter().all(fits)
            })
        };
        self.contacts.len() == self.caches.len() && self.contacts.iter().zip(&self.caches).all(sound)
    }

    pub fn clear(&mut self) {
        self.contacts.clear();
        self.caches.clear();
        self.renewed.clear();
    }

    pub fn append(&mut self, other: &mut ContactSet) {
        self.contacts.append(&mut other.contacts);
        self.caches.append(&mut other.caches);
        self.renewed.append(&mut other.renewed);
    }

    /// Removes contacts beyond this number.
    pub fn truncate(&mut self, length: usize) {
        self.contacts.truncate(length);
        self.caches.truncate(length);
    }
}
