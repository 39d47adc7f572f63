//! Contact manifold of two bodies: one or two points with a common normal, solved together.
//!
//! Impulses are in units of mass times displacement, force times dt^2 [kg m]. Solving the points of a
//! pair at once, and splitting masses among pairs and not points, makes a sweep exact for a box on a
//! floor and halves the split inside a stack. Data read in every sweep is in [`Contact`], data read
//! once or seldom in [`ContactCache`]: sweeps over large heaps are bound by memory.

use super::Depenetration;
use super::bounds::NONE;
use super::complementarity::{self, Coupling, inverse};
use super::contact_cache::{ContactCache, Point, Rebound};
use super::frames::Frame;
use super::push::Push;
use super::relaxation::relaxed;
use super::step_context::StepContext;
use super::touch::{Reference, Touch};
use crate::math::Vector64;
use crate::rigid::{InverseMass, Twist};

/// Constants of a contact within a substep.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(super) struct EffectiveMass {
    /// Inverse effective mass along the normal, with the split masses [1/kg].
    pub normal: Coupling,
    /// Effective mass of each point along the tangent \[kg].
    pub tangent: [f64; 2],
    /// Responses of both bodies to moments [1/(kg m^2)].
    pub turning: (f64, f64),
    /// Sum of the inverse masses [1/kg].
    pub linear: f64,
    /// Coulomb coefficient: static if the sliding speed is low, else kinetic.
    pub friction: f64,
    /// Way of moving surfaces in the substep, along the tangent \[m].
    pub belt: f64,
}

/// Rounds of normal and friction impulses of a new contact.
pub(super) const ROUNDS: usize = 8;

/// One or two points of two bodies with a common normal.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Contact {
    pub a: u32,
    /// Second body; `NONE` for a wall.
    pub b: u32,
    count: u32,
    /// Unit normal, towards the first body.
    pub normal: Vector64,
    points: [Point; 2],
    pub(super) effective_mass: EffectiveMass,
    /// Rolling friction times the rolling radius \[m].
    pub(super) rolling_arm: f64,
    /// Impulse of the rolling resistance [kg m^2].
    pub rolling_impulse: f64,
}

/// The entry of a body, or the default for a wall.
pub(crate) fn entry<T: Copy + Default>(column: &[T], body: u32) -> T {
    column.get(body as usize).copied().unwrap_or_default()
}

/// Result of the normal impulses of an iteration.
pub(crate) struct Pressed {
    /// Displacements of the two bodies before it.
    a: Twist,
    b: Twist,
    pub normal: [f64; 2],
    /// Rotation of the two bodies against each other by these impulses, with the split masses.
    turned: (f64, f64),
}

impl Pressed {
    pub fn total(&self) -> f64 {
        self.normal[0] + self.normal[1]
    }
}

impl Contact {
    pub fn new((a, b): (u32, u32), normal: Vector64, rolling_arm: f64) -> Contact {
        let (points, effective_mass) = ([Point::default(); 2], EffectiveMass::default());
        Contact { a, b, count: 0, normal, points, effective_mass, rolling_arm, rolling_impulse: 0.0 }
    }

    /// In the row of a contact that is over: it has no points.
    pub fn over() -> Contact {
        Contact::new((NONE, NONE), Vector64::ZERO, 0.0)
    }

    /// Whether the numbers of a saved state can be those of a contact.
    pub fn is_sound(&self) -> bool {
        let finite = self.normal.is_finite() && self.rolling_impulse.is_finite() && self.rolling_arm.is_finite();
        self.count <= 2 && finite && self.points.iter().all(Point::is_finite)
    }

    /// Whether a point with this normal can be added.
    pub fn has_room(&self, normal: Vector64) -> bool {
        self.count < 2 && self.is_along(normal)
    }

    /// Whether a point with this normal fits the contact.
    pub fn is_along(&self, normal: Vector64) -> bool {
        self.normal.dot(normal) > 0.9999
    }

    /// Adds a point without impulse.
    pub(super) fn add(&mut self, touch: &Touch, cache: &mut ContactCache, frames: [Frame; 2]) {
        let k = self.count as usize;
        self.points[k] = Point { gap: touch.gap(), ..Point::default() };
        cache.anchors[k] = touch.anchors(frames);
        cache.features[k] = touch.feature;
        self.count += 1;
    }

