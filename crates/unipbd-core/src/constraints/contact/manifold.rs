//! Where two bodies touch: one or two points with a common normal, solved together.
//!
//! Impulses are in units of mass times displacement, force times dt^2 [kg m]. Solving the points of a
//! pair at once, and splitting masses among pairs and not points, makes a sweep exact for a box on a
//! floor and halves the split inside a stack.

use super::Depenetration;
use super::complementarity::{self, Coupling};
use super::jacobi::Push;
use super::narrow::Touch;
use crate::bodies::{Response, Surface, Twist};
use crate::math::Vector64;

/// One point of a contact.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Point {
    /// Recognises the point in the next substep.
    pub feature: u32,
    /// From the centre of mass of the first body to its surface; from that of the second.
    pub arm_a: Vector64,
    pub arm_b: Vector64,
    /// Distance of the surfaces at the start of the substep [m].
    pub gap: f64,
    /// Normal velocity at the start of the substep [m/s].
    pub approach: f64,
    /// Impulses of this substep, the start of the next.
    pub normal_impulse: f64,
    pub tangent_impulse: f64,
    /// Impulse of the rebound [kg m/s]; 0 where nothing rebounded.
    pub rebound: f64,
    /// Moments about both centres of mass of unit impulses along normal and tangent [m].
    normal_a: f64,
    normal_b: f64,
    tangent_a: f64,
    tangent_b: f64,
}

/// Who touches, and how their surfaces rub and rebound.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Touching {
    pub pair: u32,
    pub a: u32,
    /// Second body; `NONE` for a wall.
    pub b: u32,
    /// The wall touched, or `NONE`.
    pub wall: u32,
    pub surface: Surface,
    /// Rolling friction times the radius that rolls [m].
    pub rolling_arm: f64,
}

/// What stays the same within a substep.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
struct Gains {
    /// Response of the split masses along the normal [1/kg].
    normal: Coupling,
    /// Tangential response of each point to itself [1/kg], and to normal impulses at both.
    tangent: [f64; 2],
    cross: [[f64; 2]; 2],
    /// Responses of both bodies to moments [1/(kg m^2)].
    turning: (f64, f64),
    /// Coulomb coefficient: the static one for what hardly slides, else the kinetic one.
    friction: f64,
}

/// One or two points of two bodies with a common normal.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Contact {
    pub who: Touching,
    /// Unit normal, towards the first body.
    pub normal: Vector64,
    points: [Point; 2],
    count: u32,
    /// Moment against rolling [kg m^2].
    pub rolling_impulse: f64,
    gains: Gains,
}

/// The body's entry, or nothing for a wall.
pub(super) fn entry<T: Copy + Default>(column: &[T], body: u32) -> T {
    column.get(body as usize).copied().unwrap_or_default()
}

/// What the normal impulses of an iteration come to.
struct Pressed {
    /// Displacements of the two bodies before it.
    a: Twist,
    b: Twist,
    normal: [f64; 2],
}

impl Pressed {
    fn total(&self) -> f64 {
        self.normal[0] + self.normal[1]
    }

    fn turn(&self) -> f64 {
        self.a.angular - self.b.angular
    }
}

impl Contact {
    pub fn new(who: &Touching, normal: Vector64) -> Contact {
        let (points, gains) = ([Point::default(); 2], Gains::default());
        Contact { who: who.clone(), normal, points, count: 0, rolling_impulse: 0.0, gains }
    }

    /// Whether one more point with this normal can be added.
    pub fn has_room(&self, normal: Vector64) -> bool {
        self.count < 2 && self.normal.dot(normal) > 0.9999
    }

    pub fn add(&mut self, touch: &Touch, centers: (Vector64, Vector64)) {
        self.points[self.count as usize] = Point {
            feature: touch.feature,
            arm_a: touch.on_a - centers.0,
            arm_b: touch.on_b - centers.1,
            gap: touch.gap,
            ..Point::default()
        };
        self.count += 1;
    }

    pub fn points(&self) -> &[Point] {
        &self.points[..self.count as usize]
    }

    pub fn points_mut(&mut self) -> &mut [Point] {
        &mut self.points[..self.count as usize]
    }

    /// Whether it carries any load.
    pub fn is_pressed(&self) -> bool {
        self.points().iter().any(|point| point.normal_impulse > 0.0)
    }

    fn tangent(&self) -> Vector64 {
        self.normal.perp()
    }

    /// Relative motion at a point, positive along the normal when it opens.
    fn relative(&self, point: &Point, motion: &[Twist]) -> Vector64 {
        entry(motion, self.who.a).at(point.arm_a) - entry(motion, self.who.b).at(point.arm_b)
    }

    /// Least gap left after a motion of the bodies [m].
    pub fn gap_after(&self, motion: &[Twist], time: f64) -> f64 {
        let opening = |point: &Point| self.relative(point, motion).dot(self.normal) * time;
        self.points().iter().map(|point| point.gap + opening(point).min(0.0)).fold(f64::INFINITY, f64::min)
    }

