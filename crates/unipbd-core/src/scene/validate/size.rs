//! Bounds on the number of particles and on coordinates.

use super::checker::{Checker, entries, number, rounded};
use super::extremes::largest;
use super::settings::LONGEST_DURATION;
use crate::math::Vector64;
use crate::phase::Phase;
use crate::scene::layout::particle_counts;
use crate::scene::{KeyPath, MOST_BODIES, Scene, crowd};

/// Scenes with this many particles are refused before anything is allocated.
const TOO_MANY_PARTICLES: f64 = 1e8;
/// Farthest coordinate, in spacings: single precision resolves a tenth of a spacing there.
pub(crate) const FARTHEST: f64 = 1e6;

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    let counted = check_counts(checker);
    let placed = check_coordinates(checker, spacing);
    let small = check_bodies(checker, spacing);
    checker.size_is_sane = counted && placed && small;
    if checker.size_is_sane {
        check_crowding(checker, spacing);
    }
}

/// Scenes with more samples of bodies than this are refused before anything is allocated.
const TOO_MANY_SAMPLES: f64 = 1e7;
/// Most corners of one outline: its checks take time with their square.
pub(super) const MOST_CORNERS: usize = 4096;

/// Notes bodies that are too many, too large, or filled by too many samples.
fn check_bodies(checker: &mut Checker, spacing: f64) -> bool {
    let (mut sane, mut total, mut bodies) = (true, 0.0, 0.0);
    for (path, body) in entries("body", &checker.scene.body) {
        if body.outline.as_ref().is_some_and(|outline| outline.len() > MOST_CORNERS) {
            sane = false;
            continue;
        }
        let (low, high) = body.shape().bounds();
        let extent = high - low;
        let copies = body.copies.as_ref().map_or(1.0, |copies| f64::from(copies.columns) * f64::from(copies.rows));
        bodies += copies;
        if !extent.is_finite() {
            continue;
        }
        let limit = FARTHEST * spacing;
        if extent.max_element() > limit {
            let message = format!(
                "is {} m large; the limit is {FARTHEST} spacings ({} m)",
                rounded(extent.max_element()),
                rounded(limit)
            );
            checker.problem(path, message, "make it smaller or raise `spacing`");
            sane = false;
            continue;
        }
        // Each sample is compared with each side.
        let sides = body.outline.as_ref().map_or(1.0, |outline| (outline.len() as f64 / 8.0).max(1.0));
        total += (extent.x / spacing).max(1.0) * (extent.y / spacing).max(1.0) * copies * sides;
        if total > TOO_MANY_SAMPLES {
            let message = format!(
                "brings the bodies to about {} samples; the limit is {}",
                rounded(total),
                number(TOO_MANY_SAMPLES)
            );
            checker.problem(path, message, "make it smaller, raise `spacing`, or use walls: [[tank]] and [[obstacle]]");
            return false;
        }
    }
    sane && bodies <= MOST_BODIES as f64
}

/// Notes points that are crowded into one place.
fn check_crowding(checker: &mut Checker, spacing: f64) {
    let reach = checker.scene.solver.kernel_radius * spacing;
    if !(reach > 0.0 && reach.is_finite()) {
        return;
    }
    let smoke = |name: &str| checker.materials.get(name).is_some_and(|known| known.phase() == Phase::Smoke);
    let sets = checker.scene.points.iter().filter(|set| !smoke(&set.material));
    let points = sets.flat_map(|set| set.positions.iter().map(|&place| Vector64::from(place)));
    if let Some(crowd) = crowd(points, [], reach) {
        let hint = "leave about one spacing between points: each two of them in a kernel are a pair";
        checker.problem(KeyPath::key("points"), format!("there are {crowd}"), hint);
    }
}

fn check_counts(checker: &mut Checker) -> bool {
    let counts = particle_counts(checker.scene);
    let mut sane = true;
    for (path, count) in counts.iter().filter(|(_, count)| *count >= TOO_MANY_PARTICLES && count.is_finite()) {
        checker.problem(path.clone(), too_many("holds", *count), "make it smaller or raise `spacing`");
        sane = false;
    }
    let total: f64 = counts.iter().map(|(_, count)| count).filter(|count| count.is_finite()).sum();
    if sane && total >= TOO_MANY_PARTICLES {
        checker.problem(KeyPath::key("spacing"), too_many("the scene starts with", total), "raise it");
        sane = false;
    }
    let known = counts.iter().all(|(_, count)| count.is_finite());
    sane && (!known || check_peak(checker))
}

