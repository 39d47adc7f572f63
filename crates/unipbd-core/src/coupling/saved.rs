//! Bodies from a saved state, which may hold others than the run: some came, changed or went since.

use super::{Carried, RigidBodies, Tied, near};
use crate::rigid::{Bodies, Elasticity};
use std::borrow::Cow;

impl RigidBodies {
    /// These bodies as a state holds them: contacts have the impulses of their lanes.
    pub(crate) fn to_save(&self) -> Cow<'_, RigidBodies> {
        if !self.contacts.lacks_impulses() {
            return Cow::Borrowed(self);
        }
        let mut whole = self.clone();
        whole.contacts.note_impulses();
        Cow::Owned(whole)
    }

    /// These bodies at the moment of a saved state; `None` if the state is of another scene or makes no sense.
    pub(crate) fn at_saved(&self, saved: RigidBodies, spacing: f64) -> Option<RigidBodies> {
        let same = self.bodies.has_specs_of(&saved.bodies) && self.sample_ids == saved.sample_ids;
        let base = if same { None } else { Some(self.with_bodies_of(&saved, spacing)?) };
        let base = base.as_ref().unwrap_or(self);
        let bodies = base.bodies.at_saved(saved.bodies)?;
        let contacts = base.contacts.at_saved(saved.contacts, &bodies)?;
        let joints = contacts.joint_count();
        let tied = |tied: &Tied| (tied.body as usize) < bodies.len() && tied.place.is_finite();
        let carried = |carried: &Carried| (carried.joint as usize) < joints;
        if !(saved.tied.iter().all(tied) && saved.carried.iter().all(carried)) {
            return None;
        }
        Some(RigidBodies { bodies, contacts, tied: saved.tied, carried: saved.carried, ..base.clone() })
    }

    /// The bodies that a state holds, where they started.
    fn with_bodies_of(&self, saved: &RigidBodies, spacing: f64) -> Option<RigidBodies> {
        let bodies = self.bodies.with_saved_specs(&saved.bodies)?;
        if saved.sample_ids.len() != bodies.len() {
            return None;
        }
        let counted = saved.sample_ids.iter().zip(bodies.views()).all(|(&(first, end), view)| {
            let count = if self.seen { view.samples.len() as u32 } else { 0 };
            first.checked_add(count) == Some(end) || (self.outlines && first == end)
        });
        let mut ids: Vec<(u32, u32)> = saved.sample_ids.iter().copied().filter(|(first, end)| first < end).collect();
        ids.sort_unstable();
        let apart = ids.windows(2).all(|two| two[0].1 <= two[1].0);
        // Bodies that are particles neither come nor go.
        let soft = |bodies: &Bodies, ids: &[(u32, u32)]| -> Vec<(usize, Elasticity, (u32, u32))> {
            let of = |id: usize| bodies.elasticity(id).map(|how| (id, how, ids[id]));
            (0..bodies.len()).filter_map(of).collect()
        };
        if !(counted && apart && soft(&bodies, &saved.sample_ids) == soft(&self.bodies, &self.sample_ids)) {
            return None;
        }
        let near = bodies.views().iter().map(|body| near(body, self.seen, spacing)).collect();
        let mut rigid = RigidBodies { bodies, near, sample_ids: saved.sample_ids.clone(), ..self.clone() };
        rigid.find_met();
        Some(rigid)
    }
}
