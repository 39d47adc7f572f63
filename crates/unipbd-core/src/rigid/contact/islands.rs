//! Sleep by islands: connected bodies fall asleep together, once all of them have been slow for a
//! while, and wake together. Impulses are kept, so that a woken pile keeps its state.

use super::bounds::NONE;
use super::linked::Linked;
use super::manifold::Contact;
use crate::rigid::{Bodies, Twist};
use crate::scene::SLEEP_SPEED;
use crate::union_find::UnionFind;

/// When bodies fall asleep.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SleepSettings {
    /// Speed of the fastest point of a body, |v| + |w| R, below which it may be at rest, relative to
    /// sqrt(gravity x size of the body): without gravity nothing sleeps.
    pub speed: f64,
    /// Rest time of a whole island before it sleeps \[s].
    pub delay: f64,
}

impl Default for SleepSettings {
    fn default() -> Self {
        SleepSettings { speed: SLEEP_SPEED, delay: 0.5 }
    }
}

/// Way since its rest began, relative to its size, within which a body is at rest. A slow drift leaves it.
const DRIFT: f64 = 4e-3;
/// Part of the rest time for which the speed may have grown without a break: a body that begins to slide or to tip
/// over grows faster in every frame, the jitter of a heap does not.
const RISING: f64 = 0.5;
/// Factor on the limit of the speed for a body that no contact presses: contacts jitter, joints do not, and at the
/// apex of a swing every body is slow.
const SWINGING: f64 = 1e-3;
/// Growth of the speed in a frame that counts as one: a body that begins to slide gains 3 % in its thirtieth frame.
const GROWTH: f64 = 1.01;
/// Speed relative to the limit below which its growth is rounding.
const NOISE: f64 = 1e-4;

/// Rest times of bodies, and the islands of sleeping bodies.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Islands {
    /// Rest time of each body \[s].
    rest: Vec<f64>,
    /// How far its velocity has carried it since its rest began.
    drifts: Vec<Twist>,
    /// Its last speed [m/s], and the time for which it has grown \[s].
    speeds: Vec<f64>,
    rising: Vec<f64>,
    /// The island of each sleeping body.
    island: Vec<u32>,
    touching: UnionFind,
    /// Whether a contact presses each body.
    #[serde(skip)]
    carried: Vec<bool>,
    /// The shortest rest time of each island, at its root.
    #[serde(skip)]
    least: Vec<f64>,
}

impl Islands {
    /// The rest times and islands of a saved state, for so many bodies.
    pub fn from_saved(saved: Islands, bodies: usize) -> Islands {
        let mut islands = Islands { touching: UnionFind::default(), ..saved };
        islands.resize(bodies);
        islands
    }

    pub fn resize(&mut self, bodies: usize) {
        self.rest.resize(bodies, 0.0);
        self.drifts.resize(bodies, Twist::ZERO);
        self.speeds.resize(bodies, 0.0);
        self.rising.resize(bodies, 0.0);
        self.island.resize(bodies, NONE);
    }

    /// Wakes the islands of bodies that were pushed.
    pub fn wake_pushed(&mut self, bodies: &mut Bodies) {
        for id in 0..bodies.len() {
            if bodies.pushed[id] && bodies.asleep[id] {
                self.wake_island(bodies, id);
            }
        }
    }

    /// Wakes the islands that a moving body touches in this substep; returns whether any was woken.
    pub fn wake_touched(&mut self, bodies: &mut Bodies, contacts: &[Contact], joints: &[Linked], dt: f64) -> bool {
        let mut woken = false;
        if !bodies.asleep.contains(&true) {
            return false;
        }
        let mut touch = |islands: &mut Islands, bodies: &mut Bodies, a: u32, b: u32| {
            for (moving, still) in [(a, b), (b, a)] {
                if still != NONE && bodies.asleep[still as usize] && bodies.is_active(moving as usize) {
                    islands.wake_island(bodies, still as usize);
                    woken = true;
                }
            }
        };
        for contact in contacts.iter().filter(|contact| contact.b != NONE) {
            let (a, b) = (contact.a, contact.b);
            let asleep = bodies.asleep[a as usize] || bodies.asleep[b as usize];
            if asleep && contact.gap_after(&bodies.velocities, dt) < 1e-3 * bodies.sizes[a as usize] {
                touch(self, bodies, a, b);
            }
        }
        let live = joints.iter().filter(|linked| linked.is_live());
        for (a, b) in live.map(Linked::bodies).filter(|&(_, b)| b != NONE) {
            touch(self, bodies, a, b);
        }
        woken
    }

    pub fn wake_island(&mut self, bodies: &mut Bodies, id: usize) {
        let island = self.island[id];
        for other in 0..bodies.len() {
            if bodies.asleep[other] && self.island[other] == island {
                bodies.wake(other);
                self.rest[other] = 0.0;
            }
        }
    }