    /// Notes the velocities at the start of a substep. What slides slower than `slow` [m/s] sticks.
    pub fn note_velocities(&mut self, velocities: &[Twist], slow: f64) {
        let mut sliding = 0.0f64;
        for k in 0..self.count as usize {
            let relative = self.relative(&self.points[k], velocities);
            self.points[k].approach = relative.dot(self.normal);
            sliding = sliding.max(relative.dot(self.tangent()).abs());
        }
        let surface = &self.who.surface;
        self.gains.friction = if sliding < slow { surface.static_friction } else { surface.kinetic_friction };
    }

    /// Prepares the equations; `split` are the responses times the share of contacts in each body.
    pub fn prepare(&mut self, split: &[Response]) {
        let (a, b, normal, tangent) = (entry(split, self.who.a), entry(split, self.who.b), self.normal, self.tangent());
        for point in self.points_mut() {
            (point.normal_a, point.normal_b) = (point.arm_a.perp_dot(normal), point.arm_b.perp_dot(normal));
            (point.tangent_a, point.tangent_b) = (point.arm_a.perp_dot(tangent), point.arm_b.perp_dot(tangent));
        }
        let linear = a.linear + b.linear;
        let turning = |pa: f64, qa: f64, pb: f64, qb: f64| pa * qa * a.angular + pb * qb * b.angular;
        let along_normal = |p: &Point, q: &Point| linear + turning(p.normal_a, q.normal_a, p.normal_b, q.normal_b);
        let [p, q] = self.points;
        self.gains.normal = Coupling { first: along_normal(&p, &p), second: 0.0, off: 0.0 };
        if self.count == 2 {
            (self.gains.normal.second, self.gains.normal.off) = (along_normal(&q, &q), along_normal(&p, &q));
        }
        self.gains.tangent = [p, q].map(|p| linear + turning(p.tangent_a, p.tangent_a, p.tangent_b, p.tangent_b));
        let cross = |p: &Point, q: &Point| turning(p.tangent_a, q.normal_a, p.tangent_b, q.normal_b);
        self.gains.cross = [[cross(&p, &p), cross(&p, &q)], [cross(&q, &p), cross(&q, &q)]];
        self.gains.turning = (a.angular, b.angular);
    }

    /// The push of the impulses kept from the last substep.
    pub fn kept_push(&self) -> Push {
        let moment = self.rolling_impulse;
        let mut push = Push { linear: Vector64::ZERO, angular_a: moment, angular_b: moment };
        for point in self.points() {
            self.add_push(&mut push, point, point.normal_impulse, point.tangent_impulse);
        }
        push
    }

    fn add_push(&self, push: &mut Push, point: &Point, normal: f64, tangent: f64) {
        push.linear += self.normal * normal + self.tangent() * tangent;
        push.angular_a += point.normal_a * normal + point.tangent_a * tangent;
        push.angular_b += point.normal_b * normal + point.tangent_b * tangent;
    }

    fn opening(&self, point: &Point, a: &Twist, b: &Twist) -> f64 {
        (a.linear - b.linear).dot(self.normal) + point.normal_a * a.angular - point.normal_b * b.angular
    }

    fn slide(&self, point: &Point, a: &Twist, b: &Twist) -> f64 {
        (a.linear - b.linear).dot(self.tangent()) + point.tangent_a * a.angular - point.tangent_b * b.angular
    }

    /// One iteration: no approach beyond the gap, friction inside Coulomb's cone, rolling resistance.
    pub fn solve(&mut self, displacements: &[Twist]) -> Push {
        let old = self.points.map(|point| point.normal_impulse);
        let pressed = self.press(displacements, old);
        let mut push = Push::default();
        for k in 0..self.count as usize {
            let (point, normal) = (self.points[k], pressed.normal[k]);
            let limit = self.gains.friction * normal;
            let tangent = (point.tangent_impulse - self.stop(k, &pressed, old)).clamp(-limit, limit);
            self.add_push(&mut push, &point, normal - old[k], tangent - point.tangent_impulse);
            (self.points[k].normal_impulse, self.points[k].tangent_impulse) = (normal, tangent);
        }
        if self.who.rolling_arm > 0.0 {
            self.resist_rolling(pressed.turn(), pressed.total(), &mut push);
        }
        push
    }

