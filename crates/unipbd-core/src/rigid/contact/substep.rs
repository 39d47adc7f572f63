//! A substep up to its iterations: search, warm start, sweeps.

use super::Contacts;
use super::bounds::NONE;
use super::lanes::Rule;
use super::linked::Linked;
use super::relaxation::Way;
use super::seen;
use super::step_context::StepContext;
use super::sweep::{Order, Sweep, apply, turn_joints};
use crate::math::Vector64;
use crate::rigid::{Bodies, InverseMass};

impl Contacts {
    /// Finds the contacts at the start of a substep and wakes the bodies that are touched.
    pub fn begin_substep(&mut self, bodies: &mut Bodies, dt: f64, gravity: Vector64) {
        // Impulses are forces times dt^2: the same force has a larger impulse in a longer substep.
        let last_dt = if self.dt > 0.0 { self.dt } else { dt };
        self.warm_factor = (dt / last_dt) * (dt / last_dt);
        self.dt = dt;
        self.backward = !self.backward;
        self.swept = 0;
        self.gravity = gravity.length();
        self.up = -gravity.normalize_or_zero();
        self.islands.resize(bodies.len());
        self.islands.wake_pushed(bodies);
        self.moment = StepContext { dt, last_dt, gravity, slow: 2.0 * self.gravity * dt };
        let mut found = self.search(bodies);
        while bodies.asleep.contains(&true) {
            self.narrow_phase.measure();
            if !self.islands.wake_touched(bodies, self.narrow_phase.contacts(), &self.joints, dt) {
                break;
            }
            found |= self.search(bodies);
        }
        let (contacts, caches) = (self.narrow_phase.contacts(), self.narrow_phase.caches());
        if !self.solver.at_once() && (found || !self.blocks.fits(contacts.len(), bodies.len())) {
            self.blocks.assign(contacts, bodies);
            if self.in_lanes() {
                self.blocks.take(contacts, caches, &bodies.inverse_masses, &bodies.sizes);
            }
        }
        self.narrow_phase.pass(dt);
    }

    /// Searches the contacts of the bodies that need it; whether all contacts are to be put into lanes.
    fn search(&mut self, bodies: &Bodies) -> bool {
        if !self.narrow_phase.wants(bodies, &self.moment) {
            return false;
        }
        let others_move = self.narrow_phase.find_pairs(bodies, &self.moment);
        let (contacts, caches) = (self.narrow_phase.contacts(), self.narrow_phase.caches());
        if self.in_lanes() && !others_move && self.blocks.may_stay(contacts.len(), bodies.len()) {
            if self.blocks.is_to_be_laid_out() {
                self.blocks.lay_out_saved(contacts, caches, bodies);
            }
            if self.narrow_phase.search_in_place(&mut self.blocks, bodies, self.moment.last_dt) {
                return false;
            }
        }
        self.note_impulses();
        self.narrow_phase.search(&self.moment);
        true
    }

    /// Whether contacts live in lanes from search to search: a rebound is that of a contact alone.
    pub(super) fn in_lanes(&self) -> bool {
        !self.solver.at_once() && !self.narrow_phase.is_elastic()
    }

    /// Applies the impulses kept from the last substep. Call it after [`Contacts::begin_substep`], while the bodies have
    /// the velocities they had then.
    pub fn warm_start(&mut self, bodies: &mut Bodies) {
        let step = (&self.moment, self.solver.kept() * self.warm_factor);
        if self.solver.at_once() {
            self.narrow_phase.open(bodies, step, |_| ());
            return self.start_at_once(bodies);
        }
        let masses = &bodies.inverse_masses[..];
        for linked in &mut self.joints {
            linked.prepare(&bodies.poses, &bodies.displacements, masses, self.dt, self.warm_factor);
        }
        let mut motion = std::mem::take(&mut bodies.displacements);
        if self.in_lanes() {
            self.blocks.take_motion(&motion);
            let (places, parallelism) = (self.narrow_phase.places(), self.narrow_phase.parallelism);
            self.blocks.open(places, &bodies.velocities, step, parallelism);
            self.blocks.give_motion(&mut motion);
        } else {
            self.narrow_phase.open(bodies, step, |contacts| {
                for contact in contacts {
                    apply((contact.a, contact.b), &contact.kept_push(), masses, &mut motion);
                }
            });
            self.blocks.fill(self.narrow_phase.contacts(), (masses, &bodies.sizes), self.moment.fall());
        }
        turn_joints(&mut self.joints, masses, &mut motion, |linked, _| linked.start());
        bodies.displacements = motion;
    }

