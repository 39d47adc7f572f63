//! Injectors, sinks, heaters, and waves.

use super::checker::{Allowed, Checker, entries, number};
use super::materials::check_reference;
use crate::phase::Phase;
use crate::scene::{KeyPath, Region};

const LOOSE: [Phase; 3] = [Phase::Liquid, Phase::Gas, Phase::Smoke];

pub(super) fn check(checker: &mut Checker) {
    let scene = checker.scene;
    for (path, injector) in entries("injector", &scene.injector) {
        check_reference(checker, path.then("material"), &injector.material, &LOOSE);
        check_region(checker, &path, &injector.region);
        checker.range(path.then("rate"), injector.rate, Allowed::Between(0.0, 1e7), "particles per second");
        check_schedule(checker, &path, injector.start, injector.stop);
    }
    for (path, sink) in entries("sink", &scene.sink) {
        for (number, material) in sink.materials.iter().enumerate() {
            check_reference(checker, path.then("materials").then_index(number), material, &LOOSE);
        }
        check_region(checker, &path, &sink.region);
        checker.range(path.then("rate"), sink.rate, Allowed::Positive, "particles per second; left out, no limit");
        check_schedule(checker, &path, sink.start, sink.stop);
    }
    for (path, heater) in entries("heater", &scene.heater) {
        check_region(checker, &path, &heater.region);
        checker.range(path.then("rate"), heater.rate, Allowed::NotNegative, "a rate in 1/s, such as 20.0");
        if scene.gas.is_empty() {
            checker.problem(path, "warms nothing: the scene has no [[gas]]", "only gas has a temperature");
        }
    }
    check_waves(checker);
}

fn check_waves(checker: &mut Checker) {
    for (path, wave) in entries("wave", &checker.scene.wave) {
        let hint = "in metres, at least a few spacings";
        if checker.range(path.then("wavelength"), wave.wavelength, Allowed::Positive, hint) {
            let steepest = 0.1 * wave.wavelength;
            let hint = "at most a tenth of the wavelength: a steeper start is no longer at rest density";
            let allowed = Allowed::Between(-steepest, steepest);
            if checker.range(path.then("amplitude"), wave.amplitude, allowed, hint)
                && wave.amplitude.abs() < checker.scene.spacing
            {
                let message = format!("must be one spacing ({} m) or more", number(checker.scene.spacing));
                checker.problem(path.then("amplitude"), message, "a finer spacing shows smaller waves");
            }
        }
        if wave.bottom.is_some_and(|bottom| bottom >= wave.level) {
            checker.problem(path.then("bottom"), "must lie below the level", "leave it out for a deep layer");
        }
        if wave.top.is_some_and(|top| top <= wave.level) {
            checker.problem(path.then("top"), "must lie above the level", "leave it out for a deep layer");
        }
    }
}

fn check_region(checker: &mut Checker, path: &KeyPath, region: &Region) {
    let path = path.then("region");
    match (region.min, region.max, region.center, region.radius) {
        (Some(min), Some(max), None, None) => {
            checker.corners(&path, min, max);
        }
        (None, None, Some(_), Some(radius)) => {
            checker.range(path.then("radius"), radius, Allowed::Positive, "a length in metres");
        }
        _ => {
            let message = "is neither a rectangle (min and max) nor a disc (center and radius)";
            checker.problem(path, message, "such as { min = [0.0, 0.0], max = [1.0, 1.0] }");
        }
    }
}

/// Notes a start before the run, and a stop that does not come after the start.
pub(super) fn check_schedule(checker: &mut Checker, path: &KeyPath, start: f64, stop: Option<f64>) {
    checker.range(path.then("start"), start, Allowed::NotNegative, "in seconds; a run starts at 0");
    if let Some(stop) = stop.filter(|stop| *stop <= start) {
        let message = format!("must come after the start at {} s, found {} s", number(start), number(stop));
        checker.problem(path.then("stop"), message, "leave it out for one that never stops");
    }
}
