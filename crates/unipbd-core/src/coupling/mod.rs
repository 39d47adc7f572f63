//! Rigid bodies among the particles: their lattice samples as rows, loads from the fluid, and a
//! fluid that stays outside.

mod demand;
mod edit;
mod outlined;
mod push_out;
mod ropes;
mod saved;
mod soft_bodies;
mod ties;

use crate::constraints::LightBody;
use crate::math::{Real, Vector, Vector64, vector, wide};
use crate::particles::Particles;
use crate::rigid::contact::Contacts;
use crate::rigid::{Bodies, Body, Mobilities};
use crate::rows::RowIndex;
use outlined::Meeting;
pub(crate) use outlined::{Met, is_outlined};
use push_out::Penetration;
pub use ropes::RopeReading;
pub(crate) use ropes::{MOST_PIECES, Ropes};

/// A little more than half the diagonal of a lattice cell \[spacings].
const LEAST_NEAR: f64 = 0.75;

/// The bodies of a run, their contacts, and the ids of their samples.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub struct RigidBodies {
    pub(crate) bodies: Bodies,
    pub(crate) contacts: Contacts,
    /// Ids of the samples of each body, from the first to one past the last.
    sample_ids: Vec<(u32, u32)>,
    /// Whether a fluid, or particles, meet bodies through their samples.
    seen: bool,
    /// Whether bodies that the fluid does not move are walls to it, and have no samples.
    #[serde(skip)]
    outlines: bool,
    /// How the fluid meets each body.
    #[serde(skip)]
    met: Vec<Meeting>,
    /// Bodies with samples, in the order of the ids of these.
    #[serde(skip)]
    sampled: Vec<u32>,
    /// Distance of samples \[m].
    #[serde(skip)]
    spacing: f64,
    /// Distance from a sample within which a particle may be inside the body, by body \[m].
    near: Vec<Real>,
    /// Path in a substep, of a particle or a body, from which on the way counts and not the place alone \[m].
    far: Real,
    penetrations: Vec<Penetration>,
    /// Ends of ropes that move with bodies.
    tied: Vec<Tied>,
    /// Joints whose anchor in the world is a particle.
    carried: Vec<Carried>,
    /// Bodies that are particles, drawn back to their shapes.
    matched: Vec<soft_bodies::Matched>,
    /// Mass per area of the heaviest fluid, beside which bodies are light [kg/m^2]; 0 where there is none.
    #[serde(skip)]
    heaviest: f64,
    #[serde(skip)]
    light: Vec<LightBody>,
    /// How bodies answer to the pressure of a grid.
    #[serde(skip)]
    mobilities: Mobilities,
}

/// A point that moves with a body.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Tied {
    id: u32,
    body: u32,
    /// Where it is on the body \[m].
    place: Vector64,
}

/// Distance from a sample within which a particle may be inside the body \[m].
fn near(body: &Body, seen: bool, spacing: f64) -> Real {
    let gap = if seen { push_out::widest_gap(body, spacing) } else { 0.0 };
    gap.max(LEAST_NEAR * spacing) as Real
}

/// A joint whose anchor in the world is a particle while that is held: the free end of a rope.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Carried {
    joint: u32,
    id: u32,
}

impl RigidBodies {
    /// Bodies whose samples have consecutive ids from `first_sample`, body by body.
    /// Without a fluid the samples have no use: then there are none.
    pub(crate) fn new(bodies: Bodies, contacts: Contacts, met: Option<Met>, spacing: f64) -> Self {
        let (mut next, seen) = (met.map_or(0, |met| met.first_sample), met.is_some());
        let outlines = met.is_some_and(|met| met.outlines);
        let mut sample_ids = Vec::new();
        for body in bodies.views() {
            let first = next;
            let outlined = outlines && is_outlined(body, spacing);
            next += if seen && !outlined { body.samples.len() as u32 } else { 0 };
            sample_ids.push((first, next));
        }
        let near = bodies.views().iter().map(|body| near(body, seen, spacing)).collect();
        let mut rigid = RigidBodies {
            bodies,
            contacts,
            sample_ids,
            seen,
            outlines,
            met: Vec::new(),
            sampled: Vec::new(),
            spacing,
            near,
            far: (0.5 * spacing) as Real,
            penetrations: Vec::new(),
            tied: Vec::new(),
            carried: Vec::new(),
            matched: Vec::new(),
            heaviest: 0.0,
            light: Vec::new(),
            mobilities: Mobilities::default(),
        };
        rigid.list_matched(spacing);
        rigid.find_met();
        rigid
    }

