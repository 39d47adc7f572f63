//! Joints, and the names of bodies they refer to.

use std::collections::HashSet;

use super::checker::{Allowed, Checker, entries};
use super::names::{HINTED, excerpt, hint_for_unknown};
use crate::scene::{JointDescription, JointRule, KeyPath, Scene};

/// The names of all bodies.
pub(super) struct BodyNames {
    all: HashSet<String>,
    /// The first of them, for hints.
    first: Vec<String>,
}

impl BodyNames {
    pub(super) fn of(scene: &Scene) -> BodyNames {
        let names = scene.body_names();
        let first = names.iter().take(HINTED).cloned().collect();
        BodyNames { all: names.into_iter().collect(), first }
    }
}

pub(super) fn check(checker: &mut Checker) {
    let names = BodyNames::of(checker.scene);
    for (path, joint) in entries("joint", &checker.scene.joint) {
        check_body(checker, path.then("body"), &joint.body, &names);
        if let Some(other) = &joint.other {
            check_body(checker, path.then("other"), other, &names);
            if *other == joint.body {
                checker.problem(
                    path.then("other"),
                    "joins a body to itself",
                    "leave it out for a joint with the world",
                );
            }
        }
        check_values(checker, &path, joint);
    }
}

/// Notes the name of a body that does not exist.
pub(super) fn check_body(checker: &mut Checker, path: KeyPath, name: &str, names: &BodyNames) {
    if names.all.contains(name) {
        return;
    }
    let first: Vec<&str> = names.first.iter().map(String::as_str).collect();
    let hint = match first.is_empty() {
        true => "the scene has no [[body]]".to_owned(),
        false => hint_for_unknown(name, &first, "bodies"),
    };
    checker.problem(path, format!("there is no body \"{}\"", excerpt(name)), hint);
}

fn check_values(checker: &mut Checker, path: &KeyPath, joint: &JointDescription) {
    checker.range(path.then("compliance"), joint.compliance, Allowed::NotNegative, "in m/N; 0 is rigid");
    checker.range(path.then("motor_torque"), joint.motor_torque, Allowed::Positive, "in N m; left out, no limit");
    checker.range(path.then("length"), joint.length, Allowed::Positive, "in metres; left out, as the scene starts");
    if joint.kind == JointRule::Hinge {
        let apart = joint.other_at.is_some_and(|other| other != joint.at);
        let given = [("length", joint.length.is_some()), ("other_at", apart), ("compliance", joint.compliance != 0.0)];
        for (key, _) in given.into_iter().filter(|(_, given)| *given) {
            let hint = "leave it out, or make the joint a \"rod\" or a \"rope\"";
            checker.problem(path.then(key), format!("a hinge has no `{key}`"), hint);
        }
    } else if joint.motor_speed_deg.is_some() {
        let hint = "make the joint a \"hinge\", or leave it out";
        checker.problem(path.then("motor_speed_deg"), "only a hinge has a motor", hint);
    }
}
