//! One contact point: its equations in terms of the two bodies' displacements.
//!
//! Impulses are in units of mass times displacement, force times dt^2 [kg m].

use super::jacobi::Push;
use crate::bodies::{Response, Surface, Twist};
use crate::math::Vector64;

/// What a contact has carried so far in this substep; kept as the start of the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Impulse {
    pub normal: f64,
    pub tangent: f64,
    /// Moment against rolling [kg m^2].
    pub rolling: f64,
}

impl Impulse {
    pub fn scaled(&self, factor: f64) -> Impulse {
        Impulse { normal: self.normal * factor, tangent: self.tangent * factor, rolling: self.rolling * factor }
    }
}

/// Moment arms and gains that stay the same within a substep.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    normal_a: f64,
    normal_b: f64,
    tangent_a: f64,
    tangent_b: f64,
    /// 1 / (N_A w_A + N_B w_B) along the normal [kg]; the others alike.
    normal_gain: f64,
    tangent_gain: f64,
    rolling_gain: f64,
    /// Tangential displacement by a normal impulse [1/kg].
    coupling: f64,
}

/// A contact point between body `a` and body `b`, or a wall where `b` is `NONE`.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub pair: u32,
    pub a: u32,
    pub b: u32,
    /// The wall touched, or `NONE`.
    pub wall: u32,
    /// Recognises the contact in the next substep.
    pub feature: u32,
    /// Unit normal, towards `a`.
    pub normal: Vector64,
    pub arm_a: Vector64,
    pub arm_b: Vector64,
    /// Distance of the surfaces at the start of the substep [m].
    pub gap: f64,
    pub surface: Surface,
    /// Rolling friction times the radius that rolls [m].
    pub rolling_arm: f64,
    /// Normal velocity at the start of the substep [m/s].
    pub approach: f64,
    pub impulse: Impulse,
    /// Impulse of the rebound [kg m/s]; 0 where nothing rebounded.
    pub rebound: f64,
    row: Row,
}

/// The body's entry, or nothing for a wall.
pub(super) fn entry<T: Copy + Default>(column: &[T], body: u32) -> T {
    column.get(body as usize).copied().unwrap_or_default()
}

/// Limits of a contact between two surfaces.
pub(super) struct Touching {
    pub pair: u32,
    pub bodies: (u32, u32),
    pub wall: u32,
    pub surface: Surface,
    pub rolling_arm: f64,
}

impl Contact {
    pub fn new(touch: &super::narrow::Touch, who: &Touching, centers: (Vector64, Vector64)) -> Contact {
        Contact {
            pair: who.pair,
            a: who.bodies.0,
            b: who.bodies.1,
            wall: who.wall,
            feature: touch.feature,
            normal: touch.normal,
            arm_a: touch.on_a - centers.0,
            arm_b: touch.on_b - centers.1,
            gap: touch.gap,
            surface: who.surface,
            rolling_arm: who.rolling_arm,
            approach: 0.0,
            impulse: Impulse::default(),
            rebound: 0.0,
            row: Row::default(),
        }
    }

    fn tangent(&self) -> Vector64 {
        self.normal.perp()
    }

    /// Relative motion at the contact along the normal, positive when it opens.
    pub fn opening(&self, motion: &[Twist]) -> f64 {
        let (a, b) = (entry(motion, self.a), entry(motion, self.b));
        (a.at(self.arm_a) - b.at(self.arm_b)).dot(self.normal)
    }

    /// Prepares the equations; `split` are the responses times the number of contacts that share a body.
    pub fn prepare(&mut self, split: &[Response]) {
        let (a, b, t) = (entry(split, self.a), entry(split, self.b), self.tangent());
        let (normal_a, normal_b) = (self.arm_a.perp_dot(self.normal), self.arm_b.perp_dot(self.normal));
        let (tangent_a, tangent_b) = (self.arm_a.perp_dot(t), self.arm_b.perp_dot(t));
        let linear = a.linear + b.linear;
        let gain = |weight: f64| if weight > 0.0 { 1.0 / weight } else { 0.0 };
        self.row = Row {
            normal_a,
            normal_b,
            tangent_a,
            tangent_b,
            normal_gain: gain(linear + normal_a * normal_a * a.angular + normal_b * normal_b * b.angular),
            tangent_gain: gain(linear + tangent_a * tangent_a * a.angular + tangent_b * tangent_b * b.angular),
            rolling_gain: if self.rolling_arm > 0.0 { gain(a.angular + b.angular) } else { 0.0 },
            coupling: normal_a * tangent_a * a.angular + normal_b * tangent_b * b.angular,
        };
    }

