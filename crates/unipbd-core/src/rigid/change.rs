//! Changes of bodies while a run goes on: properties, place, removal.

use super::derived::Derived;
use super::{Bodies, BodyKind, BodySpec, InverseMass, MassSpec, Pose, Rotation, Twist};
use crate::math::{Vector64, direction};
use crate::shapes::Shape;

/// Corners of an outline at most.
const MOST_CORNERS: usize = 1 << 16;
/// Cells of the lattice in the box around a body at most.
const MOST_CELLS: f64 = 1e8;

/// Properties of a body to be changed; those that are `None` stay.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyChange {
    /// Whether forces, its motion or nothing moves it; a body that becomes kinematic keeps its velocity.
    pub kind: Option<BodyKind>,
    /// Outline, about the centre of mass, which stays where it is. The mass follows from the density where the body has
    /// one, else it stays; the inertia follows from both.
    pub shape: Option<Shape>,
    /// Mass, with the inertia in proportion \[kg].
    pub mass: Option<f64>,
    /// Coulomb friction coefficient, at rest and sliding.
    pub friction: Option<f64>,
    /// Rolling resistance.
    pub rolling_friction: Option<f64>,
    /// Rebound speed over impact speed.
    pub restitution: Option<f64>,
    /// Speed of the surface along the outline [m/s].
    pub surface_speed: Option<f64>,
    /// Factor on gravity.
    pub gravity_factor: Option<f64>,
    /// Rate at which the velocity decays [1/s].
    pub linear_damping: Option<f64>,
    /// Rate at which the angular velocity decays [1/s].
    pub angular_damping: Option<f64>,
    /// Collision layers the body is in, one bit each.
    pub layers: Option<u32>,
    /// Collision layers it collides with, one bit each.
    pub collides_with: Option<u32>,
    /// Collision group.
    pub collision_group: Option<i32>,
    /// A number of the caller's own.
    pub user_data: Option<u64>,
}

fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

impl BodyChange {
    /// Makes the changes in a specification.
    fn apply(&self, spec: &mut BodySpec) {
        set(&mut spec.kind, self.kind);
        set(&mut spec.shape, self.shape.clone());
        set(&mut spec.mass, self.mass.map(MassSpec::Mass));
        set(&mut spec.surface.static_friction, self.friction);
        set(&mut spec.surface.kinetic_friction, self.friction);
        set(&mut spec.surface.rolling_friction, self.rolling_friction);
        set(&mut spec.surface.restitution, self.restitution);
        set(&mut spec.surface.speed, self.surface_speed);
        set(&mut spec.gravity_factor, self.gravity_factor);
        set(&mut spec.damping.linear, self.linear_damping);
        set(&mut spec.damping.angular, self.angular_damping);
        set(&mut spec.filter.layers, self.layers);
        set(&mut spec.filter.collides_with, self.collides_with);
        set(&mut spec.filter.group, self.collision_group);
        set(&mut spec.user_data, self.user_data);
    }
}

impl Bodies {
    /// The same bodies as these specifications describe, where they start; `None` if one makes no sense.
    pub(crate) fn with_saved_specs(&self, saved: &Bodies) -> Option<Bodies> {
        let mut bodies = Bodies::new(self.spacing);
        let removed = saved.views.iter().map(|view| view.removed);
        if saved.views.len() != saved.specs.len() {
            return None;
        }
        for (spec, removed) in saved.specs.iter().zip(removed) {
            if !spec.is_sound(self.spacing) {
                return None;
            }
            let id = bodies.add(spec.clone()).ok()?;
            if removed {
                bodies.remove(id);
            }
        }
        Some(bodies)
    }

    /// The specification of each body.
    pub(crate) fn specifications(&self) -> &[BodySpec] {
        &self.specs
    }

    /// Whether both were made from the same specifications.
    pub(crate) fn has_specs_of(&self, other: &Bodies) -> bool {
        let gone = |bodies: &Bodies| bodies.views.iter().map(|view| view.removed).collect::<Vec<_>>();
        self.specs == other.specs && gone(self) == gone(other)
    }

    /// Takes a body away. Its number stays its own, without a shape.
    pub(crate) fn remove(&mut self, id: u32) {
        let k = id as usize;
        let pose = self.poses[k];
        let name = std::mem::take(&mut self.specs[k].name);
        let spec =
            BodySpec { name, kind: BodyKind::Static, pose, ..BodySpec::new(Shape::Disc { radius: self.spacing }) };
        self.specs[k] = spec;
        self.derive_again(k);
        (self.poses[k], self.velocities[k], self.displacements[k]) = (pose, Twist::ZERO, Twist::ZERO);
        (self.contact_loads[k], self.fluid_loads[k]) = (Twist::ZERO, Twist::ZERO);
        (self.asleep[k], self.pushed[k]) = (false, false);
        self.cores[k].pieces.clear();
        let view = &mut self.views[k];
        (view.outline, view.samples, view.radius) = (Vec::new(), Vec::new(), 0.0);
        (view.mass, view.inertia, view.removed) = (0.0, 0.0, true);
        self.refresh_view(k);
    }

    /// Takes away what a body touches others with, until its shape is changed.
    pub(crate) fn hollow(&mut self, id: u32) {
        self.cores[id as usize].pieces.clear();
    }

