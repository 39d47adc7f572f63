//! A fluid that stays outside of bodies.
//!
//! A particle that moves little in a substep is pushed out along the nearest face. One that moves far could be past the
//! middle of a thin body, or past the body: there the face counts that its path came in by.

use std::collections::BTreeMap;

use super::RigidBodies;
use crate::math::{Vector, Vector64, direction, vector, wide};
use crate::neighbors::Neighbors;
use crate::particles::Particles;
use crate::phase::Phase;
use crate::rigid::{Body, InverseMass};
use crate::rows::RowIndex;
use crate::shapes::{Nearest, Shape, first_crossing, nearest_on_polygon};
use crate::walls::{Outlines, Walls};

/// How often a path that was turned out of one body is tried against the others: corners need two. In the
/// second half of the turns, only against bodies that cannot give way.
const TURNS: usize = 4;

/// A fluid particle that may be inside a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub(super) struct Penetration {
    row: u32,
    /// Bodies that cannot give way are resolved last and so determine the result.
    fixed: bool,
    body: u32,
}

impl RigidBodies {
    /// Moves fluid particles out of bodies; particle and body share the momentum.
    pub(crate) fn push_out(
        &mut self,
        particles: &mut Particles,
        neighbors: &Neighbors,
        (walls, outlines): (&Walls, &Outlines),
        rows: &RowIndex,
        dt: f64,
    ) {
        self.find_penetrations(particles, neighbors, outlines, rows);
        let swept = self.find_fast(particles);
        let mut start = (u32::MAX, Vector::ZERO);
        for k in 0..self.penetrations.len() {
            let Penetration { row, body, .. } = self.penetrations[k];
            if swept.binary_search(&row).is_err() {
                if start.0 != row {
                    start = (row, particles.start[row as usize]);
                }
                let at = self.on_body(body, wide(particles.position[row as usize]), End::Predicted);
                let way = nearest(&self.bodies.views()[body as usize], at);
                self.resolve((row, body), way, start.1, particles, walls, dt);
            }
        }
        for row in swept {
            self.sweep(row, particles, walls, dt);
        }
    }

    /// Turns the path of a fast particle out of all bodies that it came into. Bodies that cannot give way
    /// are resolved last.
    fn sweep(&mut self, row: u32, particles: &mut Particles, walls: &Walls, dt: f64) {
        let start = particles.start[row as usize];
        for turn in 0..TURNS {
            let mut turned = false;
            for fixed in [false, true].into_iter().skip(usize::from(2 * turn >= TURNS)) {
                for body in 0..self.bodies.len() as u32 {
                    if self.is_fixed(body) == fixed {
                        turned |= self.turn_out((row, body), start, particles, walls, dt);
                    }
                }
            }
            if !turned {
                break;
            }
        }
    }

    /// Turns the path of a particle out of one body; tells whether it led inside.
    fn turn_out(
        &mut self,
        (row, body): (u32, u32),
        start: Vector,
        particles: &mut Particles,
        walls: &Walls,
        dt: f64,
    ) -> bool {
        let (from, to) = (wide(start), wide(particles.position[row as usize]));
        if self.bodies.elasticity(body as usize).is_some() || !self.comes_near(body, from, to) {
            return false;
        }
        let (mut from, to) = (self.on_body(body, from, End::Start), self.on_body(body, to, End::Predicted));
        let view = &self.bodies.views()[body as usize];
        let before = nearest(view, from);
        // A path that starts inside counts as starting on the face nearest to it.
        from -= before.normal * before.distance.min(0.0);
        let mut way = nearest(view, to);
        // The nearest face is the way out if the path can have come in there.
        let slack = 1e-3 * f64::from(self.far);
        if way.distance >= 0.0 || (from - to).dot(way.normal) < -way.distance - slack {
            way = crossing(view, from, to).unwrap_or(way);
        }
        self.resolve((row, body), way, start, particles, walls, dt)
    }

    fn is_fixed(&self, body: u32) -> bool {
        self.bodies.response(body) == InverseMass::default()
    }

    /// Whether a path may meet a body: whether their bounding discs do.
    fn comes_near(&self, body: u32, from: Vector64, to: Vector64) -> bool {
        let (middle, half) = ((from + to) * 0.5, (to - from).length() * 0.5);
        let id = body as usize;
        let room = half + self.bodies.reaches[id] + self.bodies.displacements[id].linear.length();
        (middle - self.bodies.poses[id].position).length_squared() < room * room
    }

    /// A point of the world in the coordinates of a body.
    fn on_body(&self, body: u32, point: Vector64, end: End) -> Vector64 {
        let pose = match end {
            End::Start => self.bodies.pose(body),
            End::Predicted => self.bodies.predicted_pose(body),
        };
        direction(-pose.angle).rotate(point - pose.position)
    }

    /// Moves a particle out of a body along the face that `way` names; tells whether it was inside.
    fn resolve(
        &mut self,
        (row, body): (u32, u32),
        way: Nearest,
        start: Vector,
        particles: &mut Particles,
        walls: &Walls,
        dt: f64,
    ) -> bool {
        if way.distance >= 0.0 {
            return false;
        }
        let (row, pose) = (row as usize, self.bodies.predicted_pose(body));
        let arm = wide(particles.position[row]) - pose.position;
        let normal = direction(pose.angle).rotate(way.normal);
        let depth = -way.distance;
        // Only the part of the approach that arose in this substep becomes velocity.
        let moved = wide(particles.displacement[row]) - self.bodies.displacement_at(body, arm);
        let approach = (-moved.dot(normal)).clamp(0.0, depth);
        let response = self.bodies.response(body);
        let lever = arm.perp_dot(normal);
        let own = f64::from(particles.inverse_mass[row]);
        let impulse = approach / (own + response.linear + response.angular * lever * lever);
        particles.displacement[row] += vector(normal * (impulse * own));
        let force = -normal * impulse / (dt * dt);
        self.bodies.load(body, force, arm.perp_dot(force), dt);
        let rest = vector(normal * (depth - approach));
        let place = particles.start[row] + rest + (particles.displacement[row] + particles.remainder[row]);
        let kept = walls.clamp(start, place);
        particles.start[row] += rest + (kept - place);
        particles.position[row] = kept;
        true
    }