    /// At the end of a frame: puts islands to sleep that have been at rest long enough.
    pub fn sleep(
        &mut self,
        bodies: &mut Bodies,
        contacts: &[Contact],
        joints: &[Linked],
        settings: &SleepSettings,
        (frame_time, gravity): (f64, f64),
    ) -> bool {
        self.note_carried(bodies.len(), contacts);
        self.measure_rest(bodies, settings, (frame_time, gravity));
        self.disturb_by_motors(bodies, joints);
        if !self.rest.iter().zip(&bodies.asleep).any(|(&rest, &asleep)| rest >= settings.delay && !asleep) {
            return false;
        }
        self.unite_touching(bodies, contacts, joints);
        self.put_to_rest(bodies, settings)
    }

    /// Puts bodies to sleep at once, when the fluid around them falls asleep.
    pub fn put_to_sleep(
        &mut self,
        bodies: &mut Bodies,
        falling_asleep: &[u32],
        contacts: &[Contact],
        joints: &[Linked],
    ) {
        self.unite_touching(bodies, contacts, joints);
        for &body in falling_asleep {
            bodies.fall_asleep(body as usize);
            self.island[body as usize] = self.touching.root(body);
        }
    }

    fn unite_touching(&mut self, bodies: &Bodies, contacts: &[Contact], joints: &[Linked]) {
        self.touching.reset(bodies.len());
        let touching = contacts.iter().filter(|contact| contact.is_pressed()).map(|contact| (contact.a, contact.b));
        let joined = joints.iter().filter(|linked| linked.is_live()).map(Linked::bodies);
        for (a, b) in touching.chain(joined).filter(|&(_, b)| b != NONE) {
            self.unite(bodies, a, b);
        }
    }

    /// Bodies that something presses against: the others hang from joints, swing or fall.
    fn note_carried(&mut self, bodies: usize, contacts: &[Contact]) {
        self.carried.clear();
        self.carried.resize(bodies, false);
        for contact in contacts.iter().filter(|contact| contact.is_pressed()) {
            self.carried[contact.a as usize] = true;
            if contact.b != NONE {
                self.carried[contact.b as usize] = true;
            }
        }
    }

    fn measure_rest(&mut self, bodies: &Bodies, settings: &SleepSettings, (frame_time, gravity): (f64, f64)) {
        for id in 0..bodies.len() {
            let velocity = &bodies.velocities[id];
            let (reach, size) = (bodies.reaches[id], bodies.sizes[id]);
            let speed = velocity.linear.length() + velocity.angular.abs() * reach;
            // The removal of old overlap moves a body, too, but that is no motion.
            self.drifts[id] += velocity.scaled(frame_time);
            let drift = self.drifts[id].linear.length() + self.drifts[id].angular.abs() * reach;
            let limit = settings.speed * (gravity * size).sqrt() * if self.carried[id] { 1.0 } else { SWINGING };
            let (slow, noise) = (speed < limit, speed < NOISE * limit);
            self.rising[id] =
                if !noise && speed > GROWTH * self.speeds[id] { self.rising[id] + frame_time } else { 0.0 };
            self.speeds[id] = speed;
            let still = slow && drift < DRIFT * size && self.rising[id] < RISING * settings.delay;
            self.rest[id] = if still && !bodies.pushed[id] { self.rest[id] + frame_time } else { 0.0 };
            if self.rest[id] == 0.0 {
                self.drifts[id] = Twist::ZERO;
            }
        }
    }

    /// A body that a motor turns does not rest, however slow it is; one that a motor holds may.
    fn disturb_by_motors(&mut self, bodies: &Bodies, joints: &[Linked]) {
        for linked in joints.iter().filter(|linked| linked.is_driven()) {
            let (a, b) = linked.bodies();
            for body in [a, b].into_iter().filter(|&body| body != NONE && bodies.is_dynamic(body as usize)) {
                self.rest[body as usize] = 0.0;
            }
        }
    }

    /// Links two dynamic bodies; a body in contact with a moving kinematic body cannot rest.
    fn unite(&mut self, bodies: &Bodies, a: u32, b: u32) {
        let kinematic = |id: u32| !bodies.is_dynamic(id as usize) && bodies.is_active(id as usize);
        match (bodies.is_dynamic(a as usize), bodies.is_dynamic(b as usize)) {
            (true, true) => self.touching.unite(a, b),
            (true, false) if kinematic(b) => self.rest[a as usize] = 0.0,
            (false, true) if kinematic(a) => self.rest[b as usize] = 0.0,
            _ => {}
        }
    }

    fn put_to_rest(&mut self, bodies: &mut Bodies, settings: &SleepSettings) -> bool {
        self.least.clear();
        self.least.resize(bodies.len(), f64::INFINITY);
        for id in 0..bodies.len() {
            let root = self.touching.root(id as u32) as usize;
            self.least[root] = self.least[root].min(self.rest[id]);
        }
        let mut any = false;
        for id in 0..bodies.len() {
            let root = self.touching.root(id as u32);
            if self.least[root as usize] >= settings.delay && bodies.is_dynamic(id) && !bodies.asleep[id] {
                bodies.fall_asleep(id);
                self.island[id] = root;
                any = true;
            }
        }
        any
    }
}
