//! Bodies, joints and walls of a scene in the form that the contact solver takes.

use super::carve::Solid;
use crate::coupling::RigidBodies;
use crate::legacy;
use crate::math::Vector64;
use crate::rigid::contact::{ContactSettings, Contacts, DistanceRule, Joint, JointKind, SleepSettings};
use crate::rigid::{Bodies, BodySpec, Surface, Wall};
use crate::rigid::{joint, specification, strength};
use crate::scene::{BodyDescription, ContactDescription, Scene, Side, body_friction};

/// All bodies of a scene, and the contacts and joints between them and its walls.
pub(super) fn build(scene: &Scene) -> (Bodies, Contacts) {
    let mut bodies = Bodies::new(scene.spacing);
    for (number, description) in scene.body.iter().enumerate() {
        for spec in specifications(description, number) {
            // Faulty outlines were refused by `Scene::validate`.
            let _ = bodies.add(spec);
        }
    }
    let mut contacts = contacts(scene);
    for description in &scene.joint {
        if let Some(joint) = joint(description, &bodies) {
            let index = contacts.add_joint(joint, description.collide_connected());
            contacts.describe_joint(index, &description.name, strength(description));
        }
    }
    (bodies, contacts)
}

/// The contact solver of a scene, without joints.
pub(super) fn contacts(scene: &Scene) -> Contacts {
    let ContactDescription { method, relaxation, iterations, friction_rule, sleep, sleep_speed, .. } = scene.contacts;
    let sleep = sleep.then_some(SleepSettings { speed: sleep_speed, delay: scene.contacts.rest_time(scene.fps) });
    let settings =
        ContactSettings { method, relaxation, iterations, friction_rule, sleep, ..ContactSettings::default() };
    match scene.legacy.changes_contacts() {
        false => Contacts::new(&walls(scene), settings),
        true => legacy::contacts(&walls(scene), settings, &scene.legacy),
    }
}

/// All bodies where they start.
pub(super) fn solids(scene: &Scene) -> Vec<Solid> {
    let specs = scene.body.iter().enumerate().flat_map(|(number, description)| specifications(description, number));
    let start = |spec: BodySpec| {
        let moves = spec.kind == crate::rigid::BodyKind::Kinematic;
        let pose = if moves { spec.motion.pose(spec.pose, 0.0) } else { spec.pose };
        Solid { shape: spec.shape.tidied(), pose }
    };
    specs.filter(|spec| !spec.sensor).map(start).collect()
}

/// A body and its copies.
fn specifications(description: &BodyDescription, number: usize) -> Vec<BodySpec> {
    let instances = description.instances(number);
    instances.map(|(name, position)| specification(description, name, position)).collect()
}

/// Adds the distance joints that keep bodies at the ends of ropes within the rope's length of its other end: another
/// body, or the point that is held or carried there. `ends` are the ids of the first and last point of each rope.
pub(super) fn join_ropes(scene: &Scene, ends: &[[u32; 2]], rigid: &mut RigidBodies) {
    for (rope, ends) in scene.rope.iter().zip(ends) {
        let find = |name: &Option<String>| {
            let name = name.as_ref()?;
            rigid.views().iter().position(|body| body.name == *name).map(|id| id as u32)
        };
        let (first, last) = (find(&rope.from_body), find(&rope.body));
        let (from, to) = (Vector64::from(rope.from), Vector64::from(rope.to));
        let Some((body, at)) = last.map(|body| (body, to)).or(first.map(|body| (body, from))) else { continue };
        let other = first.filter(|_| last.is_some());
        let (opposite, carrier) = if last.is_some() { (from, ends[0]) } else { (to, ends[1]) };
        let bodies = &rigid.bodies;
        let length = rope.full_length();
        let compliance = rope.compliance * rope.pieces(scene.spacing);
        let kind = JointKind::Distance { length, compliance, damping: 0.0, rule: DistanceRule::AtMost };
        let other_anchor = other.map_or(opposite, |id| bodies.pose(id).apply_inverse(opposite));
        let joint = Joint { body, other, anchor: bodies.pose(body).apply_inverse(at), other_anchor, kind };
        let index = rigid.contacts.add_joint(joint, true);
        if other.is_none() {
            rigid.carry(index, carrier);
        }
    }
}

/// Walls in the order of the description: half-planes, closed sides of tanks, obstacles.
pub(super) fn walls(scene: &Scene) -> Vec<Wall> {
    let mut walls = Vec::new();
    for wall in &scene.half_plane {
        let (normal, velocity) = (Vector64::from(wall.normal), Vector64::from(wall.velocity));
        // A solid lies to the left of its outline.
        let speed = velocity.dot(normal.normalize().perp());
        let surface = Surface { speed, ..Surface::with_friction(body_friction(wall.friction)) };
        walls.push(Wall::half_plane(wall.point.into(), normal, surface).named(wall.name.clone()));
    }
    for tank in &scene.tank {
        let all = Wall::tank(tank.min.into(), tank.max.into(), Surface::with_friction(body_friction(tank.friction)));
        let name = |side: Side| match tank.name.is_empty() {
            true => String::new(),
            false => format!("{} {}", tank.name, side.name()),
        };
        let closed = Side::ALL.into_iter().zip(all).filter(|(side, _)| !tank.open.contains(side));
        walls.extend(closed.map(|(side, wall)| wall.named(name(side))));
    }
    for obstacle in &scene.obstacle {
        let surface = Surface::with_friction(body_friction(obstacle.friction));
        let wall = Wall::rectangle(obstacle.min.into(), obstacle.max.into(), surface);
        walls.push(wall.named(obstacle.name.clone()));
    }
    walls
}
