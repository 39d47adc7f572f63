//! Contacts and joints from a saved state: what the scene decides is kept from the run, what a run changes is checked.

use super::joint_set::apart;
use super::{Contacts, Islands, Jacobi, JointKind, Limits, Linked};
use crate::rigid::Bodies;

impl Contacts {
    /// These contacts at the moment of a saved state; `None` if the state makes no sense.
    pub(crate) fn at_saved(&self, saved: Contacts, bodies: &Bodies) -> Option<Contacts> {
        let joined = saved.joints.iter().all(|linked| is_sound(linked, bodies));
        let walls = [&saved.wall_impulses, &saved.wall_forces];
        let walled = walls.iter().all(|column| column.len() == self.wall_impulses.len());
        let finite = walls.into_iter().flatten().all(|vector| vector.is_finite());
        // Impulses are scaled by its square.
        let in_lanes = saved.blocks.is_sound(saved.narrow_phase.contacts());
        let timed = saved.dt == 0.0 || (1e-12..1e6).contains(&saved.dt);
        if !(joined && walled && finite && in_lanes && timed) {
            return None;
        }
        let mut jacobi = Jacobi::default();
        jacobi.parallelism = self.jacobi.parallelism;
        Some(Contacts {
            narrow_phase: {
                let mut search = self.narrow_phase.clone();
                search.exclude_only(apart(&saved.joints));
                search.at_saved(saved.narrow_phase, bodies)?
            },
            joints: saved.joints,
            broke: Vec::new(),
            watch: self.watch.clone(),
            islands: Islands::from_saved(saved.islands, bodies.len()),
            jacobi,
            blocks: saved.blocks,
            split: Vec::new(),
            scaled: Vec::new(),
            counts: Vec::new(),
            corrections: Vec::new(),
            wall_impulses: saved.wall_impulses,
            wall_forces: saved.wall_forces,
            wall_names: self.wall_names.clone(),
            rebounding: false,
            backward: saved.backward,
            swept: 0,
            among_particles: self.among_particles,
            dt: saved.dt,
            settings: self.settings,
            once: self.once,
            solver: self.solver.clone(),
            moment: self.moment,
            warm_factor: self.warm_factor,
            gravity: self.gravity,
            up: self.up,
        })
    }
}

/// Whether a joint of a saved state makes sense between so many bodies.
fn is_sound(linked: &Linked, bodies: &Bodies) -> bool {
    let joint = &linked.joint;
    let known = |body: u32| bodies.views().get(body as usize).is_some_and(|body| !body.removed || linked.is_over());
    let limited = |limits: Option<Limits>| limits.is_none_or(|range| range.least <= range.most);
    let kind = match joint.kind {
        JointKind::Hinge { limits, .. } => limited(limits),
        JointKind::Distance { length, compliance, damping, .. } => {
            [length, compliance, damping].into_iter().all(|value| value >= 0.0 && value.is_finite())
        }
        JointKind::Weld { angle } => angle.is_finite(),
        JointKind::Slider { axis, angle, limits, .. } => {
            (axis.length_squared() - 1.0).abs() < 1e-6 && angle.is_finite() && limited(limits)
        }
        JointKind::Pulley { wheels, length, ratio } => {
            wheels.iter().all(|wheel| wheel.is_finite()) && length.is_finite() && ratio > 0.0 && ratio.is_finite()
        }
    };
    let apart = joint.other != Some(joint.body);
    let places = joint.anchor.is_finite() && joint.other_anchor.is_finite();
    kind && apart
        && places
        && known(joint.body)
        && joint.other.is_none_or(known)
        && joint.motor().is_none_or(|motor| motor.is_sound())
        && linked.is_finite()
}
