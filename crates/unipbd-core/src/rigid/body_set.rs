//! All bodies of a run: state as columns, and the specification of each body.

use super::derived::{Derived, InverseMass, Mover, Script};
use super::{Body, BodyKind, BodySpec, Elasticity, Pose, Twist};
use crate::math::Vector64;
use crate::shapes::{Core, ShapeError};
use std::f64::consts::{PI, TAU};

/// All bodies of a run. A body's index is its id: it stays when others are taken away.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Bodies {
    /// Distance of lattice samples \[m].
    pub(super) spacing: f64,
    pub(crate) poses: Vec<Pose>,
    pub(crate) velocities: Vec<Twist>,
    /// Poses at the start of the frame; not part of a state.
    #[serde(skip)]
    pub(super) previous: Vec<Pose>,
    /// Displacement u over the running substep.
    pub(crate) displacements: Vec<Twist>,
    /// Inverse mass of each body when awake.
    pub(crate) awake_responses: Vec<InverseMass>,
    /// The same, but 0 while asleep.
    pub(crate) inverse_masses: Vec<InverseMass>,
    pub(crate) asleep: Vec<bool>,
    /// Elasticity of bodies made of particles with shape matching: their pose follows the particles.
    pub(super) matched: Vec<Option<Elasticity>>,
    /// Contacts and joints: sum of impulses since the start of the frame [N s], [N m s].
    pub(crate) contact_loads: Vec<Twist>,
    pub(super) fluid_loads: Vec<Twist>,
    /// Whether the fluid or a caller has pushed the body since the start of the frame.
    pub(crate) pushed: Vec<bool>,
    pub(crate) cores: Vec<Core>,
    /// Largest distance of a point of the body from its centre of mass \[m].
    pub(crate) reaches: Vec<f64>,
    /// Square root of the area \[m].
    pub(crate) sizes: Vec<f64>,
    pub(super) scripts: Vec<Script>,
    /// The cause of the motion of each body; follows from the other columns.
    #[serde(skip)]
    pub(super) movers: Vec<Mover>,
    pub(super) views: Vec<Body>,
    /// The specification of each body, with all changes since.
    pub(super) specs: Vec<BodySpec>,
}

impl Bodies {
    /// An empty set; `spacing` is the rest distance of particles \[m].
    pub fn new(spacing: f64) -> Bodies {
        Bodies { spacing, ..Bodies::default() }
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// Adds a body and returns its id.
    pub fn add(&mut self, spec: BodySpec) -> Result<u32, ShapeError> {
        let derived = Derived::of(&spec, self.spacing)?;
        self.poses.push(derived.pose);
        self.velocities.push(derived.velocity);
        self.displacements.push(Twist::ZERO);
        self.awake_responses.push(derived.response);
        self.inverse_masses.push(derived.response);
        self.asleep.push(false);
        self.matched.push(derived.matched);
        self.contact_loads.push(Twist::ZERO);
        self.fluid_loads.push(Twist::ZERO);
        self.pushed.push(false);
        self.cores.push(derived.core);
        self.reaches.push(derived.reach);
        self.sizes.push(derived.size);
        self.scripts.push(derived.script);
        self.views.push(derived.view);
        self.specs.push(spec);
        let id = self.len() - 1;
        self.movers.push(Mover::Nothing);
        self.find_mover(id);
        self.refresh_view(id);
        Ok(id as u32)
    }

    /// Finds out what moves a body, after a change of its kind or script.
    pub(super) fn find_mover(&mut self, id: usize) {
        self.movers[id] = Mover::of(&self.views[id], self.matched[id].is_some(), &self.scripts[id]);
    }

    /// The body of this name, unless it was taken away.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.views.iter().position(|body| body.name == name && !body.removed).map(|id| id as u32)
    }

    /// Whether both sets hold bodies of the same shapes and names, possibly at different times.
    pub(crate) fn is_like(&self, other: &Bodies) -> bool {
        let bodies = self.len();
        let same_kind = self.matched == other.matched;
        let twists = [&self.velocities, &self.displacements, &self.contact_loads, &self.fluid_loads];
        let inverse_masses = [&self.awake_responses, &self.inverse_masses];
        let whole = twists.iter().all(|column| column.len() == bodies)
            && inverse_masses.iter().all(|column| column.len() == bodies)
            && [&self.reaches, &self.sizes].iter().all(|column| column.len() == bodies)
            && [&self.asleep, &self.pushed].iter().all(|column| column.len() == bodies)
            && self.cores == other.cores
            && self.scripts.len() == bodies
            && self.specs.len() == bodies;
        let same = |(a, b): (&Body, &Body)| {
            a.name == b.name && a.removed == b.removed && a.kind == b.kind && a.samples.len() == b.samples.len()
        };
        whole
            && same_kind
            && self.views.len() == bodies
            && bodies == other.len()
            && self.views.iter().zip(&other.views).all(same)
    }

