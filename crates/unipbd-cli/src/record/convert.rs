//! From what a run shows of itself to messages of our own.

use unipbd_core::math::Vector64;
use unipbd_core::observe::{self, Diagnostics};
use unipbd_core::phase::Phase;
use unipbd_core::rigid::{Body, BodyKind};

use super::schema::{self, Bodies, BodyShape, BodyState, GroupDiagnostics, MaterialDiagnostics, WallForce};

/// Diagnostics as the log holds them.
pub(crate) fn diagnostics_message(diagnostics: &Diagnostics, state_hash: Option<u64>) -> schema::Diagnostics {
    let count = |phase| capped(diagnostics.count(phase));
    schema::Diagnostics {
        time: diagnostics.time,
        frame: capped(diagnostics.frame),
        step: capped(diagnostics.step),
        substeps: diagnostics.substeps,
        iterations: diagnostics.iterations,
        list_builds: diagnostics.list_builds,
        count_liquid: count(Phase::Liquid),
        count_gas: count(Phase::Gas),
        count_smoke: count(Phase::Smoke),
        count_rigid: count(Phase::Rigid),
        count_solid: count(Phase::Solid),
        density_error_mean: diagnostics.density_error_mean,
        density_error_max: diagnostics.density_error_max,
        density_error_min: diagnostics.density_error_min,
        pressure_max: diagnostics.pressure_max,
        kinetic_energy: diagnostics.kinetic_energy,
        potential_energy: diagnostics.potential_energy,
        momentum_x: diagnostics.momentum.x,
        momentum_y: diagnostics.momentum.y,
        angular_momentum: diagnostics.angular_momentum,
        speed_max: diagnostics.speed_max,
        state_hash: state_hash.map(|hash| format!("{hash:016x}")).unwrap_or_default(),
        materials: diagnostics.materials.iter().map(material_message).collect(),
        groups: diagnostics.groups.iter().map(group_message).collect(),
        substeps_wanted: diagnostics.substeps_wanted,
        substeps_reason: diagnostics.substeps_reason.name().to_owned(),
        contact_penetration: diagnostics.contact_penetration,
        walls: diagnostics.walls.iter().map(wall_message).collect(),
    }
}

fn material_message(material: &observe::MaterialDiagnostics) -> MaterialDiagnostics {
    MaterialDiagnostics {
        name: material.name.clone(),
        count: capped(material.count),
        density_error_mean: material.density_error_mean,
        density_error_max: material.density_error_max,
        density_error_min: material.density_error_min,
    }
}

fn group_message(group: &observe::GroupDiagnostics) -> GroupDiagnostics {
    GroupDiagnostics { name: group.name.clone(), violation: group.violation }
}

fn wall_message(wall: &observe::WallForce) -> WallForce {
    WallForce { name: wall.name.clone(), force_x: wall.force.x, force_y: wall.force.y }
}

fn capped(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

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
