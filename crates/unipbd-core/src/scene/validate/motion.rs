//! Scripts of kinematic bodies.

use super::checker::{Allowed, Checker, number};
use crate::scene::{BodyDescription, BodyKind, KeyPath, MotionDescription};

pub(super) fn check(checker: &mut Checker, path: &KeyPath, body: &BodyDescription) {
    let Some(motion) = &body.motion else { return };
    let path = path.then("motion");
    if body.kind != BodyKind::Kinematic {
        let hint = "write kind = \"kinematic\", or use `velocity` and `spin_deg` for a start";
        checker.problem(path.clone(), "only a kinematic body follows a script", hint);
    }
    let hint = "in 1/s; turn `phase_deg` by 180 for the other way";
    checker.range(path.then("frequency"), motion.frequency, Allowed::NotNegative, hint);
    check_parts(checker, &path, motion);
    check_path(checker, &path, motion);
}

/// An oscillation needs a frequency and an amplitude; a script is one kind of motion.
fn check_parts(checker: &mut Checker, path: &KeyPath, motion: &MotionDescription) {
    let swings = motion.amplitude != [0.0, 0.0] || motion.swing_deg != 0.0;
    let steady = motion.velocity != [0.0, 0.0] || motion.spin_deg != 0.0;
    let follows = !motion.path.is_empty();
    if swings && motion.frequency == 0.0 {
        checker.problem(path.clone(), "an oscillation without a frequency", "add frequency = 1.0, in 1/s");
    }
    let parts = [("velocity or spin_deg", steady), ("an oscillation", swings), ("a path", follows)];
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
