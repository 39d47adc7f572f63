//! Bodies by themselves: outline, mass, surface, layers, copies.

use super::checker::{Allowed, Checker, entries, number};
use super::motion;
use super::names::check_unique;
use super::placement::SEVERAL_TANKS;
use super::size::MOST_CORNERS;
use crate::scene::{BodyDescription, BodyKind, BodySolver, KeyPath, MOST_BODIES, RotationRule, Side, Tank};

const COEFFICIENT_HINT: &str = "a Coulomb coefficient, such as 0.5; 0 is slippery";

pub(super) fn check(checker: &mut Checker) {
    check_contacts(checker);
    let scene = checker.scene;
    let bodies = || entries("body", &scene.body);
    check_unique(checker, "bodies", bodies().map(|(path, body)| (path, body.name.as_str())));
    let mut total = 0.0;
    for (path, body) in bodies() {
        let sound = check_outline(checker, &path, body);
        check_mass(checker, &path, body);
        check_surface(checker, &path, body);
        check_layers(checker, &path, body);
        check_solver(checker, &path, body);
        motion::check(checker, &path, body);
        if check_copies(checker, &path, body, &mut total) && sound {
            check_place(checker, &path, body);
        }
    }
}

fn check_contacts(checker: &mut Checker) {
    let (contacts, path) = (checker.scene.contacts, KeyPath::key("contacts"));
    let hint = "1 is plain, 2 the most that can be stable";
    checker.range(path.then("relaxation"), contacts.relaxation, Allowed::Between(1.0, 2.0), hint);
    let hint = "1 is enough in most scenes; beyond 4, more substeps do more";
    checker.range(path.then("iterations"), f64::from(contacts.iterations), Allowed::Between(1.0, 4.0), hint);
    let hint = "relative to sqrt(gravity x size); 0.02 by default";
    checker.range(path.then("sleep_speed"), contacts.sleep_speed, Allowed::NotNegative, hint);
    checker.range(path.then("sleep_delay"), contacts.sleep_delay.unwrap_or(0.0), Allowed::NotNegative, "in seconds");
}

/// Exactly one outline, and one that has an area.
fn check_outline(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) -> bool {
    let given = [("radius", body.radius.is_some()), ("size", body.size.is_some()), ("outline", body.outline.is_some())];
    let keys: Vec<&str> = given.iter().filter(|(_, given)| *given).map(|(key, _)| *key).collect();
    match keys[..] {
        [] => {
            let hint = "give one of radius (a disc), size (a box) and outline (a polygon)";
            checker.problem(path.clone(), "the body has no shape", hint);
            false
        }
        [key] => check_shape(checker, path.then(key), body),
        [first, second, ..] => {
            let message = format!("the body has two shapes: `{first}` and `{second}`");
            checker.problem(path.then(second), message, "keep one of radius, size and outline");
            false
        }
    }
}

fn check_shape(checker: &mut Checker, path: KeyPath, body: &BodyDescription) -> bool {
    if let Some(size) = body.size {
        let mut sound = true;
        for (axis, length) in size.into_iter().enumerate() {
            sound &= checker.range(path.then_index(axis), length, Allowed::Positive, "width and height in metres");
        }
        return sound;
    }
    if let Some(radius) = body.radius {
        return checker.range(path, radius, Allowed::Positive, "a length in metres");
    }
    if body.outline.as_ref().is_some_and(|outline| outline.len() > MOST_CORNERS) {
        let message = format!("has more than {MOST_CORNERS} corners");
        checker.problem(path, message, "leave out corners nearer to each other than a spacing");
        return false;
    }
    match body.shape().check() {
        Ok(()) => true,
        Err(error) => {
            let hint = "list the corners in order around the outline, without crossing it";
            checker.problem(path, error.to_string(), hint);
            false
        }
    }
}

fn check_mass(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    let hint = "a rate in 1/s; 0 keeps the velocity";
    checker.range(path.then("linear_damping"), body.linear_damping, Allowed::NotNegative, hint);
    checker.range(path.then("angular_damping"), body.angular_damping, Allowed::NotNegative, hint);
    if body.sensor && body.kind == BodyKind::Dynamic {
        let hint = "make it \"static\" or \"kinematic\": a sensor has no weight and stands on nothing";
        checker.problem(path.then("sensor"), "a dynamic body is no sensor", hint);
    }
    checker.range(path.then("density"), body.density, Allowed::Positive, "mass per area in kg/m^2; 1000 is water");
    checker.range(path.then("mass"), body.mass, Allowed::Positive, "in kg; left out, it follows from the density");
}

fn check_surface(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    checker.range(path.then("friction"), body.friction, Allowed::NotNegative, COEFFICIENT_HINT);
    if let Some(kinetic) = body.kinetic_friction
        && checker.range(path.then("kinetic_friction"), kinetic, Allowed::NotNegative, COEFFICIENT_HINT)
        && kinetic > body.friction
    {
        let message = format!("must not exceed the friction at rest ({}), found {}", body.friction, number(kinetic));
        checker.problem(path.then("kinetic_friction"), message, "lower it or raise `friction`");
    }
    let hint = "a moment over (normal force x radius), such as 0.05";
    checker.range(path.then("rolling_friction"), body.rolling_friction, Allowed::NotNegative, hint);
    let hint = "rebound speed over impact speed: 0 stays, 1 bounces back as fast";
    checker.range(path.then("restitution"), body.restitution, Allowed::Between(0.0, 1.0), hint);
}

