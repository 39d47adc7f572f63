//! Quantities that follow from the specification of a body: mass, outline, samples, script.

use super::{Body, BodyKind, BodySpec, Damping, Elasticity, MassSpec, Motion, Pose, Rotation, Twist};
use crate::math::{Vector64, direction};
use crate::shapes::{Core, Samples, Shape, ShapeError};

/// Response of a body to a push: its inverse mass and inertia, both 0 for an immovable body.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct InverseMass {
    /// Inverse mass [1/kg].
    pub linear: f64,
    /// Inverse moment of inertia [1/(kg m^2)].
    pub angular: f64,
}

/// Constant data of a body.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(super) struct Script {
    /// Pose of the outline's origin at time zero.
    pub(super) start: Pose,
    /// Origin of the outline relative to the centre of mass, in body coordinates.
    pub(super) origin: Vector64,
    pub(super) motion: Motion,
    /// Velocity of a kinematic body set by a caller: it replaces the prescribed motion from then on.
    pub(super) driven: Option<Twist>,
    pub(super) gravity_factor: f64,
    pub(super) damping: Damping,
}

/// The cause of the motion of a body: one byte, read in every loop over bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Mover {
    /// Contacts and forces.
    Pushes,
    /// Its script, or a velocity that a caller has set.
    Script,
    /// Nothing, or particles.
    #[default]
    Nothing,
}

impl Mover {
    pub fn of(view: &Body, matched: bool, script: &Script) -> Mover {
        match view.kind {
            BodyKind::Dynamic if !matched => Mover::Pushes,
            BodyKind::Kinematic if script.driven.is_some() || !script.motion.is_still() => Mover::Script,
            _ => Mover::Nothing,
        }
    }
}

/// Quantities that follow from the specification of a body.
pub(super) struct Derived {
    pub pose: Pose,
    pub velocity: Twist,
    pub response: InverseMass,
    pub matched: Option<Elasticity>,
    pub core: Core,
    pub reach: f64,
    pub size: f64,
    pub script: Script,
    pub view: Body,
}

impl Derived {
    pub fn of(spec: &BodySpec, spacing: f64) -> Result<Derived, ShapeError> {
        spec.shape.check()?;
        let outline = spec.shape.tidied();
        let moments = outline.moments();
        let shape = outline.translated(-moments.centroid);
        let mass = match spec.mass {
            MassSpec::Density(density) => density * moments.area,
            MassSpec::Mass(mass) => mass,
        };
        let inertia = mass * moments.second / moments.area;
        let matched = spec.matched.filter(|_| spec.kind == BodyKind::Dynamic);
        let response = match (spec.kind, spec.rotation) {
            _ if matched.is_some() => InverseMass::default(),
            (BodyKind::Dynamic, Rotation::Free) => InverseMass { linear: 1.0 / mass, angular: 1.0 / inertia },
            (BodyKind::Dynamic, Rotation::Locked) => InverseMass { linear: 1.0 / mass, angular: 0.0 },
            _ => InverseMass::default(),
        };
        let motion = if spec.kind == BodyKind::Kinematic { spec.motion.clone() } else { Motion::Still };
        let is_driven = spec.kind == BodyKind::Kinematic && motion.is_still() && spec.velocity != Twist::ZERO;
        let velocity = match spec.kind {
            BodyKind::Dynamic if spec.rotation == Rotation::Locked => Twist { angular: 0.0, ..spec.velocity },
            BodyKind::Dynamic => spec.velocity,
            _ if is_driven => spec.velocity,
            _ => script_velocity(&motion, spec.pose.angle, moments.centroid),
        };
        let origin = motion.pose(spec.pose, 0.0);
        let pose = Pose { position: origin.apply(moments.centroid), angle: origin.angle };
        let (gravity_factor, damping) = (spec.gravity_factor, spec.damping);
        Ok(Derived {
            pose,
            velocity,
            response,
            matched,
            core: shape.core(),
            reach: shape.bounding_radius(),
            size: moments.area.sqrt(),
            script: Script {
                start: spec.pose,
                origin: -moments.centroid,
                motion,
                driven: is_driven.then_some(velocity),
                gravity_factor,
                damping,
            },
            view: view(spec, &shape, (mass, inertia), spacing),
        })
    }
}

fn script_velocity(motion: &Motion, angle: f64, centroid: Vector64) -> Twist {
    let origin = motion.velocity(0.0);
    let turned = angle + motion.displacement(0.0).angular;
    let arm = direction(turned).rotate(centroid);
    Twist { linear: origin.at(arm), angular: origin.angular }
}

fn view(spec: &BodySpec, shape: &Shape, (mass, inertia): (f64, f64), spacing: f64) -> Body {
    // No fluid feels a sensor.
    let samples = if spec.sensor { Samples::default() } else { shape.samples(spacing) };
    let (outline, radius) = match shape {
        Shape::Disc { radius } => (Vec::new(), *radius),
        Shape::Polygon(corners) => (corners.clone(), 0.0),
    };
    Body {
        name: spec.name.clone(),
        kind: spec.kind,
        position: Vector64::ZERO,
        angle: 0.0,
        velocity: Vector64::ZERO,
        angular_velocity: 0.0,
        mass,
        inertia,
        outline,
        radius,
        samples: samples.points,
        sample_area: samples.area,
        surface: spec.surface,
        filter: spec.filter,
        sensor: spec.sensor,
        user_data: spec.user_data,
        gravity_factor: spec.gravity_factor,
        removed: false,
        asleep: false,
        fluid_force: Vector64::ZERO,
        fluid_torque: 0.0,
        contact_force: Vector64::ZERO,
        contact_torque: 0.0,
    }
}
