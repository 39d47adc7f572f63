//! A Jacobi sweep over contacts: each contact computes its push from the same state into its own slot, then
//! each body sums its pushes in the order of the contacts. The result is bitwise equal for any number of threads.

use super::bounds::NONE;
use super::contact_cache::ContactCache;
use super::manifold::Contact;
use super::push::Push;
use crate::parallel::Parallelism;
use crate::rigid::{InverseMass, Twist};
use rayon::prelude::*;

/// Below this many contacts a sweep is faster on one thread.
const PARALLEL_FROM: usize = 6000;
const CHUNK: usize = 1024;

/// Buffers of the sweeps.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Jacobi {
    /// Sum of the pushes of the last sweep, by body.
    pub sums: Vec<Twist>,
    pushes: Vec<Push>,
    /// Contacts of body k: `slots[starts[k]..starts[k + 1]]`, each as 2 x contact + side.
    starts: Vec<u32>,
    slots: Vec<u32>,
    /// Where sweeps may run: set by the run, never saved.
    #[serde(skip)]
    pub parallelism: Parallelism,
}

impl Jacobi {
    /// Lists the contacts of each body, if sweeps run in parallel.
    pub fn index(&mut self, contacts: &[Contact], bodies: usize) {
        if !self.is_parallel(contacts) {
            return;
        }
        self.starts.clear();
        self.starts.resize(bodies + 1, 0);
        let sides = || contacts.iter().zip(0u32..).flat_map(|(c, k)| [(c.a, 2 * k), (c.b, 2 * k + 1)]);
        for (body, _) in sides().filter(|&(body, _)| body != NONE) {
            self.starts[body as usize + 1] += 1;
        }
        for k in 0..bodies {
            self.starts[k + 1] += self.starts[k];
        }
        self.slots.resize(self.starts[bodies] as usize, 0);
        for (body, slot) in sides().filter(|&(body, _)| body != NONE) {
            let next = &mut self.starts[body as usize];
            self.slots[*next as usize] = slot;
            *next += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Evaluates `rule` for every contact from one state, then sums the pushes by body.
    pub fn sweep(
        &mut self,
        (contacts, caches): (&mut [Contact], &mut [ContactCache]),
        bodies: usize,
        rule: impl Fn(&mut Contact, &mut ContactCache) -> Push + Sync,
    ) {
        self.sums.clear();
        self.sums.resize(bodies, Twist::ZERO);
        if !self.is_parallel(contacts) {
            for (contact, cache) in contacts.iter_mut().zip(caches) {
                let push = rule(contact, cache);
                self.sums[contact.a as usize] += push.on_a();
                if contact.b != NONE {
                    self.sums[contact.b as usize] -= push.on_b();
                }
            }
            return;
        }
        self.pushes.resize(contacts.len(), Push::default());
        let rows = contacts.par_chunks_mut(CHUNK).zip(caches.par_chunks_mut(CHUNK));
        rows.zip(self.pushes.par_chunks_mut(CHUNK)).for_each(|((contacts, caches), pushes)| {
            for ((contact, cache), push) in contacts.iter_mut().zip(caches).zip(pushes) {
                *push = rule(contact, cache);
            }
        });
        self.gather();
    }

    fn is_parallel(&self, contacts: &[Contact]) -> bool {
        self.parallelism == Parallelism::Pool && contacts.len() >= PARALLEL_FROM
    }

    fn gather(&mut self) {
        let (starts, slots, pushes) = (&self.starts, &self.slots, &self.pushes);
        self.sums.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(|(body, sum)| {
            for &slot in &slots[starts[body] as usize..starts[body + 1] as usize] {
                let push = &pushes[slot as usize / 2];
                if slot % 2 == 0 {
                    *sum += push.on_a();
                } else {
                    *sum -= push.on_b();
                }
            }
        });
    }

    /// Adds the motion by the summed pushes.
    pub fn apply(&self, inverse_masses: &[InverseMass], motion: &mut [Twist]) {
        for ((motion, push), response) in motion.iter_mut().zip(&self.sums).zip(inverse_masses) {
            motion.linear += push.linear * response.linear;
            motion.angular += push.angular * response.angular;
        }
    }
}
