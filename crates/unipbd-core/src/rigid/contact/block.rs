//! Joints that are a block of equations, with a motor and a range along one of them: hinges with limits, welds,
//! sliders and pulleys.
//!
//! The equations are solved together; motor and limits are one bounded equation each beside them. A limit acts on the
//! way left to it, so that it is met and not passed.

use super::joint::{Joint, JointKind, Limits, Motor};
use super::rows::{Row, solve};
use crate::math::{Vector64, direction};
use crate::rigid::{InverseMass, Pose, Twist};

/// Arms of the two anchors.
type Arms = (Vector64, Vector64);

/// The equations of a joint in a substep, and the impulses of each.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Block {
    used: bool,
    count: usize,
    rows: [Row; 3],
    held: [f64; 3],
    /// The equation that motor and limits act on.
    free: Row,
    /// Its value at the start of the substep.
    value: f64,
    motor: f64,
    limit: f64,
}

/// Errors of a joint at two poses: its equations, and its free coordinate.
struct Measured {
    count: usize,
    rows: [Row; 3],
    errors: [f64; 3],
    free: Row,
    value: f64,
}

impl Block {
    /// Whether the joint is solved by it.
    pub fn is_used(&self) -> bool {
        self.used
    }

    pub fn clear(&mut self) {
        *self = Block::default();
    }

    pub fn is_finite(&self) -> bool {
        let numbers = self.held.into_iter().chain([self.value, self.motor, self.limit]);
        numbers.into_iter().all(f64::is_finite) && self.count <= self.rows.len()
    }

    /// Prepares a substep; impulses are scaled to its length.
    pub fn prepare(&mut self, joint: &Joint, poses: (Pose, Pose), arms: (Arms, Arms), offset: Vector64, scale: f64) {
        let measured = measure(joint, poses, arms, offset);
        self.used = measured.is_some();
        let Some(Measured { count, rows, free, value, .. }) = measured else { return };
        (self.count, self.rows, self.free, self.value) = (count, rows, free, value);
        self.held.iter_mut().for_each(|impulse| *impulse *= scale);
        self.motor *= scale;
        self.limit *= scale;
    }

    /// The pushes of the impulses of the last substep, or of this one so far.
    pub fn kept_pushes(&self) -> (Twist, Twist) {
        let (mut a, mut b) = self.free.push(self.motor + self.limit);
        for (row, &impulse) in self.rows[..self.count].iter().zip(&self.held) {
            let (on_a, on_b) = row.push(impulse);
            a += on_a;
            b += on_b;
        }
        (a, b)
    }

    /// Visits the equations that hold in this substep, with the softness of each; a motor holds while it has strength
    /// left, a limit while it is pressed.
    pub fn each_held(&self, joint: &Joint, dt: f64, mut visit: impl FnMut(Row, f64)) {
        self.rows[..self.count].iter().for_each(|row| visit(*row, 0.0));
        if self.limit != 0.0 || joint.motor().is_some_and(|motor| motor.holds(self.motor, dt)) {
            visit(self.free, 0.0);
        }
    }

    /// One iteration.
    pub fn solve(
        &mut self,
        joint: &Joint,
        mut motion: (Twist, Twist),
        masses: &(InverseMass, InverseMass),
        dt: f64,
    ) -> (Twist, Twist) {
        let mut pushes = (Twist::ZERO, Twist::ZERO);
        let (motor, range) = (joint.motor(), range(&joint.kind));
        if let Some(motor) = motor {
            let old = self.motor;
            self.motor = self.drive(motor, &motion, masses, dt);
            self.add(self.motor - old, &mut motion, masses, &mut pushes);
        }
        if let Some(range) = range {
            let old = self.limit;
            self.limit = self.stop(range, &motion, masses);
            self.add(self.limit - old, &mut motion, masses, &mut pushes);
        }
        self.hold(&motion, masses, &mut pushes);
        pushes
    }