    /// The bodies as they are read from outside.
    pub fn views(&self) -> &[Body] {
        self.bodies.views()
    }

    /// Whether bodies have samples that particles meet.
    pub(crate) fn is_seen(&self) -> bool {
        self.seen
    }

    /// Whether particles move with the bodies, samples that a fluid meets or ends of ropes, or a fluid meets their
    /// outlines.
    pub(crate) fn has_followers(&self) -> bool {
        self.met.iter().any(|met| *met != Meeting::None) || !self.tied.is_empty()
    }

    /// Finds contacts, predicts the bodies and applies the impulses kept from the last substep.
    pub(crate) fn predict(&mut self, dt: f64, time: f64, gravity: Vector64) {
        self.contacts.begin_substep(&mut self.bodies, dt, gravity);
        self.bodies.predict(dt, time, gravity);
        self.contacts.warm_start(&mut self.bodies);
    }

    /// The bodies and how they answer to loads.
    pub(crate) fn movers(&self) -> (&Bodies, &Mobilities) {
        (&self.bodies, &self.mobilities)
    }

    /// One iteration of all contacts and joints.
    pub(crate) fn iterate_contacts(&mut self) {
        self.contacts.iterate(&mut self.bodies);
    }

    /// Finds how each body answers to a load. Contacts and joints hold as they did in the last substep: call it when they
    /// were prepared, and before they are solved again.
    pub(crate) fn find_mobilities(&mut self) {
        self.contacts.note_impulses();
        let contacts = &self.contacts;
        self.mobilities.find(self.bodies.inverse_masses(), contacts.joint_rows(), contacts.held_rows());
    }

    /// The same where contacts hold nothing.
    pub(crate) fn find_mobilities_of_joints(&mut self) {
        self.mobilities.find(self.bodies.inverse_masses(), self.contacts.joint_rows(), std::iter::empty());
    }

    /// The bodies to be pushed by a pressure grid, their mobilities, and whether it meets a body as one.
    pub(crate) fn immersed(&mut self) -> (&mut Bodies, &Mobilities, impl Fn(u32) -> bool) {
        let met = &self.met;
        let counts = move |body: u32| matches!(met[body as usize], Meeting::Samples | Meeting::Outline);
        (&mut self.bodies, &self.mobilities, counts)
    }

    /// Puts the samples where the bodies are predicted to be.
    pub(crate) fn place_samples(&self, particles: &mut Particles, rows: &RowIndex) {
        self.each_follower(rows, |body, sample, row| {
            let (start, end) = (self.bodies.pose(body).apply(sample), self.bodies.predicted_pose(body).apply(sample));
            particles.start[row] = vector(start);
            particles.position[row] = vector(end);
            particles.displacement[row] = vector(end - start);
            particles.remainder[row] = Vector::ZERO;
        });
    }

    /// Ends a substep: poses and velocities follow from the displacements.
    pub(crate) fn integrate(&mut self, dt: f64) {
        self.bodies.integrate(dt);
        self.contacts.restitute(&mut self.bodies);
        self.contacts.depenetrate(&mut self.bodies);
    }

    /// Puts the samples where the bodies are, with the velocity of the body's matter.
    pub(crate) fn settle_samples(&self, particles: &mut Particles, rows: &RowIndex) {
        self.each_follower(rows, |body, sample, row| {
            let place = self.bodies.pose(body).apply(sample);
            particles.position[row] = vector(place);
            particles.velocity[row] = vector(self.bodies.velocity_at(body, place));
        });
    }

    /// Sums the forces on the samples of each body, in the order of its samples.
    /// `loads` are forces times dt^2 by row [kg m].
    pub(crate) fn take_loads(&mut self, loads: &[Vector], particles: &Particles, rows: &RowIndex, dt: f64) {
        for body in 0..self.bodies.len() as u32 {
            if self.sleeps_with_samples(body, particles, rows) {
                continue;
            }
            let center = self.bodies.predicted_pose(body).position;
            let (mut force, mut torque) = (Vector64::ZERO, 0.0);
            for id in self.samples_of(body) {
                let Some(row) = rows.row(id) else { continue };
                let load = wide(loads[row as usize]);
                force += load;
                torque += (wide(particles.position[row as usize]) - center).perp_dot(load);
            }
            if force != Vector64::ZERO || torque != 0.0 {
                self.bodies.load(body, force / (dt * dt), torque / (dt * dt), dt);
            }
        }
    }

