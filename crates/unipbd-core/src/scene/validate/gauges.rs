//! Gauges: each has the keys of its kind, and reads something that is there.

use super::checker::{Allowed, Checker, entries};
use super::joints::BodyNames;
use super::materials::check_reference;
use super::names::{check_unique, excerpt, hint_for_unknown};
use crate::phase::Phase;
use crate::scene::{ForcePart, Gauge, GaugeKind, KeyPath, Scene};

/// More gauges than this are refused: each reads all particles in each frame.
const MOST_GAUGES: usize = 1000;
/// Longest name: it becomes a column of tables.
const LONGEST_NAME: usize = 64;

pub(super) fn check(checker: &mut Checker) {
    let gauges = &checker.scene.gauge;
    if gauges.is_empty() {
        return;
    }
    if gauges.len() > MOST_GAUGES {
        let message = format!("there are {} gauges; the limit is {MOST_GAUGES}", gauges.len());
        return checker.problem(KeyPath::key("gauge"), message, "leave some out");
    }
    check_unique(checker, "gauges", entries("gauge", gauges).map(|(path, gauge)| (path, gauge.name.as_str())));
    for (path, gauge) in entries("gauge", gauges) {
        check_name(checker, &path, &gauge.name);
        check_keys(checker, &path, gauge);
        check_values(checker, &path, gauge);
    }
}

/// A name that is a column of every table, a field of a log, and a word on the command line.
fn check_name(checker: &mut Checker, path: &KeyPath, name: &str) {
    let plain = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    let taken = name == "time";
    if taken || !plain || !name.starts_with(|first: char| first.is_ascii_alphabetic()) || name.len() > LONGEST_NAME {
        let message = format!("\"{}\" is no name of a gauge", excerpt(name));
        let hint = format!(
            "letters, digits and _, a letter first, at most {LONGEST_NAME}, not \"time\"; such as \"level_left\""
        );
        checker.problem(path.then("name"), message, hint);
    }
}

/// Keys that only some kinds have, and keys that they need.
fn check_keys(checker: &mut Checker, path: &KeyPath, gauge: &Gauge) {
    use GaugeKind::{FlowRate, Force, Front, Level, Pressure};
    let keys: [(&str, bool, &[GaugeKind], &[GaugeKind], &str); 7] = [
        ("material", gauge.material.is_some(), &[Level, Pressure, FlowRate, Front], &[], ""),
        ("at", gauge.at.is_some(), &[Level, Pressure, Front], &[Level, Pressure], "at = [0.5, 0.0]"),
        ("direction", gauge.direction.is_some(), &[Level, Force, Front], &[Front], "direction = [1.0, 0.0]"),
        ("radius", gauge.radius.is_some(), &[Pressure], &[], ""),
        ("on", gauge.on.is_some(), &[Force], &[Force], "on = \"tank left\", a wall with a name or a body"),
        ("of", gauge.of != ForcePart::All, &[Force], &[], ""),
        ("line", gauge.line.is_some(), &[FlowRate], &[FlowRate], "line = [[1.0, 0.0], [1.0, 0.5]]"),
    ];
    let kind = gauge.kind.name();
    for (key, given, owners, needed_by, example) in keys {
        if given && !owners.contains(&gauge.kind) {
            let names: Vec<&str> = owners.iter().map(|owner| owner.name()).collect();
            let message = format!("a gauge of kind \"{kind}\" has no `{key}`");
            checker.problem(path.then(key), message, format!("leave it out: it is of {}", names.join(", ")));
        } else if !given && needed_by.contains(&gauge.kind) {
            let message = format!("a gauge of kind \"{kind}\" needs `{key}`");
            checker.problem(path.clone(), message, format!("such as {example}"));
        }
    }
}

fn check_values(checker: &mut Checker, path: &KeyPath, gauge: &Gauge) {
    if let Some(material) = &gauge.material {
        let loose = [Phase::Liquid, Phase::Gas, Phase::Smoke];
        let wanted = if gauge.kind == GaugeKind::Front { &loose[..] } else { &loose[..2] };
        check_reference(checker, path.then("material"), material, wanted);
    }
    if let Some(direction) = gauge.direction {
        checker.direction(path.then("direction"), direction, "such as [0.0, 1.0] for up");
    }
    checker.range(path.then("radius"), gauge.radius, Allowed::Positive, "in metres; left out, three spacings");
    if gauge.line.is_some_and(|[from, to]| from == to) {
        checker.problem(path.then("line"), "the line has no length", "give two different ends");
    }
    if let Some(name) = &gauge.on {
        check_solid(checker, path.then("on"), name);
    }
}

/// Notes a wall or body that is not there, or a wall that is not measured.
fn check_solid(checker: &mut Checker, path: KeyPath, name: &str) {
    let scene = checker.scene;
    let (walls, bodies) = (wall_names(scene), BodyNames::of(scene));
    if walls.iter().any(|wall| wall == name) || bodies.has(name) {
        return;
    }
    let known: Vec<&str> = walls.iter().map(String::as_str).chain(bodies.first()).collect();
    let hint = match known.is_empty() {
        true => "give the wall a `name`".to_owned(),
        false => hint_for_unknown(name, &known, "walls with a name and bodies"),
    };
    checker.problem(path, format!("there is no wall or body \"{}\"", excerpt(name)), hint);
}

/// Names of the walls whose forces are measured.
fn wall_names(scene: &Scene) -> Vec<String> {
    let planes = scene.half_plane.iter().map(|wall| wall.name.clone());
    let boxes = scene.obstacle.iter().map(|wall| wall.name.clone());
    let tanks = scene.tank.iter().filter(|tank| !tank.name.is_empty()).flat_map(|tank| {
        let closed = crate::scene::Side::ALL.into_iter().filter(|side| !tank.open.contains(side));
        closed.map(|side| format!("{} {}", tank.name, side.name()))
    });
    planes.chain(tanks).chain(boxes).filter(|name| !name.is_empty()).collect()
}