    fn find_penetrations(
        &mut self,
        particles: &Particles,
        neighbors: &Neighbors,
        outlines: &Outlines,
        rows: &RowIndex,
    ) {
        let mut found = std::mem::take(&mut self.penetrations);
        found.clear();
        let periodic = neighbors.periodic();
        self.each_sample(rows, |body, _, sample| {
            if sample >= particles.awake() || self.bodies.elasticity(body as usize).is_some() {
                return;
            }
            let (fixed, near) = (self.is_fixed(body), self.near[body as usize]);
            let x = particles.position[sample];
            neighbors.for_each(sample, |row| {
                let apart = periodic.min_image(particles.position[row] - x);
                if is_movable(particles, row) && apart.length_squared() < near * near {
                    found.push(Penetration { row: row as u32, fixed, body });
                }
            });
        });
        self.find_inside(particles, outlines, |row, body| {
            if is_movable(particles, row) {
                found.push(Penetration { row: row as u32, fixed: true, body });
            }
        });
        found.sort_unstable();
        found.dedup();
        self.penetrations = found;
    }

    /// Rows that went far in this substep, and those in the way of a body that did.
    fn find_fast(&self, particles: &Particles) -> Vec<u32> {
        let far = self.far;
        let mut found: Vec<u32> = (0..particles.awake())
            .filter(|&row| particles.displacement[row].length_squared() > far * far && is_movable(particles, row))
            .map(|row| row as u32)
            .collect();
        let slow = found.len();
        for body in 0..self.bodies.len() as u32 {
            let (moved, reach) = (self.bodies.displacements[body as usize], self.bodies.reaches[body as usize]);
            if moved.linear.length() + moved.angular.abs() * reach > f64::from(far) {
                let meets = |&row: &usize| {
                    let (from, to) = (wide(particles.start[row]), wide(particles.position[row]));
                    is_movable(particles, row) && self.comes_near(body, from, to)
                };
                found.extend((0..particles.awake()).filter(meets).map(|row| row as u32));
            }
        }
        if found.len() > slow {
            found.sort_unstable();
            found.dedup();
        }
        found
    }
}

/// A moment of the running substep.
#[derive(Clone, Copy)]
enum End {
    Start,
    Predicted,
}

/// Whether a dense row is a particle that bodies can push.
fn is_movable(particles: &Particles, row: usize) -> bool {
    particles.phase[row] != Phase::Rigid && particles.inverse_mass[row] > 0.0 && row < particles.awake()
}

/// How far from its nearest sample a point of a body can be, where that is on its outline \[m]. Thin parts
/// that do not fit the lattice have few samples.
pub(super) fn widest_gap(body: &Body, spacing: f64) -> f64 {
    let cell = |x: Vector64| ((x.x / spacing).floor() as i64, (x.y / spacing).floor() as i64);
    let mut cells = BTreeMap::<(i64, i64), Vec<Vector64>>::new();
    body.samples.iter().for_each(|&sample| cells.entry(cell(sample)).or_default().push(sample));
    let gap = |x: Vector64| {
        let (column, row) = cell(x);
        let near = (-2..=2).flat_map(|i| (-2..=2).map(move |j| (column + i, row + j)));
        let samples = near.filter_map(|place| cells.get(&place)).flatten();
        samples.map(|sample| (*sample - x).length()).fold(2.0 * spacing, f64::min)
    };
    let corners = body.outline.len();
    let mut widest = 0.0f64;
    for k in 0..corners {
        let (from, to) = (body.outline[k], body.outline[(k + 1) % corners]);
        let steps = (4.0 * (to - from).length() / spacing).ceil().max(1.0);
        (0..steps as u64).for_each(|step| widest = widest.max(gap(from.lerp(to, step as f64 / steps))));
    }
    widest
}

/// The nearest point of a body's outline, in body coordinates.
fn nearest(body: &Body, point: Vector64) -> Nearest {
    if body.radius > 0.0 {
        Shape::Disc { radius: body.radius }.nearest(point)
    } else {
        nearest_on_polygon(&body.outline, point)
    }
}

/// How deep the end of a path lies behind the face that it entered a body by, in body coordinates.
fn crossing(body: &Body, from: Vector64, to: Vector64) -> Option<Nearest> {
    if body.radius <= 0.0 {
        return first_crossing(&body.outline, from, to);
    }
    // |from + t way| = radius.
    let way = to - from;
    let (a, b) = (way.length_squared(), from.dot(way));
    let root = b * b - a * (from.length_squared() - body.radius * body.radius);
    let t = (-b - root.max(0.0).sqrt()) / a;
    if a == 0.0 || root <= 0.0 || !(0.0..=1.0).contains(&t) {
        return None;
    }
    let normal = (from + way * t) / body.radius;
    Some(Nearest { distance: way.dot(normal) * (1.0 - t), normal })
}