    /// Ids of the samples of a body.
    pub(crate) fn samples_of(&self, body: u32) -> std::ops::Range<u32> {
        let (first, end) = self.sample_ids[body as usize];
        first..end
    }

    /// Visits the samples whose rows are known: body, place in the body, row.
    fn each_sample(&self, rows: &RowIndex, mut visit: impl FnMut(u32, Vector64, usize)) {
        for (body, view) in self.bodies.views().iter().enumerate() {
            for (id, &sample) in self.samples_of(body as u32).zip(&view.samples) {
                if let Some(row) = rows.row(id) {
                    visit(body as u32, sample, row as usize);
                }
            }
        }
    }

    /// Visits the samples and the particles tied to bodies.
    fn each_follower(&self, rows: &RowIndex, mut visit: impl FnMut(u32, Vector64, usize)) {
        self.each_sample(rows, |body, place, row| {
            if self.bodies.elasticity(body as usize).is_none() {
                visit(body, place, row);
            }
        });
        for tied in &self.tied {
            if let Some(row) = rows.row(tied.id) {
                visit(tied.body, tied.place, row as usize);
            }
        }
    }

    fn first_row(&self, body: u32, rows: &RowIndex) -> Option<usize> {
        let ids = self.samples_of(body);
        if ids.is_empty() { None } else { rows.row(ids.start).map(|row| row as usize) }
    }

    /// Whether the samples of a body sleep, with the fluid around it: either all do, or none.
    fn sleeps_with_samples(&self, body: u32, particles: &Particles, rows: &RowIndex) -> bool {
        particles.asleep() > 0 && self.first_row(body, rows).is_some_and(|row| row >= particles.awake())
    }

    /// Whether the sample of this id may sleep: its body is not kinematic.
    pub(crate) fn may_rest(&self, id: u32) -> bool {
        let after = self.sampled.partition_point(|&body| self.sample_ids[body as usize].0 <= id);
        let Some(&body) = self.sampled[..after].last() else { return false };
        let body = body as usize;
        let matched = self.bodies.elasticity(body).is_some();
        !matched && (self.bodies.is_dynamic(body) || !self.bodies.is_active(body))
    }

    /// Visits the sleeping samples of bodies that are awake.
    pub(crate) fn each_sample_left_asleep(&self, particles: &Particles, rows: &RowIndex, mut visit: impl FnMut(usize)) {
        for body in 0..self.bodies.len() as u32 {
            // A body that becomes kinematic was not woken by another body.
            let awake = !self.bodies.is_asleep(body) || self.bodies.is_active(body as usize);
            if awake && self.sleeps_with_samples(body, particles, rows) {
                let ids = self.samples_of(body);
                ids.filter_map(|id| rows.row(id)).for_each(|row| visit(row as usize));
            }
        }
    }

    /// Wakes the bodies, with their islands, that have a sample in a row that is about to wake. Tells
    /// whether there were any.
    pub(crate) fn wake_bodies(&mut self, rows: &RowIndex, wakes: impl Fn(usize) -> bool) -> bool {
        let mut any = false;
        for body in 0..self.bodies.len() as u32 {
            let mut ids = self.samples_of(body);
            let wakes = |id: u32| rows.row(id).is_some_and(|row| wakes(row as usize));
            if self.bodies.is_asleep(body) && ids.any(wakes) {
                self.contacts.wake(&mut self.bodies, body);
                any = true;
            }
        }
        any
    }

    /// Puts the bodies to sleep whose samples do.
    pub(crate) fn put_to_sleep(&mut self, particles: &Particles, rows: &RowIndex) {
        let falling_asleep =
            |&body: &u32| !self.bodies.is_asleep(body) && self.sleeps_with_samples(body, particles, rows);
        let falling_asleep: Vec<u32> = (0..self.bodies.len() as u32).filter(falling_asleep).collect();
        self.contacts.put_to_sleep(&mut self.bodies, &falling_asleep);
    }

    /// Ends a frame: sleep, mean loads.
    pub(crate) fn finish_frame(&mut self, frame_time: f64) {
        self.contacts.finish_frame(&mut self.bodies, frame_time);
        self.bodies.finish_frame(frame_time);
    }
}
