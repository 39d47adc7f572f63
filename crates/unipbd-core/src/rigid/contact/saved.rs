//! Contacts and joints from a saved state: what the scene decides is kept from the run, what a run changes is checked.

use super::{Contacts, Islands, Jacobi, Joint, JointKind, Linked};
use crate::rigid::Bodies;

impl Contacts {
    /// These contacts at the moment of a saved state; `None` if the state makes no sense.
    pub(crate) fn at_saved(&self, saved: Contacts, bodies: &Bodies) -> Option<Contacts> {
        let alike = |(mine, saved): (&Linked, &Linked)| is_like(&mine.joint, &saved.joint) && saved.is_finite();
        let joined = self.joints.len() == saved.joints.len() && self.joints.iter().zip(&saved.joints).all(alike);
        let walls = [&saved.wall_impulses, &saved.wall_forces];
        let walled = walls.iter().all(|column| column.len() == self.wall_impulses.len());
        let finite = walls.into_iter().flatten().all(|vector| vector.is_finite());
        // Impulses are scaled by its square.
        let timed = saved.dt == 0.0 || (1e-12..1e6).contains(&saved.dt);
        if !(joined && walled && finite && timed) {
            return None;
        }
        let mut jacobi = Jacobi::default();
        jacobi.parallelism = self.jacobi.parallelism;
        Some(Contacts {
            narrow_phase: self.narrow_phase.at_saved(saved.narrow_phase, bodies)?,
            joints: saved.joints,
            islands: Islands::from_saved(saved.islands, bodies.len()),
            jacobi,
            split: Vec::new(),
            scaled: Vec::new(),
            counts: Vec::new(),
            corrections: Vec::new(),
            wall_impulses: saved.wall_impulses,
            wall_forces: saved.wall_forces,
            backward: saved.backward,
            dt: saved.dt,
            settings: self.settings,
            solver: self.solver.clone(),
            warm_factor: self.warm_factor,
            gravity: self.gravity,
            up: self.up,
        })
    }
}

/// Whether both join the same bodies at the same places. The speed of a motor may differ.
fn is_like(mine: &Joint, saved: &Joint) -> bool {
    let kinds = match (&mine.kind, &saved.kind) {
        (JointKind::Hinge { .. }, JointKind::Hinge { motor }) => {
            motor.is_none_or(|motor| motor.speed.is_finite() && !motor.max_torque.is_nan())
        }
        (mine, saved) => mine == saved,
    };
    kinds && *mine == Joint { kind: mine.kind, ..*saved }
}