    /// Measures normal, gaps and arms at the poses of a substep: the anchors are fixed in the bodies.
    pub(super) fn measure(&mut self, cache: &ContactCache, [a, b]: [Frame; 2]) {
        let [radius_a, radius_b] = cache.radii;
        let arms = |k: usize| {
            let (on_a, on_b) = cache.anchors[k];
            (a.rotation.rotate(on_a), b.rotation.rotate(on_b))
        };
        let between = a.position - b.position;
        self.normal = match cache.reference {
            Reference::First => a.rotation.rotate(cache.normal),
            Reference::Second => b.rotation.rotate(cache.normal),
            Reference::Points => {
                let (on_a, on_b) = arms(0);
                (between + on_a - on_b).try_normalize().unwrap_or(self.normal)
            }
        };
        let (normal, tangent) = (self.normal, self.tangent());
        for k in 0..self.count as usize {
            let (on_a, on_b) = arms(k);
            let point = &mut self.points[k];
            point.gap = (between + on_a - on_b).dot(normal) - radius_a - radius_b;
            // The point on the face is the foot of the other point, not the anchor: bodies slide.
            let (arm_a, arm_b) = match cache.reference {
                Reference::Second => (on_a - normal * radius_a, between + on_a - normal * (radius_a + point.gap)),
                Reference::First => (on_b - between + normal * (radius_b + point.gap), on_b + normal * radius_b),
                Reference::Points => (on_a - normal * radius_a, on_b + normal * radius_b),
            };
            (point.normal_a, point.normal_b) = (arm_a.perp_dot(normal), arm_b.perp_dot(normal));
            (point.tangent_a, point.tangent_b) = (arm_a.perp_dot(tangent), arm_b.perp_dot(tangent));
        }
    }

    /// Scales the impulses of the last substep to this one; a point that rebounded starts without.
    pub fn age(&mut self, cache: &mut ContactCache, kept: f64) {
        if cache.surface.restitution == 0.0 {
            self.scale_impulses(kept);
            return;
        }
        self.rolling_impulse *= if cache.rebounded() { 0.0 } else { kept };
        for (point, rebound) in self.points_mut().iter_mut().zip(&mut cache.rebound) {
            let old = *point;
            point.keep(&old, if *rebound == Rebound::default() { kept } else { 0.0 });
            *rebound = Rebound::default();
        }
    }

    pub fn points(&self) -> &[Point] {
        &self.points[..self.count as usize]
    }

    /// Scales the impulses to substeps of another length.
    pub fn scale_impulses(&mut self, factor: f64) {
        self.rolling_impulse *= factor;
        for point in self.points_mut() {
            let old = *point;
            point.keep(&old, factor);
        }
    }

    pub fn points_mut(&mut self) -> &mut [Point] {
        &mut self.points[..self.count as usize]
    }

    /// From the centre of mass of the first body to its surface at a point \[m].
    pub fn arm_a(&self, point: &Point) -> Vector64 {
        self.normal * point.tangent_a - self.tangent() * point.normal_a
    }

    /// Whether it carries a load.
    pub fn is_pressed(&self) -> bool {
        self.points().iter().any(|point| point.normal_impulse > 0.0)
    }

    fn tangent(&self) -> Vector64 {
        self.normal.perp()
    }

    /// Least gap left after a motion of the bodies \[m].
    pub fn gap_after(&self, motion: &[Twist], time: f64) -> f64 {
        let (a, b) = (entry(motion, self.a), entry(motion, self.b));
        let left = |point: &Point| point.gap + (self.opening(point, &a, &b) * time).min(0.0);
        self.points().iter().map(left).fold(f64::INFINITY, f64::min)
    }

    /// Chooses the coefficient of friction by the velocities at the start of a substep, and stores those of a contact
    /// that may rebound. A contact that slides slowly sticks.
    pub(super) fn note_velocities(&mut self, cache: &mut ContactCache, velocities: &[Twist], moment: &StepContext) {
        let surface = &cache.surface;
        self.effective_mass.belt = surface.speed * moment.dt;
        self.effective_mass.friction = surface.static_friction;
        let (alike, elastic) = (surface.static_friction == surface.kinetic_friction, surface.restitution > 0.0);
        if alike && !elastic {
            return;
        }
        let (a, b) = (entry(velocities, self.a), entry(velocities, self.b));
        let slides = |point: &Point| (self.slide(point, &a, &b) - surface.speed).abs() >= moment.slow;
        if !alike && self.points().iter().any(slides) {
            self.effective_mass.friction = surface.kinetic_friction;
        }
        for (k, point) in self.points().iter().enumerate() {
            cache.approach[k] = self.opening(point, &a, &b);
        }
    }

