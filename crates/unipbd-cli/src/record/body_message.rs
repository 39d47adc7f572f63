//! Bodies as messages of our own.

use unipbd_core::math::Vector64;
use unipbd_core::rigid::{Body, BodyKind};

use super::schema::{Bodies, BodyShape, BodyState};

/// All bodies as the log holds them, with their shapes where those are new.
pub(crate) fn bodies_message(bodies: &[Body], with_shapes: bool) -> Bodies {
    let states = (0..).zip(bodies).map(|(id, body)| body_state(id, body)).collect();
    let shapes = (0..).zip(bodies).filter(|_| with_shapes).map(|(id, body)| body_shape(id, body)).collect();
    Bodies { bodies: states, shapes }
}

fn body_state(id: u32, body: &Body) -> BodyState {
    BodyState {
        id,
        name: body.name.clone(),
        x: body.position.x,
        y: body.position.y,
        angle: body.angle,
        velocity_x: body.velocity.x,
        velocity_y: body.velocity.y,
        angular_velocity: body.angular_velocity,
        fluid_force_x: body.fluid_force.x,
        fluid_force_y: body.fluid_force.y,
        fluid_torque: body.fluid_torque,
        contact_force_x: body.contact_force.x,
        contact_force_y: body.contact_force.y,
        contact_torque: body.contact_torque,
        asleep: body.asleep,
    }
}

fn body_shape(id: u32, body: &Body) -> BodyShape {
    let split = |points: &[Vector64]| points.iter().map(|point| (point.x, point.y)).unzip();
    let (outline_x, outline_y) = split(&body.outline);
    let (sample_x, sample_y) = split(&body.samples);
    BodyShape {
        id,
        kind: kind_name(body.kind).to_owned(),
        mass: body.mass,
        inertia: body.inertia,
        radius: body.radius,
        outline_x,
        outline_y,
        sample_x,
        sample_y,
        sample_area: body.sample_area,
        static_friction: body.surface.static_friction,
        kinetic_friction: body.surface.kinetic_friction,
        rolling_friction: body.surface.rolling_friction,
        restitution: body.surface.restitution,
        layers: body.filter.layers,
        collides_with: body.filter.collides_with,
        sensor: body.sensor,
        gravity_factor: body.gravity_factor,
    }
}

/// The word for a kind of body in the log.
pub(crate) fn kind_name(kind: BodyKind) -> &'static str {
    match kind {
        BodyKind::Dynamic => "dynamic",
        BodyKind::Kinematic => "kinematic",
        BodyKind::Static => "static",
    }
}