    /// Readable state of the bodies, in id order; up to date after [`Bodies::finish_frame`].
    pub fn views(&self) -> &[Body] {
        &self.views
    }

    /// Centre of mass and angle.
    pub fn pose(&self, id: u32) -> Pose {
        self.poses[id as usize]
    }

    /// Predicted pose at the end of the running substep.
    pub fn predicted_pose(&self, id: u32) -> Pose {
        let (pose, moved) = (self.poses[id as usize], self.displacements[id as usize]);
        Pose { position: pose.position + moved.linear, angle: pose.angle + moved.angular }
    }

    /// Velocity of the centre of mass and angular velocity.
    pub fn velocity(&self, id: u32) -> Twist {
        self.velocities[id as usize]
    }

    /// Velocity of the body at a point in world coordinates [m/s].
    pub fn velocity_at(&self, id: u32, point: Vector64) -> Vector64 {
        self.velocities[id as usize].at(point - self.poses[id as usize].position)
    }

    /// Displacement of the body in the running substep at `arm` from its centre of mass \[m].
    pub(crate) fn displacement_at(&self, id: u32, arm: Vector64) -> Vector64 {
        self.displacements[id as usize].at(arm)
    }

    /// Predicted displacement in the running substep \[m], \[rad].
    pub(crate) fn predicted_displacement(&self, id: u32) -> Twist {
        self.displacements[id as usize]
    }

    /// Lattice samples in body coordinates \[m].
    pub fn samples(&self, id: u32) -> &[Vector64] {
        &self.views[id as usize].samples
    }

    /// Inverse mass and inertia for constraints: 0 for a sleeping or kinematic body.
    pub fn response(&self, id: u32) -> InverseMass {
        self.inverse_masses[id as usize]
    }

    /// The inverse masses of all bodies.
    pub(crate) fn inverse_masses(&self) -> &[InverseMass] {
        &self.inverse_masses
    }

    /// Whether a body is asleep.
    pub fn is_asleep(&self, id: u32) -> bool {
        self.asleep[id as usize]
    }

    /// Whether contacts or forces can move it.
    pub(crate) fn is_dynamic(&self, id: usize) -> bool {
        self.movers[id] == Mover::Pushes
    }

    /// Elasticity of a body with shape matching.
    pub(crate) fn elasticity(&self, id: usize) -> Option<Elasticity> {
        self.matched[id]
    }

    /// Acceleration of a dynamic body by gravity [m/s^2].
    pub(crate) fn pull(&self, id: usize, gravity: Vector64) -> Vector64 {
        if self.is_dynamic(id) { gravity * self.scripts[id].gravity_factor } else { Vector64::ZERO }
    }

    /// Sets pose and velocity of a body made of particles from its particles, and the outline of a soft body.
    pub(crate) fn follow(&mut self, id: usize, pose: Pose, velocity: Twist, outline: Option<Vec<Vector64>>) {
        let turn = (pose.angle - self.poses[id].angle + PI).rem_euclid(TAU) - PI;
        self.poses[id] = Pose { angle: self.poses[id].angle + turn, ..pose };
        self.velocities[id] = velocity;
        self.views[id].outline = outline.unwrap_or_else(|| std::mem::take(&mut self.views[id].outline));
    }

    /// Whether it may move in the next substep.
    #[inline]
    pub(crate) fn is_active(&self, id: usize) -> bool {
        match self.movers[id] {
            Mover::Pushes => !self.asleep[id],
            Mover::Script => true,
            Mover::Nothing => false,
        }
    }

    /// Predicts the displacements of a substep: u = dt v + dt^2 g, or the prescribed motion.
    /// `time` is the start of the substep \[s].
    pub fn predict(&mut self, dt: f64, time: f64, gravity: Vector64) {
        for id in 0..self.len() {
            self.displacements[id] = match self.movers[id] {
                Mover::Pushes if !self.asleep[id] => {
                    let pull = gravity * self.scripts[id].gravity_factor;
                    self.scripts[id].damping.moved(&self.velocities[id], pull, dt)
                }
                Mover::Script => match self.scripts[id].driven {
                    Some(velocity) => velocity.scaled(dt),
                    None => self.kinematic_displacement(id, time + dt),
                },
                _ => Twist::ZERO,
            };
        }
    }

    fn kinematic_displacement(&self, id: usize, time: f64) -> Twist {
        let script = &self.scripts[id];
        if script.motion.is_still() {
            return Twist::ZERO;
        }
        let origin = script.motion.pose(script.start, time);
        let now = self.poses[id];
        Twist { linear: origin.apply(-script.origin) - now.position, angular: origin.angle - now.angle }
    }

    /// Adds to the displacement of a body in the running substep \[m], \[rad].
    pub fn push(&mut self, id: u32, linear: Vector64, angular: f64) {
        self.displacements[id as usize] += Twist { linear, angular };
        self.pushed[id as usize] = true;
    }