fn check_peak(checker: &mut Checker) -> bool {
    if checker.scene.duration > LONGEST_DURATION {
        return true;
    }
    let estimate = checker.scene.estimate();
    let peak = estimate.particles_at_peak;
    let sane = (peak as f64) < TOO_MANY_PARTICLES || !estimate.emitted_per_second.is_finite();
    if !sane {
        let hint = "shorten `duration`, give the materials a `lifetime`, or raise `spacing`";
        checker.problem(KeyPath::key("emitter"), too_many("the emitters bring the scene to", peak as f64), hint);
    }
    sane
}

fn too_many(start: &str, count: f64) -> String {
    format!("{start} about {} particles; the limit is {}", rounded(count), number(TOO_MANY_PARTICLES))
}

fn check_coordinates(checker: &mut Checker, spacing: f64) -> bool {
    let limit = FARTHEST * spacing;
    let mut sane = true;
    for (path, point) in points(checker.scene) {
        let far = point.into_iter().find(|value| value.is_finite() && value.abs() > limit);
        if let Some(value) = far {
            let message = format!(
                "{} m is farther than {} spacings ({} m) from the origin, where single precision becomes too coarse",
                number(value),
                number(FARTHEST),
                rounded(limit)
            );
            checker.problem(path, message, "move the scene to the origin, make it smaller or raise `spacing`");
            sane = false;
        }
    }
    sane
}

/// Every place of the scene.
fn points(scene: &Scene) -> Vec<(KeyPath, [f64; 2])> {
    let mut points = Vec::new();
    let mut add = |path: &KeyPath, key: &str, point| points.push((path.then(key), point));
    for (path, block) in entries("block", &scene.block) {
        add(&path, "min", block.min);
        add(&path, "max", block.max);
    }
    for (path, disc) in entries("disc", &scene.disc) {
        add(&path, "center", disc.center);
        add(&path, "radius", [disc.radius, 0.0]);
    }
    for (path, set) in entries("points", &scene.points) {
        let reach = set.positions.iter().flatten().fold(0.0, |reach: f64, value| reach.max(value.abs()));
        add(&path, "positions", [reach, 0.0]);
    }
    for (path, emitter) in entries("emitter", &scene.emitter) {
        add(&path, "position", emitter.position);
        add(&path, "width", [emitter.width, 0.0]);
    }
    for (path, wall) in entries("half_plane", &scene.half_plane) {
        add(&path, "point", wall.point);
    }
    for (path, tank) in entries("tank", &scene.tank) {
        add(&path, "min", tank.min);
        add(&path, "max", tank.max);
    }
    for (path, obstacle) in entries("obstacle", &scene.obstacle) {
        add(&path, "min", obstacle.min);
        add(&path, "max", obstacle.max);
    }
    for (path, body) in entries("body", &scene.body) {
        add(&path, "position", body.position);
        if let Some(table) = body.motion.as_ref().and_then(|motion| motion.table.as_ref()) {
            let path = path.then("motion").then("table");
            add(&path, "x", [largest(&table.x), 0.0]);
            add(&path, "y", [0.0, largest(&table.y)]);
        }
    }
    for (path, rope) in entries("rope", &scene.rope) {
        add(&path, "from", rope.from);
        add(&path, "to", rope.to);
    }
    for (path, gauge) in entries("gauge", &scene.gauge) {
        gauge.at.into_iter().for_each(|point| add(&path, "at", point));
        gauge.line.into_iter().flatten().for_each(|point| add(&path, "line", point));
    }
    let domain = &scene.domain;
    let extents = [("periodic_x", domain.periodic_x), ("periodic_y", domain.periodic_y)];
    let given = extents.into_iter().filter_map(|(key, extent)| Some((KeyPath::key("domain").then(key), extent?)));
    points.extend(given);
    points
}
