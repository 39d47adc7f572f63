//! Interface of the contact solver: the exchangeable computation of contact pushes.

use super::contact_set::Rows;
use super::jacobi::Jacobi;
use super::manifold::Contact;
use crate::math::Vector64;
use crate::rigid::{Bodies, InverseMass, Twist};

/// A method to compute the pushes of contacts. Search, splitting of masses, joints, rebound and depenetration are
/// common to all methods.
pub(crate) trait ContactSolver: Send + Sync {
    /// Fraction of the impulses of the last substep for warm starting, 0 to 1.
    fn kept(&self) -> f64;

    /// One iteration of all contacts on the displacements of the substep; the sums stay in `jacobi`.
    fn sweep(&self, jacobi: &mut Jacobi, rows: Rows<'_>, displacements: &[Twist]);

    /// Writes the inverse masses for contacts, if they differ from those of the bodies.
    fn scale_masses(&self, contacts: &[Contact], bodies: &Bodies, up: Vector64, out: &mut Vec<InverseMass>) {
        let _ = (contacts, bodies, up, out);
    }
}

/// Split Jacobi (Tonge et al. 2012): impulses persist between substeps, friction holds without creep.
pub(crate) struct Split;

impl ContactSolver for Split {
    fn kept(&self) -> f64 {
        1.0
    }

    fn sweep(&self, jacobi: &mut Jacobi, rows: Rows<'_>, displacements: &[Twist]) {
        jacobi.sweep(rows, displacements.len(), |contact, _| contact.solve(displacements));
    }
}