    /// What an impulse does to the two bodies.
    pub fn push(&self, impulse: &Impulse) -> Push {
        let row = &self.row;
        Push {
            linear: self.normal * impulse.normal + self.tangent() * impulse.tangent,
            angular_a: row.normal_a * impulse.normal + row.tangent_a * impulse.tangent + impulse.rolling,
            angular_b: row.normal_b * impulse.normal + row.tangent_b * impulse.tangent + impulse.rolling,
        }
    }

    fn opening_of(&self, a: &Twist, b: &Twist) -> f64 {
        let row = &self.row;
        (a.linear - b.linear).dot(self.normal) + row.normal_a * a.angular - row.normal_b * b.angular
    }

    /// One iteration: no approach beyond the gap, friction inside Coulomb's cone, rolling resistance.
    pub fn solve(&mut self, displacements: &[Twist]) -> Push {
        let (a, b) = (entry(displacements, self.a), entry(displacements, self.b));
        let (row, old) = (self.row, self.impulse);
        let excess = self.opening_of(&a, &b) + self.gap.max(0.0);
        let normal = (old.normal - excess * row.normal_gain).max(0.0);
        let added = normal - old.normal;
        let slide = (a.linear - b.linear).dot(self.tangent()) + row.tangent_a * a.angular - row.tangent_b * b.angular;
        let tangent = old.tangent - (slide + row.coupling * added) * row.tangent_gain;
        let roll = self.rolling_arm * normal;
        let rolling = (old.rolling - (a.angular - b.angular) * row.rolling_gain).clamp(-roll, roll);
        self.impulse = Impulse { normal, tangent: self.limited(tangent, normal), rolling };
        self.push(&Impulse {
            normal: added,
            tangent: self.impulse.tangent - old.tangent,
            rolling: rolling - old.rolling,
        })
    }

    /// Coulomb: sticks below the static limit, else slides with the kinetic one.
    fn limited(&self, tangent: f64, normal: f64) -> f64 {
        if tangent.abs() <= self.surface.static_friction * normal {
            return tangent;
        }
        let limit = self.surface.kinetic_friction * normal;
        tangent.clamp(-limit, limit)
    }

    /// Whether the contact rebounds: it was hit, and faster than `slowest` [m/s].
    pub fn rebounds(&self, slowest: f64) -> bool {
        self.surface.restitution > 0.0 && self.impulse.normal > 0.0 && self.approach < -slowest
    }

    /// One velocity iteration towards v_n = -e v_before; the whole impulse of the substep stays repulsive.
    pub fn rebound(&mut self, velocities: &[Twist], dt: f64) -> Push {
        let (a, b) = (entry(velocities, self.a), entry(velocities, self.b));
        let lacking = -self.surface.restitution * self.approach - self.opening_of(&a, &b);
        let total = (self.rebound + lacking * self.row.normal_gain).max(-self.impulse.normal / dt);
        let added = total - self.rebound;
        self.rebound = total;
        self.push(&Impulse { normal: added, ..Impulse::default() })
    }

    /// The push that takes half of the overlap beyond `slop` out of the positions, `most` at a time [m].
    pub fn separate(&self, displacements: &[Twist], slop: f64, most: f64) -> Push {
        let (a, b) = (entry(displacements, self.a), entry(displacements, self.b));
        let overlap = -(self.gap + self.opening_of(&a, &b)) - slop;
        let normal = (0.5 * overlap).clamp(0.0, most) * self.row.normal_gain;
        self.push(&Impulse { normal, ..Impulse::default() })
    }
}
