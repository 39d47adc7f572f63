//! Spacing, time, solver.

use super::checker::{Allowed, Checker, number};
use crate::scene::{KeyPath, Substeps};

/// Spacings outside this range leave the reach of single precision in the kernels, which hold h^-4 \[m].
const SPACING: (f64, f64) = (1e-6, 1e6);
/// Longest run \[s]: about 12 days, 60 million frames at the default rate.
pub const LONGEST_DURATION: f64 = 1e6;
/// Output frames per second [1/s].
pub const FRAME_RATES: (f64, f64) = (1e-3, 1e6);
/// Largest acceleration [m/s^2] and speed [m/s]: far above any sensible scene, far below overflow.
const HUGE: f64 = 1e9;

pub(super) fn check(checker: &mut Checker) {
    check_spacing(checker);
    check_time(checker);
    check_solver(checker);
    let gravity = checker.scene.gravity;
    for (axis, value) in gravity.into_iter().enumerate() {
        let path = KeyPath::key("gravity").then_index(axis);
        checker.range(path, value, Allowed::Between(-HUGE, HUGE), "in m/s^2; on Earth [0.0, -9.81]");
    }
}

fn check_spacing(checker: &mut Checker) {
    let (spacing, path) = (checker.scene.spacing, KeyPath::key("spacing"));
    let hint = "the distance between neighbouring particles in metres, such as 0.1";
    if !checker.range(path.clone(), spacing, Allowed::Positive, hint) {
        return;
    }
    let allowed = Allowed::Between(SPACING.0, SPACING.1);
    if !checker.range(path, spacing, allowed, "all lengths are in metres; choose units in which the scene is of size 1")
    {
        checker.spacing = None;
    }
}

fn check_time(checker: &mut Checker) {
    let scene = checker.scene;
    let hint = "simulated time in seconds, such as 5.0";
    if checker.range(KeyPath::key("duration"), scene.duration, Allowed::Positive, hint) {
        let message = format!("{} s is too long: at most {} s", number(scene.duration), number(LONGEST_DURATION));
        if scene.duration > LONGEST_DURATION {
            checker.problem(KeyPath::key("duration"), message, hint);
        }
    }
    let hint = "output frames per simulated second, such as 60";
    checker.range(KeyPath::key("fps"), scene.fps, Allowed::Between(FRAME_RATES.0, FRAME_RATES.1), hint);
}

fn check_solver(checker: &mut Checker) {
    let solver = &checker.scene.solver;
    let path = |key| KeyPath::key("solver").then(key);
    let counts = Allowed::Between(1.0, 100_000.0);
    if let Substeps::Fixed(count) = solver.substeps {
        checker.range(path("substeps"), f64::from(count), counts, "write a number such as 8, or \"auto\"");
    }
    checker.range(path("max_substeps"), f64::from(solver.max_substeps), counts, "the default is 256");
    let hint = "one is best; raise `substeps` for accuracy";
    checker.range(path("iterations"), f64::from(solver.iterations), Allowed::Between(1.0, 1000.0), hint);
    let hint = "0.01 stops at 1 % compression; 0 never stops";
    checker.range(path("tolerance"), solver.tolerance, Allowed::NotNegative, hint);
    let settle = solver.settle_substeps.map(f64::from);
    checker.range(path("settle_substeps"), settle, Allowed::Between(0.0, 1e5), "leave it out for 100 or more");
    let hint = "in spacings; the default is 3";
    checker.range(path("kernel_radius"), solver.kernel_radius, Allowed::Between(1.5, 4.0), hint);
    let hint = "a fraction: 0.01 aims at 1 % compression";
    checker.range(path("target_compression"), solver.target_compression, Allowed::Between(1e-6, 0.5), hint);
    let hint = "leave it out for what is stable; 0 is off";
    checker.range(path("shifting"), solver.shifting, Allowed::Between(0.0, 0.2), hint);
    if solver.sleep && !checker.scene.rope.is_empty() {
        checker.problem(path("sleep"), "does not know ropes yet", "leave it out, or the ropes");
    }
    let hint = "leave it out: what is stable follows from the kernel radius";
    if checker.range(path("relaxation"), solver.relaxation, Allowed::Positive, hint) {
        checker.range(path("relaxation"), solver.relaxation, Allowed::Between(0.0, 2.0), hint);
    }
}
