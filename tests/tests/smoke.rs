//! Smoke follows its carrier.

use std::f64::consts::TAU;

use unipbd_core::math::{Vector64, wide};
use unipbd_core::scene::Scene;
use unipbd_core::{Phase, Solver};
use unipbd_tests::{Prescribed, bars, build, of_phase, run, scene, shipped};

/// Gas that fills a square of 48 dx around the origin, dx = 1 m, and a nozzle one particle wide that
/// sets some markers free in the first frame.
fn marked_gas(domain: &str, place: Vector64, velocity: Vector64) -> Scene {
    let stop = 1.5 / velocity.length();
    scene(&format!(
        r#"
        spacing = 1.0
        gravity = [0.0, 0.0]
        seed = 3
        [solver]
        substeps = 8
        {domain}
        [[gas]]
        name = "air"
        [[smoke]]
        name = "smoke"
        [[block]]
        material = "air"
        min = [-24.0, -24.0]
        max = [24.0, 24.0]
        jitter = 0.1
        [[emitter]]
        material = "air"
        position = [{}, {}]
        direction = [{}, {}]
        width = 1.0
        speed = {}
        stop = {stop}
        throttle = false
        smoke = {{ material = "smoke", per_particle = 8 }}
        "#,
        place.x,
        place.y,
        velocity.x,
        velocity.y,
        velocity.length(),
    ))
}

/// Markers by id.
fn markers(solver: &Solver) -> Vec<(u32, Vector64)> {
    let mut markers: Vec<_> =
        of_phase(solver, Phase::Smoke).map(|row| (solver.ids()[row], wide(solver.positions()[row]))).collect();
    markers.sort_by_key(|(id, _)| *id);
    markers
}

/// Runs until the markers are free, then for `turn` \[s]; returns the largest distance from the exact
/// place over the length of the path.
fn error_after(
    scene: &Scene,
    turn: f64,
    field: impl Fn(Vector64) -> Vector64 + Send + Sync + 'static,
    exact: impl Fn(Vector64, f64) -> (Vector64, f64),
    difference: impl Fn(Vector64) -> Vector64,
) -> f64 {
    let mut solver = build(scene, 1);
    solver.add_group(Box::new(Prescribed(field)));
    let stop = scene.emitter[0].stop.expect("the nozzle stops");
    run(&mut solver, (stop * 60.0).ceil() as u64 + 1, |_| ());
    let (start, before) = (solver.time(), markers(&solver));
    assert!(before.len() >= 8, "{} markers", before.len());
    run(&mut solver, (turn * 60.0).round() as u64, |_| ());
    let after = markers(&solver);
    assert_eq!(before.len(), after.len());
    let time = solver.time() - start;
    let errors = before.iter().zip(&after).map(|((id, from), (other, to))| {
        assert_eq!(id, other);
        let (place, path) = exact(*from, time);
        difference(*to - place).length() / path
    });
    errors.fold(0.0, f64::max)
}

fn wrapped(difference: Vector64) -> Vector64 {
    Vector64::new(difference.x - 48.0 * (difference.x / 48.0).round(), difference.y)
}

const PERIODIC: &str = "[domain]\nperiodic_x = [-24.0, 24.0]";

#[test]
fn smoke_in_a_uniform_stream_comes_round_with_it() {
    let velocity = Vector64::new(24.0, 0.0);
    let scene = marked_gas(PERIODIC, Vector64::new(-10.0, 0.0), velocity);
    let exact = |from: Vector64, time: f64| (from + velocity * time, velocity.length() * time);
    let error = error_after(&scene, 2.0, move |_| velocity, exact, wrapped);
    bars("smoke in a uniform stream", |bars| bars.at_most("error over path after one turn", error, 0.01));
}

#[test]
fn smoke_in_a_vortex_stays_on_its_circle() {
    let place = Vector64::new(12.0, 0.0);
    let scene = marked_gas("", place, place.perp() * TAU);
    let exact = |from: Vector64, time: f64| (Vector64::from_angle(TAU * time).rotate(from), TAU * time * from.length());
    let error = error_after(&scene, 1.0, |x| x.perp() * TAU, exact, |difference| difference);
    bars("smoke in solid rotation", |bars| bars.at_most("error over path after one turn", error, 0.01));
}

#[test]
fn smoke_in_shear_goes_with_its_layer() {
    let field = |x: Vector64| Vector64::new(TAU * x.y, 0.0);
    let place = Vector64::new(0.0, 12.0);
    let scene = marked_gas(PERIODIC, place, field(place));
    let exact = move |from: Vector64, time: f64| (from + field(from) * time, field(from).length() * time);
    let error = error_after(&scene, 1.0, field, exact, wrapped);
    bars("smoke in shear", |bars| bars.at_most("error over path after one turn", error, 0.01));
}

/// Wendland C2 up to a factor that cancels.
fn weight(distance: f64, radius: f64) -> f64 {
    let q = distance / radius;
    if q < 1.0 { (1.0 - q).powi(4) * (1.0 + 4.0 * q) } else { 0.0 }
}

#[test]
fn smoke_has_the_mean_velocity_of_the_carrier_around_it() {
    let mut scene = shipped("open_gas.toml").scene.into_scene();
    scene.solver.settle_substeps = Some(0);
    let radius = scene.solver.kernel_radius * scene.spacing;
    let mut solver = build(&scene, 2);
    run(&mut solver, 50, |_| ());
    let (positions, velocities) = (solver.positions(), solver.velocities());
    let (mut worst, mut count) = (0.0_f64, 0);
    for marker in of_phase(&solver, Phase::Smoke).step_by(7) {
        let (mut sum, mut weights) = (Vector64::ZERO, 0.0);
        for carrier in of_phase(&solver, Phase::Gas) {
            let weight = weight(wide(positions[marker]).distance(wide(positions[carrier])), radius);
            sum += wide(velocities[carrier]) * weight;
            weights += weight;
        }
        if weights > 1e-6 {
            let mean = sum / weights;
            worst = worst.max((wide(velocities[marker]) - mean).length() / mean.length());
            count += 1;
        }
    }
    assert!(count > 100, "{count} markers have a carrier near");
    bars("smoke velocity", |bars| bars.at_most("distance from sum v W / sum W, relative", worst, 1e-5));
}
