//! How the pushes of contacts are found: the part of the contact solver that can be exchanged.

use super::contact_set::Rows;
use super::jacobi::Jacobi;
use super::manifold::Contact;
use crate::math::Vector64;
use crate::rigid::{Bodies, InverseMass, Twist};

/// A way to find the pushes of contacts. Search, splitting of masses, joints, rebound and depenetration are common to
/// all ways.
pub(crate) trait ContactSolver: Send + Sync {
    /// Part of the impulses of the last substep that the next one starts with, 0 to 1.
    fn kept(&self) -> f64;

    /// One iteration of all contacts on the displacements of the substep; the sums stay in `jacobi`.
    fn sweep(&self, jacobi: &mut Jacobi, rows: Rows<'_>, displacements: &[Twist]);

    /// Writes the inverse masses that contacts see, if they are not those of the bodies.
    fn scale_masses(&self, contacts: &[Contact], bodies: &Bodies, up: Vector64, out: &mut Vec<InverseMass>) {
        let _ = (contacts, bodies, up, out);
    }
}

/// Split Jacobi (Tonge et al. 2012): impulses last from substep to substep, friction holds without creep.
pub(crate) struct Split;

impl ContactSolver for Split {
    fn kept(&self) -> f64 {
        1.0
    }

    fn sweep(&self, jacobi: &mut Jacobi, rows: Rows<'_>, displacements: &[Twist]) {
        jacobi.sweep(rows, displacements.len(), |contact, _| contact.solve(displacements));
    }
}
