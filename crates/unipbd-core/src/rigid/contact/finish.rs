//! The end of a substep: rebounds, loads, and the removal of overlap.

use super::Contacts;
use super::bounds::NONE;
use super::push::Push;
use super::seen;
use super::sweep::{Order, Sweep};
use crate::rigid::Bodies;

impl Contacts {
    /// Applies restitution to contacts with an impact speed above that of gravity in two substeps, and adds the
    /// impulses of the substep to the loads of bodies and walls.
    pub fn restitute(&mut self, bodies: &mut Bodies) {
        let (dt, slowest) = (self.dt, 2.0 * self.gravity * self.dt);
        let mut rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches());
        if rows.any(|(contact, cache)| contact.rebounds(cache, slowest)) {
            let (contacts, caches) = self.narrow_phase.rows();
            for (contact, cache) in contacts.iter().zip(caches).filter(|(c, cache)| c.rebounds(cache, slowest)) {
                contact.begin_rebound(cache, dt, slowest);
            }
            for _ in 0..self.settings.restitution_iterations {
                let order = if self.solver.at_once() { Order::AtOnce(&mut self.jacobi) } else { Order::InTurn };
                let masses = seen(&self.scaled, &bodies.inverse_masses);
                let (rows, joints) = (self.narrow_phase.rows(), &mut [][..]);
                Sweep { order, rows, joints, masses, motion: &mut bodies.velocities }.contacts(
                    |contact, cache, velocities| {
                        if contact.rebounds(cache, slowest) {
                            contact.rebound(cache, velocities, dt, slowest)
                        } else {
                            Push::default()
                        }
                    },
                );
            }
        }
        self.load(bodies);
    }

    /// Adds the impulses of the substep to the bodies and walls they act on.
    fn load(&mut self, bodies: &mut Bodies) {
        let rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches());
        for (contact, cache) in rows.filter(|(contact, _)| contact.is_pressed()) {
            let push = contact.total_push(cache, self.dt);
            self.watch.add(contact, cache.wall, push.linear);
            bodies.contact_loads[contact.a as usize] += push.on_a();
            if contact.b != NONE {
                bodies.contact_loads[contact.b as usize] -= push.on_b();
            }
            if cache.wall != NONE {
                self.wall_impulses[cache.wall as usize] -= push.linear;
            }
        }
        for linked in self.joints.iter_mut().filter(|linked| linked.is_live()) {
            linked.load();
            let ((a, b), (on_a, on_b)) = (linked.bodies(), linked.kept_pushes());
            bodies.contact_loads[a as usize] += on_a.scaled(1.0 / self.dt);
            if b != NONE {
                bodies.contact_loads[b as usize] -= on_b.scaled(1.0 / self.dt);
            }
        }
    }

    /// Removes overlap from the positions, without changing any velocity.
    pub fn depenetrate(&mut self, bodies: &mut Bodies) {
        let (how, fall) = (&self.settings.depenetration, 2.0 * self.gravity * self.dt * self.dt);
        let sizes = &bodies.sizes;
        let at_once = self.solver.at_once();
        self.corrections.clone_from(&bodies.displacements);
        let order = if at_once { Order::AtOnce(&mut self.jacobi) } else { Order::InTurn };
        let (rows, joints) = (self.narrow_phase.rows(), &mut self.joints[..]);
        let masses = seen(&self.scaled, &bodies.inverse_masses);
        let (poses, displacements) = (&bodies.poses, &bodies.displacements);
        Sweep { order, rows, joints, masses, motion: &mut self.corrections }.run(
            |contact, cache, motion| {
                let size = sizes[contact.a as usize];
                let size = if contact.b == NONE { size } else { size.min(sizes[contact.b as usize]) };
                contact.separate(cache, motion, how, size, fall)
            },
            |linked, motion| linked.separate(poses, displacements, motion),
        );
        for ((pose, moved), before) in bodies.poses.iter_mut().zip(&self.corrections).zip(&bodies.displacements) {
            pose.position += moved.linear - before.linear;
            pose.angle += moved.angular - before.angular;
        }
    }
}
