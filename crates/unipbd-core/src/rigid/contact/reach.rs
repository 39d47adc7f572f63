//! How far bodies may move before their contacts are searched again.
//!
//! A search predicts each body to go on with its velocity until the end of the frame. A pair is searched with a
//! margin that covers the predicted relative motion, and an allowance of both bodies for what differs from it.
//! A body that leaves its allowance, as after an impact, is searched again within the frame.

use super::bounds::NONE;
use crate::rigid::{Bodies, Pose, Twist};

/// Allowance of a body at rest, relative to its size.
const LEAST: f64 = 0.01;
/// Rotation after which the faces of a polygon are searched again \[rad].
const TURN: f64 = 0.15;
/// Relative motion after which the same contacts are no longer trusted, relative to the size of the body: another
/// face may be nearer.
const WAY: f64 = 0.5;

/// A body at its last search.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
struct Reference {
    pose: Pose,
    velocity: Twist,
    /// Time of the search since the start of the frame \[s].
    time: f64,
    /// Way that may differ from the prediction \[m].
    allowance: f64,
    /// Fastest motion relative to a nearby body [m/s].
    closing: f64,
}

/// The last search of each body.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Reach {
    bodies: Vec<Reference>,
    /// Bodies to be searched in this substep.
    pub wanted: Vec<bool>,
    /// Distance of the outline from the centre of mass that rotation moves: 0 for discs \[m].
    levers: Vec<f64>,
    /// Data of a body for its pairs, in a row: velocity, speed of the outline by rotation, allowance. The last row is
    /// that of walls.
    #[serde(skip)]
    rows: Vec<[f64; 4]>,
    /// Fastest motion of each body relative to a nearby one, and that of walls: a buffer.
    #[serde(skip)]
    fastest: Vec<f64>,
    /// Length of the frame \[s], and the time since its start.
    frame: f64,
    elapsed: f64,
    begun: bool,
}

impl Reach {
    /// Begins a frame of this length \[s]: all bodies are searched in the next substep.
    pub fn begin_frame(&mut self, frame: f64) {
        (self.frame, self.elapsed, self.begun) = (frame, 0.0, false);
    }

    /// Searches all bodies in the next substep.
    pub fn restart(&mut self) {
        self.begun = false;
    }

    /// The last searches of a saved state, for so many bodies; `None` if they make no sense.
    pub fn at_saved(self, bodies: usize) -> Option<Reach> {
        let finite = |of: &Reference| {
            let (pose, velocity) = (of.pose, of.velocity);
            let numbers = [pose.angle, velocity.angular, of.time, of.allowance, of.closing];
            pose.position.is_finite() && velocity.linear.is_finite() && numbers.into_iter().all(f64::is_finite)
        };
        let sound = self.bodies.iter().all(finite) && self.levers.iter().all(|lever| lever.is_finite());
        let known = self.bodies.len() == self.levers.len() && self.levers.len() <= bodies;
        let timed = self.frame.is_finite() && self.elapsed.is_finite();
        (sound && known && timed && (!self.begun || self.wanted.len() == self.levers.len())).then_some(self)
    }

    /// Marks the bodies that must be searched before a substep; returns whether there are any.
    pub fn mark(&mut self, bodies: &Bodies, dt: f64, gravity: f64) -> bool {
        let known = self.levers.len();
        let round = |id: usize| bodies.cores[id].radius > 0.0;
        self.levers.extend((known..bodies.len()).map(|id| if round(id) { 0.0 } else { bodies.reaches[id] }));
        self.bodies.resize(bodies.len(), Reference::default());
        let over = self.elapsed + dt > self.frame * (1.0 + 1e-9);
        if !self.begun || over || known < bodies.len() {
            if over {
                (self.frame, self.elapsed) = (self.frame.max(dt), 0.0);
            }
            self.begun = true;
            self.wanted.clear();
            self.wanted.resize(bodies.len(), true);
            return true;
        }
        let mut any = false;
        for id in 0..bodies.len() {
            self.wanted[id] = bodies.is_active(id) && self.left(id, bodies, dt, gravity);
            any |= self.wanted[id];
        }
        any
    }

