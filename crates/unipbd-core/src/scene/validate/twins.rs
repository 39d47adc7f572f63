//! Things that are there twice: walls count twice in the density of what is near, bodies in one place push each other
//! with every pair.

use std::collections::HashMap;
use std::hash::Hash;

use super::checker::{Checker, entries};
use crate::scene::{BodyDescription, KeyPath};

/// Bodies of about one size whose centres lie within a quarter of that size: more of them are no heap.
const MOST_IN_ONE_PLACE: usize = 16;

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    // Walls nearer than a hundredth of a spacing are the same wall.
    let rounded = move |value: f64| (100.0 * value / spacing).round() as i64;
    let corners = |min: [f64; 2], max: [f64; 2]| [min[0], min[1], max[0], max[1]].map(rounded);
    let scene = checker.scene;
    let tanks = entries("tank", &scene.tank).map(|(path, tank)| (path, corners(tank.min, tank.max)));
    note(checker, tanks.collect());
    let obstacles = entries("obstacle", &scene.obstacle).map(|(path, wall)| (path, corners(wall.min, wall.max)));
    note(checker, obstacles.collect());
    let planes = entries("half_plane", &scene.half_plane).map(|(path, wall)| {
        let length = libm::hypot(wall.normal[0], wall.normal[1]);
        let [x, y] = wall.normal.map(|value| value / length);
        (path, [(1e4 * x).round() as i64, (1e4 * y).round() as i64, rounded(x * wall.point[0] + y * wall.point[1])])
    });
    note(checker, planes.collect());
}

/// Notes each thing that is where an earlier one is.
fn note<K: Hash + Eq>(checker: &mut Checker, things: Vec<(KeyPath, K)>) {
    let mut seen: HashMap<K, KeyPath> = HashMap::new();
    for (path, key) in things {
        if let Some(first) = seen.get(&key) {
            let message = format!("is where {first} is: what touches both feels two walls");
            checker.problem(path, message, "leave one of them out");
        } else {
            seen.insert(key, path);
        }
    }
}

/// Notes bodies that are crowded into one place. Each of `bodies` makes sense, and there are not too many.
pub(super) fn check_bodies(checker: &mut Checker) {
    let mut crowds: HashMap<(i32, i64, i64), usize> = HashMap::new();
    let mut found: Vec<KeyPath> = Vec::new();
    for (path, body) in entries("body", &checker.scene.body) {
        let size = size(body);
        if !(size > 0.0 && size.is_finite() && meets_its_like(body)) {
            continue;
        }
        let class = libm::log2(size).floor();
        let side = 0.25 * libm::exp2(class);
        for place in body.places() {
            let key = (class as i32, (place.x / side).floor() as i64, (place.y / side).floor() as i64);
            let count = crowds.entry(key).or_insert(0);
            *count += 1;
            if *count == MOST_IN_ONE_PLACE + 1 {
                found.push(path.clone());
            }
        }
    }
    found.dedup();
    for path in found {
        let message = format!("more than {MOST_IN_ONE_PLACE} bodies of its size lie in one place");
        checker.problem(path.then("position"), message, "move them apart: bodies should not overlap at the start");
    }
}

/// Diameter or shorter side of a body \[m].
fn size(body: &BodyDescription) -> f64 {
    let (low, high) = body.shape().bounds();
    (high - low).min_element()
}

/// Whether two such bodies push each other.
fn meets_its_like(body: &BodyDescription) -> bool {
    body.collides_with.as_ref().is_none_or(|others| others.iter().any(|layer| body.layers.contains(layer)))
}
