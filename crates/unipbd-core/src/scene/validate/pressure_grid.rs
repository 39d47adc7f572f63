//! The settings of the pressure grid, and what it supports.

use super::checker::{Allowed, Checker};
use crate::scene::{KeyPath, PressureGridUse};

/// Most steps of its solver: it converges long before.
const MOST_STEPS: f64 = 200.0;

pub(super) fn check(checker: &mut Checker) {
    let scene = checker.scene;
    let key = |name: &str| KeyPath::key("solver").then(name);
    let solver = &scene.solver;
    let steps = f64::from(solver.pressure_steps);
    checker.range(key("pressure_steps"), steps, Allowed::Between(1.0, MOST_STEPS), "50 are enough");
    let tolerance = Allowed::Between(1e-6, 0.5);
    checker.range(key("pressure_tolerance"), solver.pressure_tolerance, tolerance, "0.01 is enough");
    if solver.pressure_grid == PressureGridUse::On {
        for (what, instead) in scene.pressure_grid_obstacles() {
            checker.problem(key("pressure_grid"), format!("does not support {what}"), instead);
        }
    }
}
