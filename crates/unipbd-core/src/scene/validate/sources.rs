//! Blocks, discs and emitters by themselves.

use super::checker::{Allowed, Checker, entries, number, rounded};
use super::materials::check_reference;
use super::names::check_unique;
use super::regions::check_schedule;
use super::settings::FRAME_RATES;
use crate::phase::Phase;
use crate::scene::{Emitter, KeyPath, PointMotion, Points, Substeps};

const FLUIDS: [Phase; 2] = [Phase::Liquid, Phase::Gas];
const JITTER_HINT: &str = "a fraction of the spacing, such as 0.1";

pub(super) fn check(checker: &mut Checker) {
    let scene = checker.scene;
    for (path, block) in entries("block", &scene.block) {
        check_reference(checker, path.then("material"), &block.material, &FLUIDS);
        if checker.corners(&path, block.min, block.max) {
            let [width, height] = [0, 1].map(|axis| block.max[axis] - block.min[axis]);
            let (thickness, what) = if width < height { (width, "the width") } else { (height, "the height") };
            checker.at_least_one_spacing(path.then("max"), thickness, what);
        }
        check_filling(checker, &path, block.velocity, block.jitter);
    }
    for (path, disc) in entries("disc", &scene.disc) {
        check_reference(checker, path.then("material"), &disc.material, &FLUIDS);
        if checker.range(path.then("radius"), disc.radius, Allowed::Positive, "a length in metres") {
            checker.at_least_one_spacing(path.then("radius"), disc.radius, "the radius");
        }
        check_filling(checker, &path, disc.velocity, disc.jitter);
    }
    for (path, points) in entries("points", &scene.points) {
        check_points(checker, &path, points);
    }
    check_emitters(checker);
    let none = scene.block.is_empty() && scene.disc.is_empty() && scene.emitter.is_empty() && scene.body.is_empty();
    let none = none && scene.rope.is_empty();
    if none && scene.points.iter().all(|points| points.positions.is_empty()) {
        let message = "the scene has no particles: neither [[block]] nor [[disc]], [[emitter]] or [[body]]";
        checker.problem(KeyPath::default(), message, "add a [[block]] with material, min and max, and its [[liquid]]");
    }
}

fn check_points(checker: &mut Checker, path: &KeyPath, points: &Points) {
    check_reference(
        checker,
        path.then("material"),
        &points.material,
        &[FLUIDS[0], FLUIDS[1], Phase::Smoke, Phase::Solid],
    );
    let (given, wanted) = (points.velocities.len(), points.positions.len());
    if given != 0 && given != wanted {
        let message = format!("there are {given} velocities for {wanted} positions");
        checker.problem(path.then("velocities"), message, "one for each position, or one `velocity` for all");
    }
    check_throw(checker, path.then("velocity"), libm::hypot(points.velocity[0], points.velocity[1]));
    let fastest = points.velocities.iter().map(|v| libm::hypot(v[0], v[1])).fold(0.0, f64::max);
    check_throw(checker, path.then("velocities"), fastest);
    let smoke = checker.materials.get(points.material.as_str()).is_some_and(|known| known.phase() == Phase::Smoke);
    if smoke && points.motion == PointMotion::Kinematic {
        checker.problem(path.then("motion"), "smoke moves with its carrier, not by itself", "leave it out");
    }
}

fn check_filling(checker: &mut Checker, path: &KeyPath, velocity: [f64; 2], jitter: f64) {
    checker.range(path.then("jitter"), jitter, Allowed::Between(0.0, 0.5), JITTER_HINT);
    check_throw(checker, path.then("velocity"), libm::hypot(velocity[0], velocity[1]));
}

