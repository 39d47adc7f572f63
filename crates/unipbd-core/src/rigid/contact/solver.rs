//! Interface of the contact solver: the exchangeable computation of contact pushes.

use super::linked::Linked;
use super::manifold::Contact;
use super::sweep::Sweep;
use crate::math::Vector64;
use crate::rigid::{Bodies, InverseMass};

/// A method to compute the pushes of contacts. Search, joints, rebound and depenetration are common to all methods.
pub(crate) trait ContactSolver: Send + Sync {
    /// Whether all contacts act from one state, with the mass of a body split among them.
    fn at_once(&self) -> bool;

    /// Fraction of the impulses of the last substep for warm starting, 0 to 1.
    fn kept(&self) -> f64 {
        1.0
    }

    /// One iteration of all contacts and joints on the displacements of the substep, where they act at once.
    fn sweep(&self, sweep: Sweep<'_>) {
        sweep.run(|contact, _, displacements| contact.solve(displacements, 1.0), Linked::solve);
    }

    /// Writes the inverse masses for contacts, if they differ from those of the bodies.
    fn scale_masses(&self, contacts: &[Contact], bodies: &Bodies, up: Vector64, out: &mut Vec<InverseMass>) {
        let _ = (contacts, bodies, up, out);
    }
}

/// Gauss-Seidel: each contact sees the pushes of those before it.
pub(crate) struct InTurn;

impl ContactSolver for InTurn {
    fn at_once(&self) -> bool {
        false
    }
}

/// Split Jacobi (Tonge et al. 2012): the mass of a body is split among its contacts.
pub(crate) struct Split;

impl ContactSolver for Split {
    fn at_once(&self) -> bool {
        true
    }
}
