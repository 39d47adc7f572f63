//! The air, the domain and the view.

use super::checker::{Allowed, Checker, number, rounded};
use super::geometry::AXES;
use crate::scene::KeyPath;

/// A periodic axis must be longer than this many kernel radii, else a particle meets its own image.
const PERIODIC_KERNEL_RADII: f64 = 3.0;

pub(super) fn check(checker: &mut Checker) {
    check_gusts(checker);
    check_periodic(checker);
    let domain = &checker.scene.domain;
    if let (Some(min), Some(max)) = (domain.remove_below, domain.remove_above) {
        checker.corners_named(&KeyPath::key("domain"), min, max, ["remove_below", "remove_above"]);
    }
    if let (Some(min), Some(max)) = (checker.scene.view.min, checker.scene.view.max) {
        checker.corners(&KeyPath::key("view"), min, max);
    }
}

fn check_gusts(checker: &mut Checker) {
    let air = &checker.scene.environment;
    let path = |key| KeyPath::key("environment").then(key);
    checker.range(path("gusts"), air.gusts, Allowed::NotNegative, "an amplitude in m/s; 0 is still air");
    checker.range(path("gust_length"), air.gust_length, Allowed::NotNegative, "in metres; 0 means 10 spacings");
    checker.range(path("gust_time"), air.gust_time, Allowed::NotNegative, "in seconds; 0 means 0.5 s");
}

fn check_periodic(checker: &mut Checker) {
    let domain = &checker.scene.domain;
    let kernel = checker.spacing.map(|spacing| spacing * checker.scene.solver.kernel_radius);
    for (axis, extent) in AXES.into_iter().zip([domain.periodic_x, domain.periodic_y]) {
        let Some([from, to]) = extent else { continue };
        let path = KeyPath::key("domain").then(axis.periodic_key());
        if from >= to {
            let message =
                format!("must run from a smaller to a larger number, found {} to {}", number(from), number(to));
            checker.problem(path, message, "such as [0.0, 10.0]");
        } else if let Some(least) = kernel.map(|radius| radius * PERIODIC_KERNEL_RADII)
            && to - from < least
        {
            let message = format!(
                "is {} m long, less than {PERIODIC_KERNEL_RADII} kernel radii ({} m)",
                rounded(to - from),
                rounded(least)
            );
            checker.problem(
                path,
                message,
                "make the axis longer or lower `spacing`: a particle would meet its own image",
            );
        }
    }
}