fn check_emitters(checker: &mut Checker) {
    let scene = checker.scene;
    let emitters = || entries("emitter", &scene.emitter);
    check_unique(checker, "emitters", emitters().map(|(path, emitter)| (path, emitter.name.as_str())));
    for (path, emitter) in emitters() {
        check_reference(checker, path.then("material"), &emitter.material, &FLUIDS);
        check_nozzle(checker, &path, emitter);
        check_sheath_and_smoke(checker, &path, emitter);
        check_schedule(checker, &path, emitter.start, emitter.stop);
    }
}

fn check_nozzle(checker: &mut Checker, path: &KeyPath, emitter: &Emitter) {
    checker.direction(path.then("direction"), emitter.direction, "the way the flow goes, such as [0.0, 1.0] for up");
    if checker.range(path.then("width"), emitter.width, Allowed::Positive, "the width of the face in metres") {
        checker.at_least_one_spacing(path.then("width"), emitter.width, "the width");
    }
    let hint = "in m/s; turn `direction` around for a flow the other way";
    if checker.range(path.then("speed"), emitter.speed, Allowed::Positive, hint) {
        check_speed(checker, path.then("speed"), emitter.speed);
    }
    checker.range(path.then("jitter"), emitter.jitter, Allowed::Between(0.0, 0.5), JITTER_HINT);
}

fn check_sheath_and_smoke(checker: &mut Checker, path: &KeyPath, emitter: &Emitter) {
    if let Some(sheath) = &emitter.sheath {
        let path = path.then("sheath");
        if checker.range(path.then("thickness"), sheath.thickness, Allowed::Positive, "leave out `sheath` for none") {
            checker.at_least_one_spacing(path.then("thickness"), sheath.thickness, "the thickness");
        }
        if let Some(speed) = sheath.speed
            && checker.range(path.then("speed"), speed, Allowed::Positive, "left out, the speed of the core")
        {
            check_speed(checker, path.then("speed"), speed);
        }
    }
    if let Some(smoke) = &emitter.smoke {
        let path = path.then("smoke");
        check_reference(checker, path.then("material"), &smoke.material, &[Phase::Smoke]);
        let markers = f64::from(smoke.per_particle);
        let hint = "3 or 4 look smooth; leave out `smoke` for none";
        checker.range(path.then("per_particle"), markers, Allowed::Between(1.0, 1000.0), hint);
    }
}

/// Farthest that anything may fly in a frame \[spacings]: beyond, a digit is wrong.
const FARTHEST: f64 = 1e4;

/// Notes a speed at the start that cannot be meant. Walls hold whatever is slower.
fn check_throw(checker: &mut Checker, path: KeyPath, speed: f64) {
    let scene = checker.scene;
    let Some(spacing) = checker.spacing else { return };
    let leap = speed / scene.fps / spacing;
    if scene.fps >= FRAME_RATES.0 && leap.is_finite() && leap > FARTHEST {
        let message = format!("{} m/s is too fast: {} spacings in one frame", rounded(speed), rounded(leap));
        checker.problem(path, message, "lower the speed, or raise `fps`");
    }
}

/// Notes a speed at which a particle would leap over its own kernel in one substep.
fn check_speed(checker: &mut Checker, path: KeyPath, speed: f64) {
    let scene = checker.scene;
    let (count, cure) = match scene.solver.substeps {
        Substeps::Auto => (scene.solver.max_substeps, "`solver.max_substeps`"),
        Substeps::Fixed(count) => (count, "`solver.substeps`"),
    };
    let Some(spacing) = checker.spacing else { return };
    let leap = speed / scene.fps / f64::from(count) / spacing;
    let settings_are_fine = scene.fps >= FRAME_RATES.0 && count >= 1 && scene.solver.kernel_radius >= 1.5;
    if settings_are_fine && leap.is_finite() && leap > scene.solver.kernel_radius {
        let message = format!(
            "{} m/s is too fast: {} spacings in one substep ({count} substeps per frame, {} frames per second)",
            rounded(speed),
            rounded(leap),
            number(scene.fps)
        );
        checker.problem(path, message, format!("lower the speed, or raise {cure} or `fps`"));
    }
}
