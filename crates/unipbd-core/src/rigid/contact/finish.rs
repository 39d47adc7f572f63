//! The end of a substep: rebounds, loads, and the removal of overlap.

use super::Contacts;
use super::bounds::NONE;
use super::lanes::Rule;
use super::push::Push;
use super::seen;
use super::sweep::{Order, Sweep, turn_joints};
use crate::rigid::Bodies;

impl Contacts {
    /// Applies restitution to contacts with an impact speed above that of gravity in two substeps, and adds the
    /// impulses of the substep to the loads of bodies and walls.
    pub fn restitute(&mut self, bodies: &mut Bodies) {
        let slowest = 2.0 * self.gravity * self.dt;
        if self.in_lanes() {
            self.rebounding = false;
            return self.load_lanes(bodies);
        }
        self.note_impulses();
        let mut rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches());
        self.rebounding =
            self.narrow_phase.is_elastic() && rows.any(|(contact, cache)| contact.rebounds(cache, slowest));
        if self.rebounding {
            self.rebound(bodies, slowest);
        }
        self.load(bodies);
    }

    fn rebound(&mut self, bodies: &mut Bodies, slowest: f64) {
        let (dt, (contacts, caches)) = (self.dt, self.narrow_phase.rows());
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

    /// Adds the impulses of the substep to the bodies and walls they act on.
    fn load(&mut self, bodies: &mut Bodies) {
        let (dt, rebounding, watching) = (self.dt, self.rebounding, self.watch.is_on());
        let rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches());
        for (contact, cache) in rows.filter(|(contact, _)| contact.is_pressed()) {
            let push = if rebounding { contact.total_push(cache, dt) } else { contact.steady_push(dt) };
            if watching {
                self.watch.add(contact, cache.wall, push.linear);
            }
            bodies.contact_loads[contact.a as usize] += push.on_a();
            if contact.b != NONE {
                bodies.contact_loads[contact.b as usize] -= push.on_b();
            } else if cache.wall != NONE {
                self.wall_impulses[cache.wall as usize] -= push.linear;
            }
        }
        self.load_joints(bodies);
    }

    /// The same of contacts in lanes, whose loads are added with the removal of overlap.
    fn load_lanes(&mut self, bodies: &mut Bodies) {
        if self.watch.is_on() {
            self.note_impulses();
            let rows = self.narrow_phase.contacts().iter().zip(self.narrow_phase.caches());
            for (contact, cache) in rows.filter(|(contact, _)| contact.is_pressed()) {
                self.watch.add(contact, cache.wall, contact.steady_push(self.dt).linear);
            }
        }
        self.load_joints(bodies);
    }

    fn load_joints(&mut self, bodies: &mut Bodies) {
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
        self.corrections.clone_from(&bodies.displacements);
        if self.solver.at_once() || self.rebounding {
            self.separate(bodies);
        } else {
            self.separate_in_lanes(bodies);
        }
        for ((pose, moved), before) in bodies.poses.iter_mut().zip(&self.corrections).zip(&bodies.displacements) {
            pose.position += moved.linear - before.linear;
            pose.angle += moved.angular - before.angular;
        }
    }

    fn separate_in_lanes(&mut self, bodies: &Bodies) {
        self.blocks.take_motion(&self.corrections);
        let rule = Rule::Separate(self.settings.depenetration, self.fall());
        if self.in_lanes() {
            self.blocks.load_and_separate((self.dt, self.wall_impulses.len()), rule);
        } else {
            self.blocks.pass(rule);
        }
        self.blocks.give_motion(&mut self.corrections);
        let (poses, displacements) = (&bodies.poses, &bodies.displacements);
        turn_joints(&mut self.joints, &bodies.inverse_masses, &mut self.corrections, |linked, motion| {
            linked.separate(poses, displacements, motion)
        });
    }

    /// Contact by contact: points that rebounded go as far as they have flown.
    fn separate(&mut self, bodies: &Bodies) {
        let (how, fall, sizes, rebounding) =
            (&self.settings.depenetration, self.fall(), &bodies.sizes, self.rebounding);
        let order = if self.solver.at_once() { Order::AtOnce(&mut self.jacobi) } else { Order::InTurn };
        let (rows, joints) = (self.narrow_phase.rows(), &mut self.joints[..]);
        let masses = seen(&self.scaled, &bodies.inverse_masses);
        let (poses, displacements) = (&bodies.poses, &bodies.displacements);
        Sweep { order, rows, joints, masses, motion: &mut self.corrections }.run(
            |contact, cache, motion| {
                let size = sizes[contact.a as usize];
                let size = if contact.b == NONE { size } else { size.min(sizes[contact.b as usize]) };
                let flown = if rebounding { cache.rebound.map(|rebound| rebound.flown) } else { [0.0; 2] };
                contact.separate(flown, motion, how, size, fall)
            },
            |linked, motion| linked.separate(poses, displacements, motion),
        );
    }

    /// Twice the gravity times the square of the substep \[m].
    fn fall(&self) -> f64 {
        2.0 * self.moment.fall()
    }
}
