//! One pass over all contacts and joints that pushes bodies.

use super::bounds::NONE;
use super::contact_cache::ContactCache;
use super::contact_set::Rows;
use super::jacobi::Jacobi;
use super::linked::Linked;
use super::manifold::{Contact, entry};
use super::push::Push;
use crate::rigid::{InverseMass, Twist};

/// The order in which contacts see the pushes of each other.
pub(crate) enum Order<'a> {
    /// All from one state (Jacobi): the buffers of the sums.
    AtOnce(&'a mut Jacobi),
    /// One after the other (Gauss-Seidel), joints last.
    InTurn,
}

/// The input of a pass: motion of the bodies, and how they respond.
pub(crate) struct Sweep<'a> {
    pub order: Order<'a>,
    pub rows: Rows<'a>,
    pub joints: &'a mut [Linked],
    pub masses: &'a [InverseMass],
    pub motion: &'a mut [Twist],
}

impl Sweep<'_> {
    /// Evaluates the rules of contacts and joints, and moves the bodies.
    pub fn run(
        self,
        contact: impl Fn(&mut Contact, &mut ContactCache, &[Twist]) -> Push + Sync,
        joint: impl Fn(&mut Linked, &[Twist]) -> (Twist, Twist),
    ) {
        let Sweep { order, rows, joints, masses, motion } = self;
        match order {
            Order::AtOnce(jacobi) => {
                let seen: &[Twist] = motion;
                jacobi.sweep(rows, seen.len(), |row, cache| contact(row, cache, seen));
                for linked in joints.iter_mut() {
                    let (on_a, on_b) = joint(linked, seen);
                    let (a, b) = linked.bodies();
                    jacobi.sums[a as usize] += on_a;
                    if b != NONE {
                        jacobi.sums[b as usize] -= on_b;
                    }
                }
                jacobi.apply(masses, motion);
            }
            Order::InTurn => {
                for (row, cache) in rows.0.iter_mut().zip(rows.1) {
                    let push = contact(row, cache, motion);
                    apply((row.a, row.b), &push, masses, motion);
                }
                turn_joints(joints, masses, motion, joint);
            }
        }
    }

    /// The same for contacts alone.
    pub fn contacts(self, contact: impl Fn(&mut Contact, &mut ContactCache, &[Twist]) -> Push + Sync) {
        Sweep { joints: &mut [], ..self }.run(contact, |_, _| Default::default());
    }
}

/// Moves the bodies of joints, one after the other.
pub(super) fn turn_joints(
    joints: &mut [Linked],
    masses: &[InverseMass],
    motion: &mut [Twist],
    joint: impl Fn(&mut Linked, &[Twist]) -> (Twist, Twist),
) {
    for linked in joints {
        let (on_a, on_b) = joint(linked, motion);
        let (a, b) = linked.bodies();
        let none = Twist::ZERO;
        shift(motion, masses, a, &on_a, 1.0);
        shift(motion, masses, b, if b == NONE { &none } else { &on_b }, -1.0);
    }
}

/// Moves both bodies of a contact.
#[inline]
pub(super) fn apply((a, b): (u32, u32), push: &Push, masses: &[InverseMass], motion: &mut [Twist]) {
    shift(motion, masses, a, &push.on_a(), 1.0);
    if b != NONE {
        shift(motion, masses, b, &push.on_b(), -1.0);
    }
}

#[inline]
fn shift(motion: &mut [Twist], masses: &[InverseMass], body: u32, push: &Twist, sign: f64) {
    let response = entry(masses, body);
    if let Some(motion) = motion.get_mut(body as usize) {
        motion.linear += push.linear * (sign * response.linear);
        motion.angular += push.angular * (sign * response.angular);
    }
}