    /// The same for contacts that act at once, with masses split among them.
    fn start_at_once(&mut self, bodies: &mut Bodies) {
        self.solver.scale_masses(self.narrow_phase.contacts(), bodies, self.up, &mut self.scaled);
        self.split_masses(bodies);
        self.jacobi.index(self.narrow_phase.contacts(), bodies.len());
        for linked in &mut self.joints {
            linked.prepare(&bodies.poses, &bodies.displacements, &self.split, self.dt, self.warm_factor);
        }
        let masses = seen(&self.scaled, &bodies.inverse_masses);
        let (order, rows) = (Order::AtOnce(&mut self.jacobi), self.narrow_phase.rows());
        Sweep { order, rows, joints: &mut self.joints, masses, motion: &mut bodies.displacements }.run(
            |contact, _, _| {
                contact.prepare(&self.split);
                contact.kept_push()
            },
            |linked, _| linked.start(),
        );
    }

    /// N = max(1, n/relaxation) for the n contacts and joints that act on a body in this substep.
    fn split_masses(&mut self, bodies: &Bodies) {
        self.counts.clear();
        self.counts.resize(bodies.len(), 0);
        let mut count = |body: u32| {
            if body != NONE {
                self.counts[body as usize] += 1;
            }
        };
        for contact in self.narrow_phase.contacts() {
            let near = 1e-3 * bodies.sizes[contact.a as usize];
            if contact.is_pressed() || contact.gap_after(&bodies.displacements, 1.0) < near {
                count(contact.a);
                count(contact.b);
            }
        }
        for (a, b) in self.joints.iter().filter(|linked| linked.is_live()).map(Linked::bodies) {
            count(a);
            count(b);
        }
        let relaxation = self.settings.relaxation;
        self.split.clear();
        self.split.extend(seen(&self.scaled, &bodies.inverse_masses).iter().zip(&self.counts).map(
            |(response, &count)| {
                let shares = (f64::from(count) / relaxation).max(1.0);
                InverseMass { linear: response.linear * shares, angular: response.angular * shares }
            },
        ));
    }

    /// Whether calls of [`iterate`](Contacts::iterate) sweep once from now on, whatever the settings say: a frame has no
    /// time for more.
    pub(crate) fn sweep_once(&mut self, once: bool) {
        self.once = once;
    }

    fn sweeps(&self) -> u32 {
        if self.once { self.settings.iterations.min(1) } else { self.settings.iterations }
    }

    /// Iterations of all contacts and joints on the displacements; two iterations by default.
    pub fn iterate(&mut self, bodies: &mut Bodies) {
        if !self.solver.at_once() {
            return self.iterate_in_turn(bodies);
        }
        for _ in 0..self.sweeps() {
            let (order, rows) = (Order::AtOnce(&mut self.jacobi), self.narrow_phase.rows());
            let (joints, masses) = (&mut self.joints[..], seen(&self.scaled, &bodies.inverse_masses));
            self.solver.sweep(Sweep { order, rows, joints, masses, motion: &mut bodies.displacements });
        }
    }

    /// Sweeps to and fro; the contacts get their impulses at the end.
    fn iterate_in_turn(&mut self, bodies: &mut Bodies) {
        let sweeps = self.sweeps();
        self.blocks.take_motion(&bodies.displacements);
        for _ in 0..sweeps {
            self.sweep_in_turn(bodies, Way::of(self.swept, sweeps, self.among_particles));
            self.swept += 1;
        }
        self.blocks.give_motion(&mut bodies.displacements);
        self.blocks.live = true;
    }

    /// One sweep over the motion that the blocks hold; joints come last in one direction, first in the other.
    fn sweep_in_turn(&mut self, bodies: &mut Bodies, way: Way) {
        let backward = self.backward != way.back;
        if backward {
            self.turn_joints_of_blocks(bodies);
        }
        self.blocks.pass(Rule::Solve { backward, over_relaxed: way.over_relaxed });
        if !backward {
            self.turn_joints_of_blocks(bodies);
        }
    }

    fn turn_joints_of_blocks(&mut self, bodies: &mut Bodies) {
        if !self.joints.is_empty() {
            let motion = &mut bodies.displacements[..];
            self.blocks.give_motion(motion);
            turn_joints(&mut self.joints, &bodies.inverse_masses, motion, Linked::solve);
            self.blocks.take_motion(motion);
        }
    }