    /// Response of the free equation to its own impulse while the block holds.
    fn weight(&self, masses: &(InverseMass, InverseMass)) -> f64 {
        let rows = &self.rows[..self.count];
        let lost: [f64; 3] = std::array::from_fn(|k| rows.get(k).map_or(0.0, |row| row.response(&self.free, masses)));
        let back = solve(rows, &lost, masses);
        let held: f64 = rows.iter().zip(back).map(|(row, impulse)| self.free.response(row, masses) * impulse).sum();
        self.free.response(&self.free, masses) - held
    }

    /// Motion along the free equation, once the block holds.
    fn moved(&self, motion: &(Twist, Twist), masses: &(InverseMass, InverseMass)) -> f64 {
        let rows = &self.rows[..self.count];
        let apart: [f64; 3] = std::array::from_fn(|k| rows.get(k).map_or(0.0, |row| row.moved(&motion.0, &motion.1)));
        let back = solve(rows, &apart, masses);
        let held: f64 = rows.iter().zip(back).map(|(row, impulse)| self.free.response(row, masses) * impulse).sum();
        self.free.moved(&motion.0, &motion.1) - held
    }

    fn drive(&self, motor: Motor, motion: &(Twist, Twist), masses: &(InverseMass, InverseMass), dt: f64) -> f64 {
        let (weight, most) = (self.weight(masses), motor.max_torque * dt * dt);
        let wanted = if weight > 0.0 { (motor.speed * dt - self.moved(motion, masses)) / weight } else { 0.0 };
        (self.motor + wanted).clamp(-most, most)
    }

    /// The impulse that keeps the free coordinate in its range: none within it.
    fn stop(&self, range: Limits, motion: &(Twist, Twist), masses: &(InverseMass, InverseMass)) -> f64 {
        let weight = self.weight(masses);
        // Nothing moves sleeping bodies: the joint carries what it carried.
        if weight <= 0.0 {
            return self.limit;
        }
        let moved = self.moved(motion, masses);
        let (down, up) = ((self.value - range.least).max(0.0), (range.most - self.value).max(0.0));
        let (lower, upper) = (self.limit - (moved + down) / weight, self.limit - (moved - up) / weight);
        if lower > 0.0 { lower } else { upper.min(0.0) }
    }

    /// Applies an impulse of the free equation to the motion seen by what follows.
    fn add(
        &self,
        impulse: f64,
        motion: &mut (Twist, Twist),
        masses: &(InverseMass, InverseMass),
        pushes: &mut (Twist, Twist),
    ) {
        if impulse != 0.0 {
            push(&self.free, impulse, motion, masses, pushes);
        }
    }

    /// The impulses that end all motion against the block.
    fn hold(&mut self, motion: &(Twist, Twist), masses: &(InverseMass, InverseMass), pushes: &mut (Twist, Twist)) {
        let rows = &self.rows[..self.count];
        let apart: [f64; 3] = std::array::from_fn(|k| rows.get(k).map_or(0.0, |row| -row.moved(&motion.0, &motion.1)));
        let added = solve(rows, &apart, masses);
        let mut seen = *motion;
        for (k, row) in rows.iter().enumerate() {
            push(row, added[k], &mut seen, masses, pushes);
            self.held[k] += added[k];
        }
    }

