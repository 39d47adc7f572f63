//! Half-planes, tanks and obstacles by themselves and on periodic axes.

use super::checker::{Allowed, Checker, entries};
use super::geometry::AXES;
use super::names::check_unique;
use crate::scene::{KeyPath, Side};

const FRICTION_HINT: &str = "a Coulomb coefficient; 0 is a slippery wall";

pub(super) fn check(checker: &mut Checker) {
    check_names(checker);
    check_half_planes(checker);
    check_tanks(checker);
    for (path, obstacle) in entries("obstacle", &checker.scene.obstacle) {
        checker.range(path.then("friction"), obstacle.friction, Allowed::NotNegative, FRICTION_HINT);
        if checker.corners(&path, obstacle.min, obstacle.max) {
            check_thickness(checker, &path, obstacle.min, obstacle.max);
        }
    }
}

/// Walls that are measured have names that tell them apart.
fn check_names(checker: &mut Checker) {
    let scene = checker.scene;
    let planes = entries("half_plane", &scene.half_plane).map(|(path, wall)| (path, wall.name.as_str()));
    let tanks = entries("tank", &scene.tank).map(|(path, wall)| (path, wall.name.as_str()));
    let boxes = entries("obstacle", &scene.obstacle).map(|(path, wall)| (path, wall.name.as_str()));
    check_unique(checker, "walls", planes.chain(tanks).chain(boxes));
}

fn check_half_planes(checker: &mut Checker) {
    for (path, wall) in entries("half_plane", &checker.scene.half_plane) {
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
    for (path, tank) in entries("tank", &checker.scene.tank) {
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