    /// Whether a body may leave its allowance within the next substep.
    fn left(&self, id: usize, bodies: &Bodies, dt: f64, gravity: f64) -> bool {
        let (of, pose, velocity) = (&self.bodies[id], &bodies.poses[id], &bodies.velocities[id]);
        let (time, lever) = (self.elapsed - of.time, self.levers[id]);
        let off = (pose.position - of.pose.position - of.velocity.linear * time).length();
        let turned = pose.angle - of.pose.angle;
        let off_turn = (turned - of.velocity.angular * time).abs();
        let faster = (velocity.linear - of.velocity.linear).length() + gravity * dt;
        let spun = (velocity.angular - of.velocity.angular).abs();
        off + off_turn * lever + (faster + spun * lever) * dt > of.allowance
            || (lever > 0.0 && time > 0.0 && turned.abs() + velocity.angular.abs() * dt > TURN)
            || (time > 0.0 && of.closing * (time + dt) > WAY * bodies.sizes[id])
    }

    /// Ends a substep of this length \[s].
    pub fn pass(&mut self, dt: f64) {
        self.elapsed += dt;
    }

    /// Time until the end of the frame \[s].
    fn ahead(&self) -> f64 {
        self.frame - self.elapsed
    }

    /// Takes the present poses of the wanted bodies as the start of their predictions.
    pub fn note(&mut self, bodies: &Bodies) {
        let anew = self.rows.len() != bodies.len() + 1;
        self.rows.resize(bodies.len() + 1, [0.0; 4]);
        self.rows[bodies.len()] = [0.0; 4];
        for (id, of) in self.bodies.iter_mut().enumerate() {
            if self.wanted[id] {
                let (pose, velocity) = (bodies.poses[id], bodies.velocities[id]);
                *of = Reference { pose, velocity, time: self.elapsed, ..*of };
            }
            if self.wanted[id] || anew {
                let Reference { velocity, allowance, .. } = of;
                let spin = velocity.angular.abs() * self.levers[id];
                self.rows[id] = [velocity.linear.x, velocity.linear.y, spin, *allowance];
            }
        }
    }

    /// Computes the allowances of the wanted bodies: a body may be hit by each nearby body.
    pub fn allow(&mut self, bodies: &Bodies, gravity: f64, pairs: impl Iterator<Item = (u32, u32)>) {
        self.fastest.clear();
        self.allow_for(bodies, gravity, pairs);
    }

    /// The same with more pairs.
    pub fn allow_for(&mut self, bodies: &Bodies, gravity: f64, pairs: impl Iterator<Item = (u32, u32)>) {
        let wall = bodies.len();
        self.fastest.resize(wall + 1, 0.0);
        let (all, rows, fastest) = (self.wanted.iter().all(|wanted| *wanted), &self.rows[..], &mut self.fastest[..]);
        for (a, b) in pairs {
            let (a, b) = (a as usize, (b as usize).min(wall));
            if all || self.wanted[a] || self.wanted.get(b).is_some_and(|wanted| *wanted) {
                let speed = closing(&rows[a], &rows[b]);
                for most in [a, b] {
                    // Without a branch, which nobody could predict.
                    fastest[most] = if speed > fastest[most] { speed } else { fastest[most] };
                }
            }
        }
        let (ahead, fall) = (self.ahead(), gravity * self.frame * self.frame);
        for (id, of) in self.bodies.iter_mut().enumerate().filter(|(id, _)| self.wanted[*id]) {
            of.closing = self.fastest[id];
            of.allowance = of.closing * ahead + fall + LEAST * bodies.sizes[id];
            self.rows[id][3] = of.allowance;
        }
    }

    /// Whether a body is searched in this substep.
    #[inline]
    pub fn is_wanted(&self, body: u32) -> bool {
        body != NONE && self.wanted[body as usize]
    }

    /// Largest distance of two bodies that can touch until the end of the frame \[m].
    #[inline]
    pub fn margin(&self, (a, b): (u32, u32)) -> f64 {
        let (of_a, of_b) = (&self.rows[a as usize], &self.rows[(b as usize).min(self.bodies.len())]);
        closing(of_a, of_b) * self.ahead() + of_a[3] + of_b[3]
    }

    /// Distance of the outline of a body from its centre of mass that rotation moves; 0 for discs and walls \[m].
    #[inline]
    pub fn lever(&self, body: u32) -> f64 {
        self.levers.get(body as usize).copied().unwrap_or(0.0)
    }

    /// The predicted motion of a body until the end of the frame, and how far it may be off \[m].
    pub fn sweep(&self, body: u32) -> (Twist, f64) {
        let of = &self.bodies[body as usize];
        let turning = of.velocity.angular.abs() * self.levers[body as usize] * self.ahead();
        (of.velocity.scaled(self.ahead()), of.allowance + turning)
    }
}

/// Speed of two bodies relative to each other, with that of their outlines by rotation [m/s].
#[inline]
fn closing(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let (x, y) = (a[0] - b[0], a[1] - b[1]);
    (x * x + y * y).sqrt() + a[2] + b[2]
}