    /// Prepares the equations; `split` are the inverse masses times the splitting factor of each body.
    pub fn prepare(&mut self, split: &[InverseMass]) {
        let (a, b) = (entry(split, self.a), entry(split, self.b));
        let linear = a.linear + b.linear;
        let turning = |pa: f64, qa: f64, pb: f64, qb: f64| pa * qa * a.angular + pb * qb * b.angular;
        let along_normal = |p: &Point, q: &Point| linear + turning(p.normal_a, q.normal_a, p.normal_b, q.normal_b);
        let along_tangent = |p: &Point| linear + turning(p.tangent_a, p.tangent_a, p.tangent_b, p.tangent_b);
        let [p, q] = &self.points;
        let (normal, tangent) = match self.count {
            2 => {
                let coupling = Coupling::of_two(along_normal(p, p), along_normal(q, q), along_normal(p, q));
                (coupling, [inverse(along_tangent(p)), inverse(along_tangent(q))])
            }
            _ => (Coupling::of_one(along_normal(p, p)), [inverse(along_tangent(p)), 0.0]),
        };
        self.effective_mass =
            EffectiveMass { normal, tangent, turning: (a.angular, b.angular), linear, ..self.effective_mass };
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

    /// The push of all impulses of a substep of length `dt` \[s], those of a rebound included [N s].
    pub fn total_push(&self, cache: &ContactCache, dt: f64) -> Push {
        let moment = self.rolling_impulse / dt;
        let mut push = Push { linear: Vector64::ZERO, angular_a: moment, angular_b: moment };
        for (point, rebound) in self.points().iter().zip(&cache.rebound) {
            let (normal, tangent) = (point.normal_impulse / dt, point.tangent_impulse / dt);
            self.add_push(&mut push, point, normal + rebound.normal, tangent + rebound.tangent);
        }
        push
    }

    /// The same of a contact that has not rebounded.
    pub fn steady_push(&self, dt: f64) -> Push {
        let (kept, per_second) = (self.kept_push(), 1.0 / dt);
        Push {
            linear: kept.linear * per_second,
            angular_a: kept.angular_a * per_second,
            angular_b: kept.angular_b * per_second,
        }
    }

    pub fn add_push(&self, push: &mut Push, point: &Point, normal: f64, tangent: f64) {
        push.linear += self.normal * normal + self.tangent() * tangent;
        push.angular_a += point.normal_a * normal + point.tangent_a * tangent;
        push.angular_b += point.normal_b * normal + point.tangent_b * tangent;
    }

    pub(super) fn opening(&self, point: &Point, a: &Twist, b: &Twist) -> f64 {
        (a.linear - b.linear).dot(self.normal) + point.normal_a * a.angular - point.normal_b * b.angular
    }

    pub(super) fn slide(&self, point: &Point, a: &Twist, b: &Twist) -> f64 {
        (a.linear - b.linear).dot(self.tangent()) + point.tangent_a * a.angular - point.tangent_b * b.angular
    }

    /// One iteration: no approach beyond the gap, friction inside Coulomb's cone, rolling resistance. The changes of normal
    /// impulses and friction are taken `relaxation` times.
    pub fn solve(&mut self, displacements: &[Twist], relaxation: f64) -> Push {
        let motion = (entry(displacements, self.a), entry(displacements, self.b));
        // Friction of a tall body turns it: a contact without impulses to start from needs a few rounds for both.
        let is_new = self.count == 2 && !self.is_pressed() && self.effective_mass.friction > 0.0;
        if is_new { self.solve_anew(motion, relaxation) } else { self.solve_once(motion, relaxation) }
    }

    fn solve_anew(&mut self, mut motion: (Twist, Twist), relaxation: f64) -> Push {
        let mut push = Push::default();
        for round in 0..ROUNDS {
            let step = self.solve_once(motion, if round == 0 { relaxation } else { 1.0 });
            push += step;
            let (turns_a, turns_b) = self.effective_mass.turning;
            motion.0.linear += step.linear * self.effective_mass.linear;
            motion.0.angular += step.angular_a * turns_a;
            motion.1.angular -= step.angular_b * turns_b;
        }
        push
    }

    fn solve_once(&mut self, motion: (Twist, Twist), relaxation: f64) -> Push {
        let old = self.points.map(|point| point.normal_impulse);
        let Some(pressed) = self.press(motion, old) else { return Push::default() };
        let normal = relaxed(pressed.normal, old, relaxation);
        let turned = self.turned_by([normal[0] - old[0], normal[1] - old[1]]);
        let pressed = Pressed { normal, turned, ..pressed };
        let mut push = Push::default();
        for (k, old) in old.into_iter().enumerate().take(self.count as usize) {
            let (point, normal) = (self.points[k], pressed.normal[k]);
            let limit = self.effective_mass.friction * normal;
            let tangent = (point.tangent_impulse - relaxation * self.stop(k, &pressed)).clamp(-limit, limit);
            self.add_push(&mut push, &point, normal - old, tangent - point.tangent_impulse);
            (self.points[k].normal_impulse, self.points[k].tangent_impulse) = (normal, tangent);
        }
        self.resist_rolling(&pressed, &mut push);
        push
    }

    /// The normal impulses that leave no approach beyond the gap, in place of the `old` ones; `None` if
    /// there were none and none are needed.
    #[inline]
    pub fn press(&self, (a, b): (Twist, Twist), old: [f64; 2]) -> Option<Pressed> {
        let mut excess = [0.0; 2];
        for (excess, point) in excess.iter_mut().zip(self.points()) {
            *excess = self.opening(point, &a, &b) + point.gap.max(0.0);
        }
        if old == [0.0; 2] && excess[0] >= 0.0 && excess[1] >= 0.0 && self.rolling_impulse == 0.0 {
            return None;
        }
        let normal = complementarity::solve(&self.effective_mass.normal, excess, old, [0.0; 2]);
        Some(Pressed { a, b, normal, turned: self.turned_by([normal[0] - old[0], normal[1] - old[1]]) })
    }

    /// Rotation of the two bodies by changes of the normal impulses, with the split masses.
    pub(super) fn turned_by(&self, change: [f64; 2]) -> (f64, f64) {
        let ([p, q], (turns_a, turns_b)) = (&self.points, self.effective_mass.turning);
        let turned_a = turns_a * (p.normal_a * change[0] + q.normal_a * change[1]);
        let turned_b = turns_b * (p.normal_b * change[0] + q.normal_b * change[1]);
        (turned_a, turned_b)
    }

    /// The tangential impulse that stops the sliding at a point, after the normal impulses.
    pub fn stop(&self, k: usize, pressed: &Pressed) -> f64 {
        let (point, total) = (&self.points[k], pressed.total());
        if total <= 0.0 {
            return 0.0;
        }
        let turned = point.tangent_a * pressed.turned.0 + point.tangent_b * pressed.turned.1;
        // Both points have the same tangential motion: each takes the share of its normal load.
        let share = pressed.normal[k] / total;
        (self.slide(point, &pressed.a, &pressed.b) - self.effective_mass.belt + turned)
            * share
            * self.effective_mass.tangent[k]
    }

    /// Rolling resistance, after the other impulses of the contact have rotated the bodies.
    pub fn resist_rolling(&mut self, pressed: &Pressed, push: &mut Push) {
        if self.rolling_arm == 0.0 {
            return;
        }
        let limit = self.rolling_arm * pressed.total();
        let (a, b) = self.effective_mass.turning;
        let turn = pressed.a.angular - pressed.b.angular + push.angular_a * a + push.angular_b * b;
        let moment = (self.rolling_impulse - turn / (a + b)).clamp(-limit, limit);
        push.angular_a += moment - self.rolling_impulse;
        push.angular_b += moment - self.rolling_impulse;
        self.rolling_impulse = moment;
    }

    /// The push that removes overlap from the positions; `flown` is the way of each point since its rebound \[m], `size`
    /// the size of the smaller body, and `fall` twice the gravity times the square of the substep \[m].
    pub fn separate(
        &self,
        flown: [f64; 2],
        displacements: &[Twist],
        how: &Depenetration,
        size: f64,
        fall: f64,
    ) -> Push {
        let (a, b) = (entry(displacements, self.a), entry(displacements, self.b));
        let mut lacking = [0.0; 2];
        for (k, point) in self.points().iter().enumerate() {
            let gap = point.gap + self.opening(point, &a, &b);
            lacking[k] = if flown[k] > 0.0 { (gap - flown[k]).min(0.0) } else { how.lacking(-gap, size, fall) };
        }
        if lacking == [0.0; 2] {
            return Push::default();
        }
        let normal = complementarity::solve(&self.effective_mass.normal, lacking, [0.0; 2], [0.0; 2]);
        let mut push = Push::default();
        for (point, normal) in self.points().iter().zip(normal) {
            self.add_push(&mut push, point, normal, 0.0);
        }
        push
    }
}
