//! Mass scaling (Macklin et al. 2014, equation 21): m* = m exp(-k h), for contacts alone.
//!
//! The height h counts from the lowest support of a heap (its contact with an immovable body or wall; without such
//! a place, from its lowest body), so that the factor does not depend on where the heap stands.

use crate::math::Vector64;
use crate::rigid::contact::{Contact, entry};
use crate::rigid::{Bodies, InverseMass};
use crate::union_find::UnionFind;

/// Limit of the mass scale. Larger scales would drown impulses in rounding.
const LARGEST: f64 = 1e6;

/// Writes the inverse masses that contacts see, exp(k h) times those of the bodies.
pub(super) fn scale(contacts: &[Contact], bodies: &Bodies, up: Vector64, k: f64, out: &mut Vec<InverseMass>) {
    let heap = heaps(contacts, bodies);
    let mut support = vec![f64::INFINITY; bodies.len()];
    for contact in contacts {
        let (a, b) = (contact.a as usize, contact.b as usize);
        let fixed = |id: usize| entry(&bodies.inverse_masses, id as u32) == InverseMass::default();
        let resting = if fixed(b) {
            a
        } else if fixed(a) {
            b
        } else {
            continue;
        };
        for point in contact.points() {
            let height = (bodies.poses[a].position + contact.arm_a(point)).dot(up);
            support[heap[resting]] = support[heap[resting]].min(height);
        }
    }
    let mut lowest = vec![f64::INFINITY; bodies.len()];
    for (id, pose) in bodies.poses.iter().enumerate() {
        lowest[heap[id]] = lowest[heap[id]].min(pose.position.dot(up));
    }
    out.clear();
    out.extend(bodies.inverse_masses.iter().enumerate().map(|(id, response)| {
        let base = if support[heap[id]].is_finite() { support[heap[id]] } else { lowest[heap[id]] };
        let height = (bodies.poses[id].position.dot(up) - base).max(0.0);
        let factor = libm::exp(k * height).min(LARGEST);
        InverseMass { linear: response.linear * factor, angular: response.angular * factor }
    }));
}

/// The heap of each body, named by its lowest member: bodies that touch each other and can move.
fn heaps(contacts: &[Contact], bodies: &Bodies) -> Vec<usize> {
    let mut touching = UnionFind::default();
    touching.reset(bodies.len());
    let movable = |id: u32| entry(&bodies.inverse_masses, id) != InverseMass::default();
    for contact in contacts.iter().filter(|contact| movable(contact.a) && movable(contact.b)) {
        touching.unite(contact.a, contact.b);
    }
    (0..bodies.len() as u32).map(|id| touching.root(id) as usize).collect()
}
