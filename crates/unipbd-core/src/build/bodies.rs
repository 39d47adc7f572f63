//! Bodies, joints and walls of a scene in the form that the contact solver takes.

use super::carve::Solid;
use crate::legacy;
use crate::math::Vector64;
use crate::rigid::Wall;
use crate::rigid::contact::{ContactSettings, Contacts, DistanceRule, Joint, JointKind, Motor, SleepSettings};
use crate::rigid::{
    Bodies, BodySpec, CollisionFilter, Elasticity, MassSpec, Motion, Pose, Repeat, Rotation, Surface, Twist, Waypoint,
};
use crate::scene::{
    BodyDescription, BodySolver, ContactDescription, JointDescription, JointRule, MotionDescription, Rope,
    RotationRule, Scene, Side,
};
use crate::shapes::Shape;

/// Corners of a disc whose shape is matched.
const ROUND: usize = 48;

/// All bodies of a scene, and the contacts and joints between them and its walls.
pub(super) fn build(scene: &Scene) -> (Bodies, Contacts) {
    let mut bodies = Bodies::new(scene.spacing);
    for (number, description) in scene.body.iter().enumerate() {
        for spec in specifications(description, number) {
            // Faulty outlines were refused by `Scene::validate`.
            let _ = bodies.add(spec);
        }
    }
    let ContactDescription { method, relaxation, iterations, sleep, sleep_speed, sleep_delay } = scene.contacts;
    let sleep = sleep.then_some(SleepSettings { speed: sleep_speed, delay: sleep_delay });
    let settings = ContactSettings { method, relaxation, iterations, sleep, ..ContactSettings::default() };
    let mut contacts = match scene.legacy.changes_contacts() {
        false => Contacts::new(&walls(scene), settings),
        true => legacy::contacts(&walls(scene), settings, &scene.legacy),
    };
    for description in &scene.joint {
        if let Some(joint) = joint(description, &bodies) {
            contacts.add_joint(joint, description.collide_connected());
        }
    }
    for rope in &scene.rope {
        if let Some(joint) = rope_joint(rope, scene.spacing, &bodies) {
            contacts.add_joint(joint, true);
        }
    }
    (bodies, contacts)
}

/// All bodies where they start.
pub(super) fn solids(scene: &Scene) -> Vec<Solid> {
    let specs = scene.body.iter().enumerate().flat_map(|(number, description)| specifications(description, number));
    let start = |spec: BodySpec| {
        let moves = spec.kind == crate::rigid::BodyKind::Kinematic;
        let pose = if moves { spec.motion.pose(spec.pose, 0.0) } else { spec.pose };
        Solid { shape: spec.shape.tidied(), pose }
    };
    specs.map(start).collect()
}

/// A body and its copies.
fn specifications(description: &BodyDescription, number: usize) -> Vec<BodySpec> {
    let instances = description.instances(number);
    instances.map(|(name, position)| specification(description, name, position)).collect()
}

fn specification(description: &BodyDescription, name: String, position: Vector64) -> BodySpec {
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
        },
        filter: CollisionFilter {
            layers: layers(&description.layers),
            collides_with: description.collides_with.as_deref().map_or(u32::MAX, layers),
        },
        rotation: match description.rotation {
            RotationRule::Free => Rotation::Free,
            RotationRule::Locked => Rotation::Locked,
        },
        matched: (description.solver == BodySolver::ShapeMatching)
            .then_some(Elasticity { stiffness: description.stiffness, damping: description.damping }),
        gravity_factor: description.gravity_factor,
        motion: description.motion.as_ref().map_or(Motion::Still, motion),
    }
}

fn motion(description: &MotionDescription) -> Motion {
    if !description.path.is_empty() {
        let waypoint = |station: &crate::scene::Station| Waypoint {
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

fn joint(description: &JointDescription, bodies: &Bodies) -> Option<Joint> {
    let find = |name: &str| bodies.views().iter().position(|body| body.name == name).map(|id| id as u32);
    let local = |id: u32, point: Vector64| {
        let pose = bodies.pose(id);
        Vector64::from_angle(-pose.angle).rotate(point - pose.position)
    };
    let body = find(&description.body)?;
    let other = match &description.other {
        Some(name) => Some(find(name)?),
        None => None,
    };
    let at = Vector64::from(description.at);
    let other_at = description.other_at.map_or(at, Vector64::from);
    let rod = |rule| JointKind::Distance {
        length: description.length.unwrap_or((at - other_at).length()),
        compliance: description.compliance,
        rule,
    };
    Some(Joint {
        body,
        other,
        anchor: local(body, at),
        other_anchor: other.map_or(other_at, |id| local(id, other_at)),
        kind: match description.kind {
            JointRule::Hinge => JointKind::Hinge {
                motor: description
                    .motor_speed_deg
                    .map(|speed| Motor { speed: speed.to_radians(), max_torque: description.motor_torque }),
            },
            JointRule::Rod => rod(DistanceRule::Exact),
            JointRule::Rope => rod(DistanceRule::AtMost),
        },
    })
}

/// The distance joint that keeps a body at the end of a rope within the rope's length of the held end.
fn rope_joint(rope: &Rope, spacing: f64, bodies: &Bodies) -> Option<Joint> {
    let name = rope.body.as_ref().filter(|_| rope.held.first())?;
    let body = bodies.views().iter().position(|body| body.name == *name)? as u32;
    let pose = bodies.pose(body);
    let (length, compliance) = (rope.full_length(), rope.compliance * rope.pieces(spacing));
    Some(Joint {
        body,
        other: None,
        anchor: Vector64::from_angle(-pose.angle).rotate(Vector64::from(rope.to) - pose.position),
        other_anchor: rope.from.into(),
        kind: JointKind::Distance { length, compliance, rule: DistanceRule::AtMost },
    })
}

/// Walls in the order of the description: half-planes, closed sides of tanks, obstacles.
fn walls(scene: &Scene) -> Vec<Wall> {
    let mut walls = Vec::new();
    for wall in &scene.half_plane {
        let (normal, velocity) = (Vector64::from(wall.normal), Vector64::from(wall.velocity));
        // A solid lies to the left of its outline.
        let speed = velocity.dot(normal.normalize().perp());
        let surface = Surface { speed, ..Surface::with_friction(wall.friction) };
        walls.push(Wall::half_plane(wall.point.into(), normal, surface));
    }
    for tank in &scene.tank {
        let sides = [Side::Left, Side::Right, Side::Bottom, Side::Top];
        let all = Wall::tank(tank.min.into(), tank.max.into(), Surface::with_friction(tank.friction));
        walls.extend(sides.into_iter().zip(all).filter(|(side, _)| !tank.open.contains(side)).map(|(_, wall)| wall));
    }
    for obstacle in &scene.obstacle {
        let surface = Surface::with_friction(obstacle.friction);
        walls.push(Wall::rectangle(obstacle.min.into(), obstacle.max.into(), surface));
    }
    walls
}
