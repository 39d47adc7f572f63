//! Ropes.

use super::checker::{Allowed, Checker, entries, rounded};
use super::joints::{BodyNames, check_body};
use super::materials::check_reference;
use crate::phase::Phase;

pub(super) fn check(checker: &mut Checker) {
    let names = BodyNames::of(checker.scene);
    for (path, rope) in entries("rope", &checker.scene.rope) {
        check_reference(checker, path.then("material"), &rope.material, &[Phase::Solid, Phase::Liquid]);
        checker.range(path.then("compliance"), rope.compliance, Allowed::NotNegative, "in m/N; 0 does not stretch");
        if let Some(body) = &rope.body {
            check_body(checker, path.then("body"), body, &names);
        }
        if let Some(body) = &rope.from_body {
            check_body(checker, path.then("from_body"), body, &names);
            if rope.body.as_ref() == Some(body) {
                let hint = "name another body, or leave one of `from_body` and `body` out";
                checker.problem(path.then("from_body"), "ties a body to itself", hint);
            }
        }
        let distance = libm::hypot(rope.to[0] - rope.from[0], rope.to[1] - rope.from[1]);
        let length = rope.full_length();
        let hint = "make it longer, or move the ends together";
        if checker.range(path.then("length"), length, Allowed::Positive, hint) && length < distance * (1.0 - 1e-9) {
            let message = format!("is shorter than the distance of the ends ({} m)", rounded(distance));
            checker.problem(path.then("length"), message, hint);
        }
    }
}
