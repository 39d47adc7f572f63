//! Bounds on the number of particles and on coordinates.

use super::checker::{Checker, number, rounded};
use super::settings::LONGEST_DURATION;
use crate::scene::layout::{block_counts, disc_count};
use crate::scene::{KeyPath, Scene};

/// Scenes with this many particles are refused before anything is allocated.
const TOO_MANY_PARTICLES: f64 = 1e8;
/// Farthest coordinate, in spacings: single precision resolves a tenth of a spacing there.
pub(crate) const FARTHEST: f64 = 1e6;

pub(super) fn check(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    checker.size_is_sane = check_counts(checker, spacing) && check_coordinates(checker, spacing);
}

fn check_counts(checker: &mut Checker, spacing: f64) -> bool {
    let scene = checker.scene;
    let blocks = scene.block.iter().map(|block| block_counts(block, spacing).into_iter().product::<f64>());
    let discs = scene.disc.iter().map(|disc| disc_count(disc, spacing));
    let points = scene.points.iter().map(|points| points.positions.len() as f64);
    let ropes = scene.rope.iter().map(|rope| rope.pieces(spacing) + 1.0);
    let paths = |kind: &'static str| (0..).map(move |index| KeyPath::entry(kind, index));
    let filled = paths("block").zip(blocks).chain(paths("disc").zip(discs));
    let counts: Vec<(KeyPath, f64)> =
        filled.chain(paths("points").zip(points)).chain(paths("rope").zip(ropes)).collect();
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
    let mut add = |kind: &str, index, key: &str, point| points.push((KeyPath::entry(kind, index).then(key), point));
    for (index, block) in scene.block.iter().enumerate() {
        add("block", index, "min", block.min);
        add("block", index, "max", block.max);
    }
    for (index, disc) in scene.disc.iter().enumerate() {
        add("disc", index, "center", disc.center);
        add("disc", index, "radius", [disc.radius, 0.0]);
    }
    for (index, set) in scene.points.iter().enumerate() {
        let reach = set.positions.iter().flatten().fold(0.0, |reach: f64, value| reach.max(value.abs()));
        add("points", index, "positions", [reach, 0.0]);
    }
    for (index, emitter) in scene.emitter.iter().enumerate() {
        add("emitter", index, "position", emitter.position);
        add("emitter", index, "width", [emitter.width, 0.0]);
    }
    for (index, wall) in scene.half_plane.iter().enumerate() {
        add("half_plane", index, "point", wall.point);
    }
    for (index, tank) in scene.tank.iter().enumerate() {
        add("tank", index, "min", tank.min);
        add("tank", index, "max", tank.max);
    }
    for (index, obstacle) in scene.obstacle.iter().enumerate() {
        add("obstacle", index, "min", obstacle.min);
        add("obstacle", index, "max", obstacle.max);
    }
    for (index, body) in scene.body.iter().enumerate() {
        add("body", index, "position", body.position);
    }
    for (index, rope) in scene.rope.iter().enumerate() {
        add("rope", index, "from", rope.from);
        add("rope", index, "to", rope.to);
    }
    let domain = &scene.domain;
    let extents = [("periodic_x", domain.periodic_x), ("periodic_y", domain.periodic_y)];
    let given = extents.into_iter().filter_map(|(key, extent)| Some((KeyPath::key("domain").then(key), extent?)));
    points.extend(given);
    points
}
