//! Values so large or so small that a run would diverge within a few frames, whatever else the scene holds.

use super::checker::{Allowed, Checker, entries, rounded};
use super::settings::FRAME_RATES;
use crate::scene::KeyPath;

/// Farthest that a force may take a particle from rest in one frame [spacings].
const LEAP: f64 = 1e4;
/// Strongest gusts [spacings per frame].
const GALE: f64 = 1e3;
/// Densities [kg/m^2]: from a thousandth of hydrogen to a thousand times lead, in single precision far from its ends.
const DENSITIES: (f64, f64) = (1e-6, 1e9);
/// Masses of particles and bodies [kg].
const MASSES: (f64, f64) = (1e-12, 1e15);
/// Strongest confinement of vorticity, and strongest baroclinic effect: 1 is strong.
const STRENGTH: f64 = 1e3;
/// Largest temperature, in multiples of that at which gravity acts in full.
const HOTTEST: f64 = 1e4;

pub(super) fn check(checker: &mut Checker) {
    let scene = checker.scene;
    check_air(checker);
    let mass = |checker: &mut Checker, path: &KeyPath, density: f64, mass: Option<f64>| {
        let hint = "mass per area in kg/m^2: 1000 is water, 1.2 is air";
        beyond(checker, path.then("density"), density, DENSITIES, hint);
        beyond(checker, path.then("particle_mass"), mass.unwrap_or(1.0), MASSES, "in kg");
    };
    let mut pulls = Vec::new();
    for (path, liquid) in entries("liquid", &scene.liquid) {
        mass(checker, &path, liquid.density, liquid.particle_mass);
        let mass = liquid.particle_mass.unwrap_or(liquid.density * scene.spacing * scene.spacing);
        pulls.push((path.then("surface_tension"), liquid.surface_tension / mass));
        pulls.push((path.then("gravity_factor"), liquid.gravity_factor * strength(scene.gravity)));
    }
    for (path, gas) in entries("gas", &scene.gas) {
        mass(checker, &path, gas.density, gas.particle_mass);
        pulls.push((path.then("gravity_factor"), gas.gravity_factor * strength(scene.gravity)));
        for (key, value) in [("vorticity", gas.vorticity), ("baroclinic", gas.baroclinic)] {
            let hint = "1 is strong";
            checker.range(path.then(key), value, Allowed::Between(-STRENGTH, STRENGTH), hint);
        }
    }
    for (path, solid) in entries("solid", &scene.solid) {
        mass(checker, &path, solid.density, None);
        pulls.push((path.then("gravity_factor"), solid.gravity_factor * strength(scene.gravity)));
    }
    for (path, body) in entries("body", &scene.body) {
        beyond(checker, path.then("density"), body.density, DENSITIES, "mass per area in kg/m^2; 1000 is water");
        beyond(checker, path.then("mass"), body.mass.unwrap_or(1.0), MASSES, "in kg");
        pulls.push((path.then("gravity_factor"), body.gravity_factor * strength(scene.gravity)));
    }
    if let Some(table) = &scene.shaking.table {
        let [ax, ay] = [&table.ax, &table.ay].map(|values| largest(values));
        pulls.push((KeyPath::key("shaking").then("table"), strength([ax, ay])));
    }
    for (path, acceleration) in pulls {
        check_pull(checker, path, acceleration);
    }
    check_temperatures(checker);
}

fn check_air(checker: &mut Checker) {
    let Some(spacing) = checker.spacing else { return };
    let (gusts, limit) = (checker.scene.environment.gusts, GALE * spacing * checker.scene.fps);
    if gusts.is_finite() && checker.scene.fps >= FRAME_RATES.0 && gusts > limit {
        let message = format!("{} m/s is more than {GALE} spacings per frame ({} m/s)", rounded(gusts), rounded(limit));
        checker.problem(KeyPath::key("environment").then("gusts"), message, "a gale has 30 m/s");
    }
}

/// Notes a value above 0 that is outside of its range; what is not above 0 is noted elsewhere.
fn beyond(checker: &mut Checker, path: KeyPath, value: f64, (least, most): (f64, f64), hint: &str) {
    if value > 0.0 {
        checker.range(path, value, Allowed::Between(least, most), hint);
    }
}

/// The largest amount of the values; those that are not finite are noted elsewhere.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

fn strength([x, y]: [f64; 2]) -> f64 {
    libm::hypot(x, y)
}

/// Notes an acceleration that takes a particle at rest too far in one frame.
fn check_pull(checker: &mut Checker, path: KeyPath, acceleration: f64) {
    let Some(spacing) = checker.spacing else { return };
    // Gravity by itself has a limit of its own.
    let (fps, own) = (checker.scene.fps, strength(checker.scene.gravity));
    let limit = (LEAP * spacing * fps * fps).max(own);
    if acceleration.is_finite() && fps >= FRAME_RATES.0 && acceleration.abs() > limit {
        let message = format!("accelerates by {} m/s^2; the limit is {} m/s^2", rounded(acceleration), rounded(limit));
        checker.problem(path, message, "lower it, or raise `fps`");
    }
}

fn check_temperatures(checker: &mut Checker) {
    let scene = checker.scene;
    let mut all = Vec::new();
    all.extend(entries("block", &scene.block).map(|(path, block)| (path, block.temperature)));
    all.extend(entries("disc", &scene.disc).map(|(path, disc)| (path, disc.temperature)));
    all.extend(entries("points", &scene.points).map(|(path, points)| (path, points.temperature)));
    all.extend(entries("injector", &scene.injector).map(|(path, injector)| (path, injector.temperature)));
    all.extend(entries("heater", &scene.heater).map(|(path, heater)| (path, heater.temperature)));
    for (path, emitter) in entries("emitter", &scene.emitter) {
        let sheath = emitter.sheath.as_ref().map(|sheath| (path.then("sheath"), sheath.temperature));
        all.push((path, emitter.temperature));
        all.extend(sheath);
    }
    for (path, temperature) in all {
        let hint = "gravity acts on gas in proportion to it: 1 is its full strength";
        checker.range(path.then("temperature"), temperature, Allowed::Between(-HOTTEST, HOTTEST), hint);
    }
}