    /// Gives the contacts the impulses that they have so far in this substep.
    pub(crate) fn note_impulses(&mut self) {
        let in_lanes = self.in_lanes();
        self.blocks.give_back(self.narrow_phase.rows().0, in_lanes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::contact::relaxation::over;
    use crate::rigid::contact::{Contact, ContactSettings};
    use crate::rigid::{BodySpec, Pose, Surface, Wall};
    use crate::shapes::Shape;

    const DT: f64 = 1.0 / 240.0;
    const GRAVITY: Vector64 = Vector64::new(0.0, -9.81);

    /// Boxes and discs over a floor, some of which resist rolling.
    fn heap() -> (Bodies, Contacts) {
        let floor = Wall::half_plane(Vector64::ZERO, Vector64::Y, Surface::with_friction(0.5));
        let (mut bodies, contacts) = (Bodies::new(0.1), Contacts::new(&[floor], ContactSettings::default()));
        for k in 0..60 {
            let (column, row) = (f64::from(k % 6), f64::from(k / 6));
            let side = 0.4 + 0.02 * f64::from(k % 5);
            let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
            let square = Shape::Polygon(corners.map(|(x, y)| Vector64::new(x, y) * side).to_vec());
            let shape = if k % 3 == 0 { Shape::Disc { radius: 0.5 * side } } else { square };
            let position = Vector64::new(0.45 * column + 0.1 * (row % 2.0), 0.25 + 0.49 * row);
            let rolling_friction = if k % 2 == 0 { 0.1 } else { 0.0 };
            let surface = Surface { rolling_friction, ..Surface::with_friction(0.5) };
            let pose = Pose { position, angle: 0.0 };
            bodies.add(BodySpec { pose, surface, ..BodySpec::new(shape) }).unwrap();
        }
        (bodies, contacts)
    }

    /// The warm start contact by contact.
    fn start_alone(contacts: &mut Contacts, bodies: &mut Bodies) {
        let (step, motion) = ((&contacts.moment, contacts.warm_factor), &mut bodies.displacements.clone());
        contacts.narrow_phase.open(bodies, step, |contacts| {
            for contact in contacts {
                apply((contact.a, contact.b), &contact.kept_push(), &bodies.inverse_masses, motion);
            }
        });
        bodies.displacements.clone_from(motion);
    }

    /// Iterations contact by contact.
    fn iterate_alone(contacts: &mut Contacts, bodies: &mut Bodies) {
        let sweeps = contacts.settings.iterations;
        let (fall, sizes) = (contacts.moment.fall(), &bodies.sizes);
        let size = |contact: &Contact| sizes.get(contact.b as usize).map_or(f64::INFINITY, |size| *size);
        let over_of =
            |contact: &Contact| over(contact.is_pressed(), fall, sizes[contact.a as usize].min(size(contact)));
        let over: Vec<f64> = contacts.narrow_phase.contacts().iter().map(over_of).collect();
        for sweep in 0..sweeps {
            let way = Way::of(sweep, sweeps, false);
            let backward = contacts.backward != way.back;
            let rows = contacts.narrow_phase.rows().0;
            let count = rows.len();
            for k in 0..count {
                let at = if backward { count - 1 - k } else { k };
                let contact = &mut rows[at];
                let relaxation = if way.over_relaxed { 1.0 + over[at] } else { 1.0 };
                let push = contact.solve(&bodies.displacements, relaxation);
                apply((contact.a, contact.b), &push, &bodies.inverse_masses, &mut bodies.displacements);
            }
        }
    }

    #[test]
    fn a_sweep_over_blocks_is_one_over_contacts_in_turn() {
        let (mut bodies, mut contacts) = heap();
        let mut largest = 0.0f64;
        for substep in 0..240 {
            contacts.begin_substep(&mut bodies, DT, GRAVITY);
            bodies.predict(DT, 0.0, GRAVITY);
            contacts.note_impulses();
            let (mut alone, mut moved) = (contacts.clone(), bodies.clone());
            contacts.warm_start(&mut bodies);
            start_alone(&mut alone, &mut moved);
            iterate_alone(&mut alone, &mut moved);
            contacts.iterate(&mut bodies);
            for (in_lanes, in_turn) in bodies.displacements.iter().zip(&moved.displacements) {
                let off = (in_lanes.linear - in_turn.linear).length() + (in_lanes.angular - in_turn.angular).abs();
                // Normals, arms and masses of the lanes have the precision of particles.
                assert!(off < 1e-6, "substep {substep}: {off:.1e} m");
                largest = largest.max(off);
            }
            bodies.integrate(DT);
            contacts.restitute(&mut bodies);
            contacts.depenetrate(&mut bodies);
            if substep % 4 == 3 {
                contacts.finish_frame(&mut bodies, 4.0 * DT);
                bodies.finish_frame(4.0 * DT);
            }
        }
        println!("they differ by {largest:.1e} m at most, over {} contacts", contacts.narrow_phase.contacts().len());
        assert!(contacts.narrow_phase.contacts().len() > 60);
    }

    #[test]
    fn a_block_holds_no_body_twice_and_contacts_of_a_body_keep_their_order() {
        let (mut bodies, mut contacts) = heap();
        contacts.begin_substep(&mut bodies, DT, GRAVITY);
        let found = contacts.narrow_phase.contacts();
        let block_of = |k: usize| contacts.blocks.slot(k).0;
        for (k, contact) in found.iter().enumerate() {
            for (j, later) in found.iter().enumerate().skip(k + 1) {
                let sides = [contact.a, contact.b];
                if sides.iter().any(|&body| body != NONE && (later.a == body || later.b == body)) {
                    assert!(block_of(k) < block_of(j), "contacts {k} and {j}");
                }
            }
        }
        assert!(contacts.blocks.all.len() < found.len() / 2, "{} blocks", contacts.blocks.all.len());
    }
}
