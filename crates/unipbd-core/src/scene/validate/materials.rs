//! Liquids, gases, smokes, and the names by which others refer to them.

use super::checker::{Allowed, Checker, entries};
use super::names::{HINTED, check_unique, excerpt, hint_for_unknown, list};
use crate::phase::{MaterialIndex, Phase};
use crate::scene::{KeyPath, Liquid, MaterialRef, Scene, TENSION_RADIUS};

const XSPH_HINT: &str = "the fraction of velocity differences smoothed per substep";
const NU_HINT: &str = "in m^2/s, such as 1e-6 for water; 0 is none";
const QUADRATIC_HINT: &str = "in 1/m: a particle alone falls at sqrt(g/coefficient)";
const TENSION_HINT: &str = "a force in N: that in N/m for a sheet one metre thick, such as 0.0728 for water; 0 is none";
const ANGLE_HINT: &str = "in degrees, measured within the liquid: 0 spreads on walls, 180 pearls off";
const MASS_HINT: &str = "in kg; left out, density times the squared spacing";
const LIFETIME_HINT: &str = "in seconds; left out, particles stay";
const DENSITY_HINT: &str = "mass per area in kg/m^2, such as 1000.0 for water or 1.2 for air";

pub(super) fn check(checker: &mut Checker) {
    for (path, liquid) in entries("liquid", &checker.scene.liquid) {
        checker.range(path.then("density"), liquid.density, Allowed::Positive, DENSITY_HINT);
        checker.range(path.then("particle_mass"), liquid.particle_mass, Allowed::Positive, MASS_HINT);
        checker.range(path.then("xsph"), liquid.xsph, Allowed::Between(0.0, 1.0), XSPH_HINT);
        let nu = liquid.kinematic_viscosity;
        checker.range(path.then("kinematic_viscosity"), nu, Allowed::NotNegative, NU_HINT);
        checker.range(path.then("surface_tension"), liquid.surface_tension, Allowed::NotNegative, TENSION_HINT);
        checker.range(path.then("contact_angle"), liquid.contact_angle, Allowed::Between(0.0, 180.0), ANGLE_HINT);
        checker.range(path.then("quadratic_drag"), liquid.quadratic_drag, Allowed::NotNegative, QUADRATIC_HINT);
        if liquid.surface_tension > 0.0 && checker.scene.solver.kernel_radius < TENSION_RADIUS {
            let message = format!("needs neighbours within {TENSION_RADIUS} spacings");
            checker.problem(path.then("surface_tension"), message, "leave out solver.kernel_radius, or make it 3.0");
        }
        if checker.scene.solver.sleep {
            check_sleep(checker, &path, liquid);
        }
    }
    check_gases(checker);
    for (path, smoke) in entries("smoke", &checker.scene.smoke) {
        checker.range(path.then("lifetime"), smoke.lifetime, Allowed::Positive, LIFETIME_HINT);
    }
    for (path, solid) in entries("solid", &checker.scene.solid) {
        checker.range(path.then("density"), solid.density, Allowed::Positive, DENSITY_HINT);
    }
    check_names(checker);
    let (count, most) = (checker.scene.materials().count(), usize::from(MaterialIndex::MAX));
    if count > most {
        checker.problems.add(KeyPath::default(), format!("has {count} materials, at most {most} are possible"));
    }
}

/// What acts on a liquid at rest must act the same as long as it sleeps.
fn check_sleep(checker: &mut Checker, path: &KeyPath, liquid: &Liquid) {
    for (key, value) in [("surface_tension", liquid.surface_tension), ("quadratic_drag", liquid.quadratic_drag)] {
        if value > 0.0 {
            checker.problem(path.then(key), "is not possible where liquids sleep", "leave out solver.sleep");
        }
    }
}