    /// Changes properties of a body; it goes on where it is. A sleeping body wakes at the next substep. `time` is now \[s].
    pub(crate) fn change(&mut self, id: u32, change: &BodyChange, time: f64) {
        let k = id as usize;
        let velocity = self.velocities[k];
        change.apply(&mut self.specs[k]);
        self.derive_again(k);
        self.pushed[k] = true;
        match self.views[k].kind {
            BodyKind::Static => self.velocities[k] = Twist::ZERO,
            BodyKind::Kinematic if change.kind.is_some() => self.scripts[k].driven = Some(velocity),
            _ => {}
        }
        self.find_mover(k);
        if change.shape.is_some() {
            // The outline has another origin: a script goes on from there.
            self.place(id, self.poses[k], time);
        }
        self.refresh_view(k);
    }

    /// Computes what follows from the specification of a body anew, but for its motion.
    fn derive_again(&mut self, k: usize) {
        // The shape was checked when the body was added.
        let Ok(derived) = Derived::of(&self.specs[k], self.spacing) else { return };
        let driven = self.scripts[k].driven;
        self.awake_responses[k] = derived.response;
        self.asleep[k] &= derived.response != InverseMass::default();
        self.inverse_masses[k] = if self.asleep[k] { InverseMass::default() } else { derived.response };
        (self.cores[k], self.reaches[k], self.sizes[k]) = (derived.core, derived.reach, derived.size);
        self.scripts[k] = derived.script;
        self.scripts[k].driven = driven;
        let old = std::mem::replace(&mut self.views[k], derived.view);
        let view = &mut self.views[k];
        (view.fluid_force, view.fluid_torque) = (old.fluid_force, old.fluid_torque);
        (view.contact_force, view.contact_torque) = (old.contact_force, old.contact_torque);
        view.removed = old.removed;
        self.find_mover(k);
    }

    /// Puts the centre of mass of a body somewhere else, at once. A kinematic body goes on from there. `time` is now \[s].
    pub(crate) fn place(&mut self, id: u32, pose: Pose, time: f64) {
        let k = id as usize;
        self.poses[k] = pose;
        if let Some(previous) = self.previous.get_mut(k) {
            *previous = pose;
        }
        self.pushed[k] = self.is_dynamic(k);
        let script = &self.scripts[k];
        let origin = Pose { position: pose.apply(script.origin), angle: pose.angle };
        let moved = script.motion.displacement(time);
        let start = Pose { position: origin.position - moved.linear, angle: origin.angle - moved.angular };
        (self.specs[k].pose, self.scripts[k].start) = (start, start);
        self.refresh_view(k);
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.previous.clone_from(&self.poses);
    }

    /// Poses between the start of the last frame (0) and its end (1).
    pub(crate) fn interpolated(&self, part: f64) -> Vec<Pose> {
        let between = |(k, now): (usize, &Pose)| {
            let was = self.previous.get(k).unwrap_or(now);
            let (way, turn) = (now.position - was.position, now.angle - was.angle);
            Pose { position: was.position + way * part, angle: was.angle + turn * part }
        };
        self.poses.iter().enumerate().map(between).collect()
    }

    /// Lets the script of a new body begin now, where the body was put. `time` is now \[s].
    pub(crate) fn rebase(&mut self, id: u32, time: f64) {
        let (pose, k) = (self.poses[id as usize], id as usize);
        self.place(id, pose, time);
        if self.views[k].kind == BodyKind::Kinematic {
            let script = &self.scripts[k];
            self.velocities[k] = script.motion.velocity(time).moved_to(direction(pose.angle).rotate(-script.origin));
            self.refresh_view(k);
        }
    }

    /// Changes the velocity of a dynamic body by an impulse [N s] at a point of the world \[m].
    pub(crate) fn strike(&mut self, id: u32, impulse: Vector64, point: Vector64) {
        let k = id as usize;
        let (response, arm) = (self.awake_responses[k], point - self.poses[k].position);
        self.velocities[k].linear += impulse * response.linear;
        self.velocities[k].angular += arm.perp_dot(impulse) * response.angular;
        self.pushed[k] = true;
        self.refresh_view(k);
    }
}

impl BodySpec {
    /// Whether a body can be made from a specification that was read from somewhere, without a problem of size.
    fn is_sound(&self, spacing: f64) -> bool {
        let corners = match &self.shape {
            Shape::Disc { .. } => 0,
            Shape::Polygon(corners) => corners.len(),
        };
        if corners > MOST_CORNERS || self.shape.check().is_err() {
            return false;
        }
        let (low, high) = self.shape.bounds();
        let cells = (high.x - low.x) / spacing * ((high.y - low.y) / spacing);
        let mass = match self.mass {
            MassSpec::Density(value) | MassSpec::Mass(value) => value,
        };
        let surface = &self.surface;
        let coefficients = [surface.static_friction, surface.kinetic_friction, surface.rolling_friction];
        let rates = [self.damping.linear, self.damping.angular];
        let finite = [self.pose.angle, self.velocity.angular, surface.speed, self.gravity_factor];
        let positive = |value: f64| value > 0.0 && value.is_finite();
        cells < MOST_CELLS
            && positive(mass)
            && self.pose.position.is_finite()
            && self.velocity.linear.is_finite()
            && finite.into_iter().all(f64::is_finite)
            && coefficients.into_iter().chain(rates).all(|value| value >= 0.0 && value.is_finite())
            && (0.0..=1.0).contains(&surface.restitution)
            && self.motion.is_finite()
            && matches!(self.rotation, Rotation::Free | Rotation::Locked)
    }
}