    /// Moves a body \[m], \[rad] without a change of its velocity.
    pub fn shift(&mut self, id: u32, linear: Vector64, angular: f64) {
        let pose = &mut self.poses[id as usize];
        pose.position += linear;
        pose.angle += angular;
    }

    /// Applies a force and a torque about the centre of mass to a body over a substep of length `dt`,
    /// and records both as fluid loads. Accepts any kind of body; only dynamic bodies move.
    pub fn load(&mut self, id: u32, force: Vector64, torque: f64, dt: f64) {
        let response = self.inverse_masses[id as usize];
        self.push(id, force * (response.linear * dt * dt), torque * response.angular * dt * dt);
        self.fluid_loads[id as usize] += Twist { linear: force * dt, angular: torque * dt };
    }

    /// Takes back what the fluid did to the bodies in the running substep: they stay where they are, and feel no load.
    pub(crate) fn hold(&mut self) {
        self.displacements.fill(Twist::ZERO);
        self.fluid_loads.fill(Twist::ZERO);
    }

    /// Ends a substep: x = x_n + u, v = u/dt.
    pub fn integrate(&mut self, dt: f64) {
        for id in 0..self.len() {
            if self.is_active(id) {
                let moved = self.displacements[id];
                self.poses[id].position += moved.linear;
                self.poses[id].angle += moved.angular;
                self.velocities[id] = moved.scaled(1.0 / dt);
            }
        }
    }

    /// Ends a frame of length `frame_time` \[s]: updates mean loads and the readable state.
    pub fn finish_frame(&mut self, frame_time: f64) {
        for id in 0..self.len() {
            let fluid = std::mem::take(&mut self.fluid_loads[id]).scaled(1.0 / frame_time);
            let contact = std::mem::take(&mut self.contact_loads[id]).scaled(1.0 / frame_time);
            // A sleeping body keeps the loads from the time it fell asleep.
            if !self.asleep[id] || !self.views[id].asleep {
                (self.views[id].fluid_force, self.views[id].fluid_torque) = (fluid.linear, fluid.angular);
                (self.views[id].contact_force, self.views[id].contact_torque) = (contact.linear, contact.angular);
            }
            self.pushed[id] = false;
            self.refresh_view(id);
        }
    }

    /// Puts a body to sleep: its velocity is zero, and pushes do not move it.
    pub(crate) fn fall_asleep(&mut self, id: usize) {
        self.asleep[id] = true;
        self.inverse_masses[id] = InverseMass::default();
        self.velocities[id] = Twist::ZERO;
        self.displacements[id] = Twist::ZERO;
    }

    /// Wakes one body; [`Contacts`](crate::rigid::contact::Contacts) wakes whole islands.
    pub(crate) fn wake(&mut self, id: usize) {
        self.asleep[id] = false;
        self.inverse_masses[id] = self.awake_responses[id];
    }

    /// Sets the velocity of a body. A sleeping dynamic body is woken with its island at the next substep; a
    /// kinematic body keeps this velocity in place of its prescribed motion until another velocity is set.
    pub fn set_velocity(&mut self, id: u32, velocity: Twist) {
        let id = id as usize;
        match self.views[id].kind {
            BodyKind::Dynamic => self.pushed[id] = true,
            BodyKind::Kinematic => self.scripts[id].driven = Some(velocity),
            BodyKind::Static => return,
        }
        self.find_mover(id);
        self.velocities[id] = velocity;
        self.refresh_view(id);
    }

    /// Applies a force \[N] and a torque about the centre of mass [N m] to a dynamic body over the
    /// next substep of length `dt`. A sleeping body is woken.
    pub fn accelerate(&mut self, id: u32, force: Vector64, torque: f64, dt: f64) {
        let response = self.awake_responses[id as usize];
        let change = Twist { linear: force * (response.linear * dt), angular: torque * (response.angular * dt) };
        if change != Twist::ZERO {
            self.velocities[id as usize] += change;
            self.pushed[id as usize] = true;
        }
    }

    /// The first body whose pose or velocity is not finite.
    pub(crate) fn first_not_finite(&self) -> Option<usize> {
        let finite = |linear: Vector64, angular: f64| linear.is_finite() && angular.is_finite();
        self.poses.iter().zip(&self.velocities).position(|(pose, velocity)| {
            !finite(pose.position, pose.angle) || !finite(velocity.linear, velocity.angular)
        })
    }

    /// Brings the readable state of all bodies up to date.
    pub(crate) fn refresh_views(&mut self) {
        (0..self.len()).for_each(|id| self.refresh_view(id));
    }

    pub(super) fn refresh_view(&mut self, id: usize) {
        let view = &mut self.views[id];
        (view.position, view.angle) = (self.poses[id].position, self.poses[id].angle);
        (view.velocity, view.angular_velocity) = (self.velocities[id].linear, self.velocities[id].angular);
        view.asleep = self.asleep[id];
    }
}
