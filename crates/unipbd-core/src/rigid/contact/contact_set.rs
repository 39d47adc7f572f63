//! The contacts that a search found, and the substep that it searches for.

use super::collide::Touch;
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::pairs::SearchRecord;

/// Contacts by pair.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct ContactSet {
    pub contacts: Vec<Contact>,
    pub caches: Vec<ContactCache>,
    /// Pairs that were sought anew, and what that was with.
    #[serde(skip)]
    pub renewed: Vec<(u32, SearchRecord)>,
    /// Room for the search.
    #[serde(skip)]
    pub touches: Vec<Touch>,
}

/// A substep, as the search sees it.
#[derive(Clone, Copy)]
pub(super) struct StepContext {
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
pub(crate) type Rows<'a> = (&'a mut [Contact], &'a mut [ContactCache]);

impl ContactSet {
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

    /// Forgets contacts beyond so many.
    pub fn truncate(&mut self, length: usize) {
        self.contacts.truncate(length);
        self.caches.truncate(length);
    }
}
