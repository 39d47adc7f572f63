//! What the coarse projection can carry.

use super::checker::{Allowed, Checker};
use crate::scene::{KeyPath, Scene};

/// Most steps of its solver: it converges long before.
const MOST_STEPS: f64 = 50.0;

pub(super) fn check(checker: &mut Checker) {
    let scene = checker.scene;
    let steps = scene.solver.coarse_projection;
    let path = KeyPath::key("solver").then("coarse_projection");
    let hint = "steps of its solver: 2 are enough, 0 is off";
    if steps == 0 || !checker.range(path.clone(), f64::from(steps), Allowed::Between(0.0, MOST_STEPS), hint) {
        return;
    }
    for (what, instead) in obstacles(scene) {
        checker.problem(path.clone(), format!("does not carry {what} yet"), instead);
    }
}

/// What stands in its way, and what to do about it.
fn obstacles(scene: &Scene) -> Vec<(&'static str, &'static str)> {
    const OFF: &str = "leave it out: the particles alone solve such a scene";
    let densities: Vec<f64> = scene.liquid.iter().map(|liquid| liquid.density).collect();
    let several = densities.windows(2).any(|pair| pair[0] != pair[1]);
    let uneven = scene.liquid.iter().any(|liquid| liquid.particle_mass.is_some());
    let filled = scene.materials().any(|material| material.is_two_sided());
    let periodic = scene.domain.periodic_x.is_some() || scene.domain.periodic_y.is_some();
    let all = [
        (scene.liquid.is_empty(), "a scene without a liquid", OFF),
        (several || uneven, "liquids of several densities", OFF),
        (filled, "gas, or liquids without a surface", OFF),
        (!scene.body.is_empty(), "bodies", OFF),
        (!scene.rope.is_empty() || !scene.solid.is_empty(), "ropes and solids", OFF),
        (periodic, "periodic domains", OFF),
        (scene.solver.sleep, "sleep", "leave out solver.sleep"),
        (scene.legacy.mass_density.is_some(), "densities weighted with masses", "leave out legacy.mass_density"),
    ];
    all.into_iter().filter(|(stands, ..)| *stands).map(|(_, what, instead)| (what, instead)).collect()
}
