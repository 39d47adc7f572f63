//! Contacts of bodies as in Macklin et al. 2014: averaged Jacobi on positions (section 4.2) with the friction of
//! equations 23 to 25, and mass scaling (equation 21).

use std::sync::Arc;

use super::mass_scaling;
use crate::math::Vector64;
use crate::rigid::contact::{Contact, ContactSettings, ContactSolver, Contacts, Linked, Push, Split, Sweep, entry};
use crate::rigid::{Bodies, InverseMass, Surface, Twist, Wall};
use crate::scene::LegacySettings;

/// No contacts yet, between bodies and these walls, solved as `legacy` says.
pub fn contacts(walls: &[Wall], settings: ContactSettings, legacy: &LegacySettings) -> Contacts {
    let relaxation = legacy.averaged_contacts.unwrap_or(settings.relaxation);
    let solver = LegacyContacts { averaged: legacy.averaged_contacts.is_some(), mass_scaling: legacy.mass_scaling };
    Contacts::new(walls, ContactSettings { relaxation, ..settings }).solved_by(Arc::new(solver))
}

struct LegacyContacts {
    /// Averaged Jacobi in place of split Jacobi: no impulse is kept from substep to substep.
    averaged: bool,
    /// k of equation 21 [1/m]; 0 for none.
    mass_scaling: f64,
}

impl ContactSolver for LegacyContacts {
    fn at_once(&self) -> bool {
        true
    }

    fn kept(&self) -> f64 {
        if self.averaged { 0.0 } else { Split.kept() }
    }

    fn sweep(&self, sweep: Sweep<'_>) {
        if self.averaged {
            sweep.run(|contact, cache, displacements| project(contact, &cache.surface, displacements), Linked::solve);
        } else {
            Split.sweep(sweep);
        }
    }

    fn scale_masses(&self, contacts: &[Contact], bodies: &Bodies, up: Vector64, out: &mut Vec<InverseMass>) {
        if self.mass_scaling > 0.0 {
            mass_scaling::scale(contacts, bodies, up, self.mass_scaling, out);
        }
    }
}

/// One iteration on the positions alone: removes the overlap, and the part of the relative sliding
/// that friction holds back for this depth.
fn project(contact: &mut Contact, surface: &Surface, displacements: &[Twist]) -> Push {
    let mut push = Push::default();
    let Some(pressed) = contact.press((entry(displacements, contact.a), entry(displacements, contact.b)), [0.0; 2])
    else {
        return push;
    };
    for k in 0..contact.points().len() {
        let normal = pressed.normal[k];
        let held = surface.held_back(contact.stop(k, &pressed), normal);
        contact.add_push(&mut push, &contact.points()[k], normal, -held);
        let point = &mut contact.points_mut()[k];
        point.normal_impulse += normal;
        point.tangent_impulse -= held;
    }
    if pressed.total() > 0.0 {
        contact.rolling_impulse = 0.0;
        contact.resist_rolling(&pressed, &mut push);
    }
    push
}