    /// One iteration on the positions alone, as in Macklin et al. 2014: what lies too deep is taken out, and of the
    /// way the bodies slid past each other what friction holds back for this depth (equations 23 to 25).
    pub fn solve_positions(&mut self, displacements: &[Twist]) -> Push {
        let pressed = self.press(displacements, [0.0; 2]);
        let mut push = Push::default();
        for k in 0..self.count as usize {
            let normal = pressed.normal[k];
            let held = self.who.surface.held_back(self.stop(k, &pressed, [0.0; 2]), normal);
            self.add_push(&mut push, &self.points[k], normal, -held);
            self.points[k].normal_impulse += normal;
            self.points[k].tangent_impulse -= held;
        }
        if self.who.rolling_arm > 0.0 && pressed.total() > 0.0 {
            self.rolling_impulse = 0.0;
            self.resist_rolling(pressed.turn(), pressed.total(), &mut push);
        }
        push
    }

    /// The normal impulses that leave no approach beyond the gap, in place of the `old` ones.
    fn press(&self, displacements: &[Twist], old: [f64; 2]) -> Pressed {
        let (a, b) = (entry(displacements, self.who.a), entry(displacements, self.who.b));
        let excess = self.points.map(|point| self.opening(&point, &a, &b) + point.gap.max(0.0));
        Pressed { a, b, normal: complementarity::solve(&self.gains.normal, excess, old, [0.0; 2]) }
    }

    /// The tangential impulse that ends the sliding at a point, after the normal ones have acted.
    fn stop(&self, k: usize, pressed: &Pressed, old: [f64; 2]) -> f64 {
        let (normal, total, cross) = (pressed.normal, pressed.total(), self.gains.cross[k]);
        let cross = cross[0] * (normal[0] - old[0]) + cross[1] * (normal[1] - old[1]);
        // Points of one line slide alike: each answers for its share of the load.
        let share = if total > 0.0 { normal[k] / total } else { 0.0 };
        (self.slide(&self.points[k], &pressed.a, &pressed.b) + cross) * share / self.gains.tangent[k]
    }

    /// Rolling resistance, after the other impulses of the contact have turned the bodies.
    fn resist_rolling(&mut self, turn: f64, normal: f64, push: &mut Push) {
        let limit = self.who.rolling_arm * normal;
        let (a, b) = self.gains.turning;
        let turn = turn + push.angular_a * a + push.angular_b * b;
        let moment = (self.rolling_impulse - turn / (a + b)).clamp(-limit, limit);
        push.angular_a += moment - self.rolling_impulse;
        push.angular_b += moment - self.rolling_impulse;
        self.rolling_impulse = moment;
    }

    fn point_rebounds(&self, point: &Point, slowest: f64) -> bool {
        point.normal_impulse > 0.0 && point.approach < -slowest
    }

    /// Whether the contact rebounds: it was hit faster than `slowest` [m/s].
    pub fn rebounds(&self, slowest: f64) -> bool {
        self.who.surface.restitution > 0.0 && self.points().iter().any(|point| self.point_rebounds(point, slowest))
    }

    /// One velocity iteration towards v_n = -e v_before; the whole impulse of the substep stays repulsive.
    pub fn rebound(&mut self, velocities: &[Twist], dt: f64, slowest: f64) -> Push {
        let (a, b) = (entry(velocities, self.who.a), entry(velocities, self.who.b));
        let points = self.points;
        let acts = points.map(|point| self.point_rebounds(&point, slowest));
        let excess = points.map(|point| self.opening(&point, &a, &b) + self.who.surface.restitution * point.approach);
        let Coupling { first, second, off } = self.gains.normal;
        let keep = |acts: bool, gain: f64| if acts { gain } else { 0.0 };
        let coupling = Coupling { first: keep(acts[0], first), second: keep(acts[1], second), off };
        let (old, lower) = (points.map(|point| point.rebound), points.map(|point| -point.normal_impulse / dt));
        let total = complementarity::solve(&coupling, excess, old, lower);
        let mut push = Push::default();
        for k in 0..self.count as usize {
            self.add_push(&mut push, &points[k], total[k] - old[k], 0.0);
            self.points[k].rebound = total[k];
        }
        push
    }

    /// The push that takes overlap out of the positions; `size` is that of the smaller body [m].
    pub fn separate(&self, displacements: &[Twist], how: &Depenetration, size: f64, dt: f64) -> Push {
        let (a, b) = (entry(displacements, self.who.a), entry(displacements, self.who.b));
        let overlap = self.points.map(|point| -(point.gap + self.opening(&point, &a, &b)) - how.slop * size);
        if overlap[0] <= 0.0 && overlap[1] <= 0.0 {
            return Push::default();
        }
        let lacking = overlap.map(|overlap| {
            let deep = (overlap - how.deep * size).max(0.0);
            -(how.fraction * overlap + (how.deep_fraction - how.fraction) * deep).clamp(0.0, how.speed * dt)
        });
        let normal = complementarity::solve(&self.gains.normal, lacking, [0.0; 2], [0.0; 2]);
        let mut push = Push::default();
        for (point, normal) in self.points().iter().zip(normal) {
            self.add_push(&mut push, point, normal, 0.0);
        }
        push
    }
}
