//! Bodies, joints and walls of a scene in the form that the contact solver takes.

use super::carve::Solid;
use crate::legacy;
use crate::math::Vector64;
use crate::rigid::contact::{ContactSettings, Contacts, SleepSettings};
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
