//! Half-planes, tanks and obstacles by themselves and on periodic axes.

use std::collections::BTreeMap;

use super::checker::{Allowed, Checker};
use super::geometry::AXES;
use crate::scene::{KeyPath, Side};

const FRICTION_HINT: &str = "a Coulomb coefficient; 0 is a slippery wall";

pub(super) fn check(checker: &mut Checker) {
    check_names(checker);
    check_half_planes(checker);
    check_tanks(checker);
    for (index, obstacle) in checker.scene.obstacle.iter().enumerate() {
        let path = KeyPath::entry("obstacle", index);
        checker.range(path.then("friction"), obstacle.friction, Allowed::NotNegative, FRICTION_HINT);
        if checker.corners(&path, obstacle.min, obstacle.max) {
            check_thickness(checker, &path, obstacle.min, obstacle.max);
        }
    }
}

/// Walls that are measured have names that tell them apart.
fn check_names(checker: &mut Checker) {
    let scene = checker.scene;
    let planes = scene.half_plane.iter().enumerate().map(|(n, wall)| (KeyPath::entry("half_plane", n), &wall.name));
    let tanks = scene.tank.iter().enumerate().map(|(n, wall)| (KeyPath::entry("tank", n), &wall.name));
    let boxes = scene.obstacle.iter().enumerate().map(|(n, wall)| (KeyPath::entry("obstacle", n), &wall.name));
    let mut seen = BTreeMap::new();
    for (path, name) in planes.chain(tanks).chain(boxes).filter(|(_, name)| !name.is_empty()) {
        if let Some(first) = seen.get(name) {
            let message = format!("the name \"{name}\" is taken by {first}");
            checker.problem(path.then("name"), message, "names of walls must differ");
        } else {
            seen.insert(name, path);
        }
    }
}

fn check_half_planes(checker: &mut Checker) {
    for (index, wall) in checker.scene.half_plane.iter().enumerate() {
        let path = KeyPath::entry("half_plane", index);
        checker.range(path.then("friction"), wall.friction, Allowed::NotNegative, FRICTION_HINT);
        let hint = "it points from the wall to the particles, such as [0.0, 1.0] for a floor";
        checker.direction(path.then("normal"), wall.normal, hint);
        for (axis, slope) in AXES.into_iter().zip(wall.normal) {
            if axis.extent(&checker.scene.domain).is_some() && slope != 0.0 && slope.is_finite() {
                let key = axis.periodic_key();
                let hint = format!("let the wall run along the axis, or remove `domain.{key}`");
                checker.problem(
                    path.then("normal"),
                    format!("the wall crosses the periodic axis {}", axis.name()),
                    hint,
                );
            }
        }
    }
}

fn check_tanks(checker: &mut Checker) {
    for (index, tank) in checker.scene.tank.iter().enumerate() {
        let path = KeyPath::entry("tank", index);
        checker.range(path.then("friction"), tank.friction, Allowed::NotNegative, FRICTION_HINT);
        if !checker.corners(&path, tank.min, tank.max) {
            continue;
        }
        check_thickness(checker, &path, tank.min, tank.max);
        for (axis, sides) in AXES.into_iter().zip([[Side::Left, Side::Right], [Side::Bottom, Side::Top]]) {
            let open = sides.iter().all(|side| tank.open.contains(side));
            if axis.extent(&checker.scene.domain).is_some() && !open {
                let names = if axis.index() == 0 { "\"left\", \"right\"" } else { "\"bottom\", \"top\"" };
                let message = format!("the tank has walls across the periodic axis {}", axis.name());
                checker.problem(path.clone(), message, format!("open these sides: open = [{names}]"));
            }
        }
    }
}

fn check_thickness(checker: &mut Checker, path: &KeyPath, min: [f64; 2], max: [f64; 2]) {
    let (width, height) = (max[0] - min[0], max[1] - min[1]);
    let (thickness, what) = if width < height { (width, "the width") } else { (height, "the height") };
    checker.at_least_one_spacing(path.then("max"), thickness, what);
}