    /// Position-only pushes that remove half of the drift at these poses.
    pub fn separate(&self, joint: &Joint, poses: (Pose, Pose), masses: &(InverseMass, InverseMass)) -> (Twist, Twist) {
        let arm = |pose: Pose, anchor: Vector64| direction(pose.angle).rotate(anchor);
        let arms = (arm(poses.0, joint.anchor), arm(poses.1, joint.other_anchor));
        let offset = (poses.0.position + arms.0) - (poses.1.position + arms.1);
        let Some(measured) = measure(joint, poses, (arms, arms), offset) else { return (Twist::ZERO, Twist::ZERO) };
        let (mut motion, mut pushes) = ((Twist::ZERO, Twist::ZERO), (Twist::ZERO, Twist::ZERO));
        let wanted = measured.errors.map(|error| -0.5 * error);
        let rows = &measured.rows[..measured.count];
        for (row, impulse) in rows.iter().zip(solve(rows, &wanted, masses)) {
            push(row, impulse, &mut motion, masses, &mut pushes);
        }
        if let Some(range) = range(&joint.kind) {
            let beyond = measured.value - measured.value.clamp(range.least, range.most);
            let block = Block { count: measured.count, rows: measured.rows, free: measured.free, ..*self };
            let weight = block.weight(masses);
            if beyond != 0.0 && weight > 0.0 {
                push(&block.free, -0.5 * beyond / weight, &mut motion, masses, &mut pushes);
                let rows = &block.rows[..block.count];
                let back: [f64; 3] =
                    std::array::from_fn(|k| rows.get(k).map_or(0.0, |row| wanted[k] - row.moved(&motion.0, &motion.1)));
                for (row, impulse) in rows.iter().zip(solve(rows, &back, masses)) {
                    push(row, impulse, &mut motion, masses, &mut pushes);
                }
            }
        }
        pushes
    }
}

fn push(
    row: &Row,
    impulse: f64,
    motion: &mut (Twist, Twist),
    (a, b): &(InverseMass, InverseMass),
    pushes: &mut (Twist, Twist),
) {
    let (on_a, on_b) = row.push(impulse);
    pushes.0 += on_a;
    pushes.1 += on_b;
    motion.0 += Twist { linear: on_a.linear * a.linear, angular: on_a.angular * a.angular };
    motion.1 -= Twist { linear: on_b.linear * b.linear, angular: on_b.angular * b.angular };
}

/// The range of the free coordinate.
fn range(kind: &JointKind) -> Option<Limits> {
    match *kind {
        JointKind::Hinge { limits, .. } | JointKind::Slider { limits, .. } => limits,
        JointKind::Pulley { length, .. } => Some(Limits { least: f64::NEG_INFINITY, most: length }),
        _ => None,
    }
}

/// Equations and errors at these poses; `None` for a kind that is no block.
fn measure(joint: &Joint, (a, b): (Pose, Pose), (arms, middle): (Arms, Arms), offset: Vector64) -> Option<Measured> {
    let point = |along| Row::point(along, arms, middle);
    let turned = a.angle - b.angle;
    let none = Row::default();
    Some(match joint.kind {
        JointKind::Hinge { limits: Some(_), .. } => Measured {
            count: 2,
            rows: [point(Vector64::X), point(Vector64::Y), none],
            errors: [offset.x, offset.y, 0.0],
            free: Row::turn(),
            value: turned,
        },
        JointKind::Weld { angle } => Measured {
            count: 3,
            rows: [point(Vector64::X), point(Vector64::Y), Row::turn()],
            errors: [offset.x, offset.y, turned - angle],
            free: none,
            value: 0.0,
        },
        JointKind::Slider { axis, angle, .. } => {
            let along = direction(b.angle).rotate(axis);
            // The second body is pushed where the first anchor is, so that no couple arises.
            let both = (arms.0, arms.1 + offset);
            let row = |along| Row::point(along, both, both);
            Measured {
                count: 2,
                rows: [row(along.perp()), Row::turn(), none],
                errors: [offset.dot(along.perp()), turned - angle, 0.0],
                free: row(along),
                value: offset.dot(along),
            }
        }
        JointKind::Pulley { wheels, ratio, .. } => {
            let (to_a, to_b) = (a.position + arms.0 - wheels[0], b.position + arms.1 - wheels[1]);
            let unit = |way: Vector64| way.try_normalize().unwrap_or(-Vector64::Y);
            let (along_a, along_b) = (unit(to_a), -unit(to_b) * ratio);
            let moments = |(a, b): Arms| (a.perp_dot(along_a), b.perp_dot(along_b));
            let free = Row { along: (along_a, along_b), apply: moments(arms), measure: moments(middle) };
            let value = to_a.length() + ratio * to_b.length();
            Measured { count: 0, rows: [none; 3], errors: [0.0; 3], free, value }
        }
        _ => return None,
    })
}
