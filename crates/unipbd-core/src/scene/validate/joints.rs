//! Joints, and the names of bodies they refer to.

use std::collections::HashSet;

use super::checker::{Allowed, Checker, entries};
use super::names::{HINTED, check_unique, excerpt, hint_for_unknown};
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

    /// Whether there is a body of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.all.contains(name)
    }

    /// The first names, for hints.
    pub(super) fn first(&self) -> impl Iterator<Item = &str> {
        self.first.iter().map(String::as_str)
    }
}

pub(super) fn check(checker: &mut Checker) {
    let names = BodyNames::of(checker.scene);
    let scene = checker.scene;
    let named = entries("joint", &scene.joint).map(|(path, joint)| (path, joint.name.as_str()));
    check_unique(checker, "joints", named);
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
    if names.has(name) {
        return;
    }
    let first: Vec<&str> = names.first().collect();
    let hint = match first.is_empty() {
        true => "the scene has no [[body]]".to_owned(),
        false => hint_for_unknown(name, &first, "bodies"),
    };
    checker.problem(path, format!("there is no body \"{}\"", excerpt(name)), hint);
}

fn check_values(checker: &mut Checker, path: &KeyPath, joint: &JointDescription) {
    checker.range(path.then("compliance"), joint.compliance, Allowed::NotNegative, "in m/N; 0 is rigid");
    checker.range(path.then("damping"), joint.damping, Allowed::NotNegative, "in N s/m; beside a compliance");
    checker.range(path.then("motor_torque"), joint.motor_torque, Allowed::Positive, "in N m; left out, no limit");
    checker.range(path.then("motor_force"), joint.motor_force, Allowed::Positive, "in N; left out, no limit");
    checker.range(path.then("length"), joint.length, Allowed::Positive, "in metres; left out, as the scene starts");
    checker.range(path.then("ratio"), joint.ratio, Allowed::Positive, "1 for a single rope");
    checker.range(path.then("break_force"), joint.break_force, Allowed::Positive, "in N; left out, it never breaks");
    checker.range(
        path.then("break_torque"),
        joint.break_torque,
        Allowed::Positive,
        "in N m; left out, it never breaks",
    );
    for (key, limits) in [("limits_deg", joint.limits_deg), ("limits", joint.limits)] {
        if limits.is_some_and(|[least, most]| least > most) {
            checker.problem(path.then(key), "must be the smaller value, then the larger", "swap the two");
        }
    }
    check_kind(checker, path, joint);
}

/// Keys that only some kinds of joints have, and keys that they need.
fn check_kind(checker: &mut Checker, path: &KeyPath, joint: &JointDescription) {
    use JointRule::{Hinge, Pulley, Rod, Rope, Slider};
    let apart = joint.other_at.is_some_and(|other| other != joint.at);
    let owners: [(&[JointRule], &str, &str, bool); 12] = [
        (&[Rod, Rope, Pulley], "rod, rope or pulley", "length", joint.length.is_some()),
        (&[Rod, Rope], "rod or rope", "compliance", joint.compliance != 0.0),
        (&[Rod, Rope], "rod or rope", "damping", joint.damping != 0.0),
        (&[Rod, Rope, Pulley, Slider], "rod, rope, slider or pulley", "other_at", apart),
        (&[Hinge], "hinge", "limits_deg", joint.limits_deg.is_some()),
        (&[Hinge], "hinge", "motor_speed_deg", joint.motor_speed_deg.is_some()),
        (&[Slider], "slider", "axis", joint.axis.is_some()),
        (&[Slider], "slider", "limits", joint.limits.is_some()),
        (&[Slider], "slider", "motor_speed", joint.motor_speed.is_some()),
        (&[Pulley], "pulley", "wheel", joint.wheel.is_some()),
        (&[Pulley], "pulley", "other_wheel", joint.other_wheel.is_some()),
        (&[Pulley], "pulley", "ratio", joint.ratio != 1.0),
    ];
    for (kinds, names, key, given) in owners {
        if given && !kinds.contains(&joint.kind) {
            let message = format!("only a {names} has `{key}`");
            checker.problem(path.then(key), message, format!("leave it out, or make the joint a {names}"));
        }
    }
    if joint.damping != 0.0 && joint.compliance == 0.0 && matches!(joint.kind, Rod | Rope) {
        let hint = "give a compliance [m/N]: a damper acts beside a spring";
        checker.problem(path.then("damping"), "has no effect on a rigid joint", hint);
    }
    match joint.kind {
        Slider if joint.axis.is_none() => {
            checker.problem(path.clone(), "a slider needs its `axis`", "such as axis = [1.0, 0.0]");
        }
        Slider => checker.direction(path.then("axis"), joint.axis.unwrap_or([1.0, 0.0]), "such as [1.0, 0.0]"),
        Pulley if joint.wheel.is_none() => {
            checker.problem(path.clone(), "a pulley needs its `wheel`", "a place in the world, above the bodies");
        }
        Pulley if joint.other.is_none() => {
            checker.problem(path.clone(), "a pulley joins two bodies", "name the second with `other`");
        }
        _ => {}
    }
}