/// What holds for bodies that are particles, and for them alone.
fn check_solver(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    let hint = "displacement of its samples over a force on all of them, in m/N: 0 is rigid";
    checker.range(path.then("compliance"), body.compliance, Allowed::NotNegative, hint);
    let hint = "the part of its wobble that it loses in a 60th of a second: 0 wobbles on, 1 creeps";
    checker.range(path.then("damping"), body.damping, Allowed::Between(0.0, 1.0), hint);
    if body.solver == BodySolver::Pose {
        if body.compliance != 0.0 {
            let hint = "add solver = \"shape_matching\", or leave it out";
            checker.problem(path.then("compliance"), "a rigid pose does not deform", hint);
        }
        return;
    }
    let hint = "leave it out, or leave out solver = \"shape_matching\"";
    let mut refuse = |key: &str, given: bool| {
        if given {
            checker.problem(path.then(key), format!("`{key}` has no meaning for a body that is particles"), hint);
        }
    };
    refuse("kind", body.kind != BodyKind::Dynamic);
    refuse("rotation", body.rotation != RotationRule::Free);
    refuse("restitution", body.restitution != 0.0);
    refuse("rolling_friction", body.rolling_friction != 0.0);
    refuse("gravity_factor", body.gravity_factor != 1.0);
    refuse("linear_damping", body.linear_damping != 0.0);
    refuse("angular_damping", body.angular_damping != 0.0);
    refuse("collision_group", body.collision_group != 0);
    refuse("sensor", body.sensor);
    let scene = checker.scene;
    let joined = || scene.joint.iter().any(|joint| joint.body == body.name || joint.other.as_ref() == Some(&body.name));
    let named = |end: &Option<String>| end.as_ref() == Some(&body.name);
    let tied = || scene.rope.iter().any(|rope| named(&rope.body) || named(&rope.from_body));
    if !body.name.is_empty() && (joined() || tied()) {
        let hint = "join bodies with solver = \"pose\"";
        checker.problem(path.then("solver"), "joints and ropes do not hold a body that is particles", hint);
    }
}

fn check_layers(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    let lists = [("layers", Some(&body.layers)), ("collides_with", body.collides_with.as_ref())];
    for (key, list) in lists.into_iter().filter_map(|(key, list)| Some((key, list?))) {
        for (index, &layer) in list.iter().enumerate() {
            let path = path.then(key).then_index(index);
            checker.range(path, f64::from(layer), Allowed::Between(0.0, 31.0), "there are 32 layers");
        }
    }
}

fn check_copies(checker: &mut Checker, path: &KeyPath, body: &BodyDescription, total: &mut f64) -> bool {
    let Some(copies) = &body.copies else {
        *total += 1.0;
        return true;
    };
    let path = path.then("copies");
    let mut sound = true;
    for (key, count) in [("columns", copies.columns), ("rows", copies.rows)] {
        sound &= checker.range(path.then(key), f64::from(count), Allowed::Between(1.0, 1e5), "a whole number from 1");
    }
    let count = f64::from(copies.columns) * f64::from(copies.rows);
    *total += count;
    if sound && *total > MOST_BODIES as f64 {
        let message =
            format!("brings the scene to {} bodies; the limit is {}", number(*total), number(MOST_BODIES as f64));
        checker.problem(path.clone(), message, "lower `columns` or `rows`");
        sound = false;
    }
    let needed = [copies.columns > 1, copies.rows > 1];
    if sound && needed.into_iter().zip(copies.step).any(|(needed, step)| needed && step == 0.0) {
        checker.problem(path.then("step"), "puts bodies in the same place", "the way from body to body in metres");
        sound = false;
    }
    sound
}

/// Dynamic bodies start inside every tank.
fn check_place(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    if body.kind != BodyKind::Dynamic {
        return;
    }
    let several = checker.scene.tank.len() > 1;
    let outside = |[x, y]: [f64; 2]| {
        let tank = checker.scene.tank.iter().position(|tank| !holds(tank, [x, y]))?;
        Some((tank, x, y))
    };
    if let Some((tank, x, y)) = body.places().map(<[f64; 2]>::from).find_map(outside) {
        let which = if body.copies.is_some() { "a copy of the body" } else { "the body" };
        let message = format!("{which} starts outside tank[{tank}], at [{}, {}]", number(x), number(y));
        let hint = if several { SEVERAL_TANKS } else { "move it inside, or open that side of the tank" };
        checker.problem(path.then("position"), message, hint);
    }
}

fn holds(tank: &Tank, [x, y]: [f64; 2]) -> bool {
    let closed = |side| !tank.open.contains(&side);
    !(closed(Side::Left) && x < tank.min[0]
        || closed(Side::Right) && x > tank.max[0]
        || closed(Side::Bottom) && y < tank.min[1]
        || closed(Side::Top) && y > tank.max[1])
}
