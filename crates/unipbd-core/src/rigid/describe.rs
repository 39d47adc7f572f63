//! From the descriptions of a scene to the specifications of bodies and joints.

use super::contact::{DistanceRule, Joint, JointKind, Limits, Motor, Strength};
use super::specification::Damping;
use super::{
    Bodies, BodySpec, CollisionFilter, Elasticity, MassSpec, Motion, Pose, Repeat, Rotation, Surface, Twist, Waypoint,
};
use crate::math::{Vector64, direction};
use crate::scene::{
    BodyDescription, BodySolver, JointDescription, JointRule, MotionDescription, RotationRule, Slip, Station,
};
use crate::shapes::Shape;

/// Corners of a disc whose shape is matched.
const ROUND: usize = 48;

/// The specification of a body, or of one of its copies.
pub(crate) fn specification(description: &BodyDescription, name: String, position: Vector64) -> BodySpec {
    let layers = |list: &[u8]| list.iter().fold(0, |mask, &layer| mask | 1_u32 << (layer & 31));
    BodySpec {
        name,
        kind: description.kind,
        shape: match (description.solver, description.radius) {
            // The outline of a deformable body is drawn as it is bent.
            (BodySolver::ShapeMatching, Some(radius)) => Shape::regular(ROUND, radius),
            _ => description.shape(),
        },
        pose: Pose { position, angle: description.angle_deg.to_radians() },
        velocity: Twist { linear: description.velocity.into(), angular: description.spin_deg.to_radians() },
        mass: description.mass.map_or(MassSpec::Density(description.density), MassSpec::Mass),
        surface: Surface {
            static_friction: description.friction,
            kinetic_friction: description.kinetic_friction.unwrap_or(description.friction),
            rolling_friction: description.rolling_friction,
            restitution: description.restitution,
            speed: description.surface_speed,
            no_slip: description.slip == Slip::None,
        },
        filter: CollisionFilter {
            layers: layers(&description.layers),
            collides_with: description.collides_with.as_deref().map_or(u32::MAX, layers),
            group: description.collision_group,
        },
        rotation: match description.rotation {
            RotationRule::Free => Rotation::Free,
            RotationRule::Locked => Rotation::Locked,
        },
        matched: (description.solver == BodySolver::ShapeMatching)
            .then_some(Elasticity { compliance: description.compliance, damping: description.damping }),
        gravity_factor: description.gravity_factor,
        damping: Damping { linear: description.linear_damping, angular: description.angular_damping },
        sensor: description.sensor,
        user_data: description.user_data,
        motion: description.motion.as_ref().map_or(Motion::Still, motion),
    }
}

/// The waypoints of columns of samples; those that are empty stand for zeros.
pub(crate) fn waypoints(times: &[f64], [x, y, turn]: [&[f64]; 3]) -> Vec<Waypoint> {
    let at = |column: &[f64], index: usize| column.get(index).copied().unwrap_or(0.0);
    let waypoint = |(index, &time): (usize, &f64)| Waypoint {
        time,
        offset: Vector64::new(at(x, index), at(y, index)),
        turn: at(turn, index).to_radians(),
    };
    times.iter().enumerate().map(waypoint).collect()
}

fn motion(description: &MotionDescription) -> Motion {
    if let Some(table) = &description.table {
        return Motion::Smooth(waypoints(&table.time, table.columns().map(|(_, values)| values)));
    }
    if !description.path.is_empty() {
        let waypoint = |station: &Station| Waypoint {
            time: station.time,
            offset: station.offset.into(),
            turn: station.turn_deg.to_radians(),
        };
        let repeat = if description.repeat_path { Repeat::Loop } else { Repeat::Once };
        return Motion::Path { waypoints: description.path.iter().map(waypoint).collect(), repeat };
    }
    if description.frequency != 0.0 {
        return Motion::Oscillate {
            amplitude: description.amplitude.into(),
            swing: description.swing_deg.to_radians(),
            frequency: description.frequency,
            phase: description.phase_deg.to_radians(),
        };
    }
    Motion::Steady { velocity: description.velocity.into(), spin: description.spin_deg.to_radians() }
}

/// The joint of a description between the bodies of these names, where they are now; `None` if there is no such body.
pub(crate) fn joint(description: &JointDescription, bodies: &Bodies) -> Option<Joint> {
    let find = |name: &str| bodies.find(name);
    let local = |id: u32, point: Vector64| bodies.pose(id).apply_inverse(point);
    let body = find(&description.body)?;
    let other = match &description.other {
        Some(name) => Some(find(name)?),
        None => None,
    };
    let at = Vector64::from(description.at);
    let other_at = description.other_at.map_or(at, Vector64::from);
    let (pose, other_pose) = (bodies.pose(body), other.map_or_else(Pose::default, |id| bodies.pose(id)));
    let angle = pose.angle - other_pose.angle;
    let rod = |rule| JointKind::Distance {
        length: description.length.unwrap_or((at - other_at).length()),
        compliance: description.compliance,
        damping: description.damping,
        rule,
    };
    let motor = |speed: f64, max_torque| Motor { speed, max_torque };
    let kind = match description.kind {
        JointRule::Hinge => JointKind::Hinge {
            motor: description.motor_speed_deg.map(|speed| motor(speed.to_radians(), description.motor_torque)),
            limits: description
                .limits_deg
                .map(|[least, most]| Limits { least: angle + least.to_radians(), most: angle + most.to_radians() }),
        },
        JointRule::Rod => rod(DistanceRule::Exact),
        JointRule::Rope => rod(DistanceRule::AtMost),
        JointRule::Weld => JointKind::Weld { angle },
        JointRule::Slider => JointKind::Slider {
            axis: direction(-other_pose.angle)
                .rotate(Vector64::from(description.axis.unwrap_or([1.0, 0.0])).normalize()),
            angle,
            motor: description.motor_speed.map(|speed| motor(speed, description.motor_force)),
            limits: description.limits.map(|[least, most]| Limits { least, most }),
        },
        JointRule::Pulley => {
            let wheel = Vector64::from(description.wheel.unwrap_or_default());
            let wheels = [wheel, description.other_wheel.map_or(wheel, Vector64::from)];
            let start = (at - wheels[0]).length() + description.ratio * (other_at - wheels[1]).length();
            JointKind::Pulley { wheels, length: description.length.unwrap_or(start), ratio: description.ratio }
        }
    };
    Some(Joint {
        body,
        other,
        anchor: local(body, at),
        other_anchor: other.map_or(other_at, |id| local(id, other_at)),
        kind,
    })
}

/// The loads that break a joint.
pub(crate) fn strength(description: &JointDescription) -> Strength {
    Strength {
        force: description.break_force.unwrap_or(f64::INFINITY),
        torque: description.break_torque.unwrap_or(f64::INFINITY),
    }
}