fn check_gases(checker: &mut Checker) {
    for (path, gas) in entries("gas", &checker.scene.gas) {
        checker.range(path.then("density"), gas.density, Allowed::Positive, DENSITY_HINT);
        checker.range(path.then("particle_mass"), gas.particle_mass, Allowed::Positive, MASS_HINT);
        checker.range(path.then("drag"), gas.drag, Allowed::NotNegative, "a rate in 1/s; 0 is no drag");
        checker.range(path.then("quadratic_drag"), gas.quadratic_drag, Allowed::NotNegative, QUADRATIC_HINT);
        checker.range(path.then("conductivity"), gas.conductivity, Allowed::NotNegative, "a diffusivity in m^2/s");
        checker.range(path.then("xsph"), gas.xsph, Allowed::Between(0.0, 1.0), XSPH_HINT);
        checker.range(path.then("kinematic_viscosity"), gas.kinematic_viscosity, Allowed::NotNegative, NU_HINT);
        checker.range(path.then("lifetime"), gas.lifetime, Allowed::Positive, LIFETIME_HINT);
        let hint = "in metres, at least as large as the sheath is thick; left out, all gas stays";
        checker.range(path.then("keep_radius"), gas.keep_radius, Allowed::Positive, hint);
        checker.range(path.then("keep_age"), gas.keep_age, Allowed::NotNegative, "in seconds");
    }
}

/// Names and colours of all materials.
fn check_names(checker: &mut Checker) {
    let materials = with_paths(checker.scene);
    for (path, material) in &materials {
        if material.name().trim().is_empty() {
            checker.problem(path.then("name"), "a material needs a name", "add a line such as name = \"water\"");
        }
        check_color(checker, path, material.color());
    }
    let named = materials.into_iter().map(|(path, material)| (path, material.name()));
    check_unique(checker, "materials", named.filter(|(_, name)| !name.trim().is_empty()));
}

fn check_color(checker: &mut Checker, path: &KeyPath, color: Option<&str>) {
    let Some(color) = color else { return };
    let digits = color.strip_prefix('#').filter(|digits| digits.len() == 6);
    if !digits.is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit())) {
        let message = format!("\"{}\" is not a colour of the form \"#rrggbb\"", excerpt(color));
        checker.problem(
            path.then("color"),
            message,
            "such as \"#3b82f6\": two hexadecimal digits each for red, green, blue",
        );
    }
}

/// The phases a place of the scene may name, in words: `[Liquid, Gas]` is "a liquid or a gas".
fn in_words(phases: &[Phase]) -> String {
    let words: Vec<String> = phases.iter().map(|phase| format!("a {}", phase.name())).collect();
    words.join(" or ")
}

/// Checks that `name` is a material of one of these phases.
pub(super) fn check_reference(checker: &mut Checker, path: KeyPath, name: &str, wanted: &[Phase]) {
    if name.trim().is_empty() {
        return checker.problem(path, "names no material", "write the name of a material of this scene");
    }
    if let Some(material) = checker.materials.get(name).copied() {
        if !wanted.contains(&material.phase()) {
            let message = format!("\"{}\" is a {}, not {}", excerpt(name), material.phase().name(), in_words(wanted));
            checker.problem(path, message, wrong_phase_hint(checker.scene, wanted));
        }
        return;
    }
    // A material whose own name is at fault may be the one that is meant.
    if checker.materials.keys().any(|name| name.trim().is_empty()) {
        return;
    }
    let hint = unknown_hint(checker.scene, name, wanted);
    checker.problem(path, format!("there is no material \"{}\"", excerpt(name)), hint);
}

fn unknown_hint(scene: &Scene, name: &str, wanted: &[Phase]) -> String {
    let names: Vec<&str> = scene.materials().map(|material| material.name()).take(HINTED).collect();
    if names.is_empty() {
        let table = wanted.first().map_or("liquid", |phase| phase.name());
        return format!("add a table [[{table}]] with name = \"{}\"", excerpt(name));
    }
    hint_for_unknown(name, &names, "materials")
}

fn wrong_phase_hint(scene: &Scene, wanted: &[Phase]) -> String {
    let fitting = scene.materials().filter(|material| wanted.contains(&material.phase()));
    let names: Vec<&str> = fitting.map(|material| material.name()).take(HINTED).collect();
    if names.is_empty() { format!("the scene has no {}", wanted[0].name()) } else { list("possible are", &names) }
}

fn with_paths(scene: &Scene) -> Vec<(KeyPath, MaterialRef<'_>)> {
    let fluids = [("liquid", scene.liquid.len()), ("gas", scene.gas.len())];
    let counts = fluids.into_iter().chain([("smoke", scene.smoke.len()), ("solid", scene.solid.len())]);
    let paths = counts.flat_map(|(kind, count)| (0..count).map(move |index| KeyPath::entry(kind, index)));
    paths.zip(scene.materials()).collect()
}
