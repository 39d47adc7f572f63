//! Bodies woken, and the search begun anew, from outside of a frame.

use super::Contacts;
use super::bounds::NONE;
use crate::rigid::Bodies;

impl Contacts {
    /// Bodies were added, changed, moved or taken away between two frames.
    pub(crate) fn bodies_changed(&mut self, bodies: &mut Bodies) {
        self.islands.resize(bodies.len());
        self.islands.wake_pushed(bodies);
        self.note_impulses();
        self.narrow_phase.rebuild(bodies);
        self.blocks.disband();
    }

    /// Wakes the bodies that touch this one, and those that sleep with it.
    pub(crate) fn wake_neighbors(&mut self, bodies: &mut Bodies, body: u32) {
        self.islands.resize(bodies.len());
        let frozen = self.narrow_phase.frozen().map(|(contact, _)| (contact.a, contact.b));
        let found = self.narrow_phase.contacts().iter().map(|contact| (contact.a, contact.b));
        let near: Vec<u32> = frozen
            .chain(found)
            .filter(|&(a, b)| b != NONE && (a == body || b == body))
            .flat_map(|(a, b)| [a, b])
            .collect();
        for id in near.into_iter().chain([body]).filter(|&id| bodies.asleep[id as usize]).collect::<Vec<_>>() {
            self.islands.wake_island(bodies, id as usize);
        }
    }

    /// Wakes all bodies.
    pub(crate) fn wake_all(&mut self, bodies: &mut Bodies) {
        self.islands.resize(bodies.len());
        for id in 0..bodies.len() {
            if bodies.asleep[id] {
                self.islands.wake_island(bodies, id);
            }
        }
    }

    /// Wakes a body with its island.
    pub fn wake(&mut self, bodies: &mut Bodies, body: u32) {
        self.islands.resize(bodies.len());
        if bodies.asleep[body as usize] {
            self.islands.wake_island(bodies, body as usize);
        }
    }
}
