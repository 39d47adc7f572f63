//! Scripts of kinematic bodies.

use super::checker::{Allowed, Checker, number};
use super::names::excerpt;
use crate::scene::{BodyDescription, BodyKind, KeyPath, MOST_SAMPLES, MotionDescription};

pub(super) fn check(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    let (moves, spins) = (body.velocity != [0.0, 0.0], body.spin_deg != 0.0);
    let start = (moves || spins).then(|| path.then(if moves { "velocity" } else { "spin_deg" }));
    if let (BodyKind::Static, Some(start)) = (body.kind, &start) {
        checker.problem(start.clone(), "a static body never moves", "leave it out, or write kind = \"kinematic\"");
    }
    let Some(motion) = &body.motion else { return };
    if let (BodyKind::Kinematic, Some(start)) = (body.kind, start) {
        checker.problem(start, "the body is moved by `motion`", "leave one of them out");
    }
    let path = path.then("motion");
    if body.kind != BodyKind::Kinematic {
        let hint = "write kind = \"kinematic\", or use `velocity` and `spin_deg` for a start";
        checker.problem(path.clone(), "only a kinematic body follows a script", hint);
    }
    let hint = "in 1/s; turn `phase_deg` by 180 for the other way";
    checker.range(path.then("frequency"), motion.frequency, Allowed::NotNegative, hint);
    check_parts(checker, &path, motion);
    check_path(checker, &path, motion);
    check_file(checker, &path, &motion.file);
    if let Some(table) = &motion.table {
        check_table(checker, &path.then("table"), &table.time, &table.columns());
    }
}

/// The acceleration of the frame of reference.
pub(super) fn check_shaking(checker: &mut Checker) {
    let shaking = &checker.scene.shaking;
    let path = KeyPath::key("shaking");
    check_file(checker, &path, &shaking.file);
    if let Some(table) = &shaking.table {
        check_table(checker, &path.then("table"), &table.time, &table.columns());
    }
}

/// Readers of scene files read what `file` names; what is left was read by none.
fn check_file(checker: &mut Checker, path: &KeyPath, file: &str) {
    if !file.is_empty() {
        let message = format!("there are no files here, \"{}\" cannot be read", excerpt(file));
        checker.problem(path.then("file"), message, "give the samples themselves as `table`");
    }
}

fn check_table(checker: &mut Checker, path: &KeyPath, times: &[f64], columns: &[(&str, &[f64])]) {
    let count = times.len();
    if !(2..=MOST_SAMPLES).contains(&count) {
        let message = format!("needs 2 to {MOST_SAMPLES} samples, found {count}");
        return checker.problem(path.then("time"), message, "one time for each sample, in seconds");
    }
    if let Some(index) = times.windows(2).position(|two| two[1] <= two[0]) {
        let message = format!("must increase, found {} after {}", number(times[index + 1]), number(times[index]));
        checker.problem(path.then("time").then_index(index + 1), message, "sort the samples by time");
    }
    if columns.iter().all(|(_, values)| values.is_empty()) {
        let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
        checker.problem(path.clone(), "has nothing besides times", format!("add one or more of {}", names.join(", ")));
    }
    for (name, values) in columns.iter().filter(|(_, values)| !values.is_empty() && values.len() != count) {
        let message = format!("has {} values for {count} times", values.len());
        checker.problem(path.then(name), message, "one for each time");
    }
}

/// An oscillation needs a frequency and an amplitude; a script is one kind of motion.
fn check_parts(checker: &mut Checker, path: &KeyPath, motion: &MotionDescription) {
    let swings = motion.amplitude != [0.0, 0.0] || motion.swing_deg != 0.0;
    let steady = motion.velocity != [0.0, 0.0] || motion.spin_deg != 0.0;
    let follows = !motion.path.is_empty();
    if swings && motion.frequency == 0.0 {
        checker.problem(path.clone(), "an oscillation without a frequency", "add frequency = 1.0, in 1/s");
    }
    let sampled = motion.table.is_some();
    let parts =
        [("velocity or spin_deg", steady), ("an oscillation", swings), ("a path", follows), ("a table", sampled)];
    let given: Vec<&str> = parts.iter().filter(|(_, given)| *given).map(|(name, _)| *name).collect();
    if let [first, second, ..] = given[..] {
        let message = format!("a script is one kind of motion, found {first} and {second}");
        checker.problem(path.clone(), message, "keep one of them; a path can hold any motion");
    }
}

fn check_path(checker: &mut Checker, path: &KeyPath, motion: &MotionDescription) {
    for (index, pair) in motion.path.windows(2).enumerate() {
        let [before, after] = [pair[0].time, pair[1].time];
        if after <= before {
            let message =
                format!("must come after the last station at {} s, found {} s", number(before), number(after));
            let path = path.then("path").then_index(index + 1).then("time");
            checker.problem(path, message, "list the stations by increasing time");
        }
    }
}
