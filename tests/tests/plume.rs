//! The shipped plume of gas and smoke in the open.

use unipbd_core::math::{Vector64, wide};
use unipbd_core::scene::Scene;
use unipbd_core::{Phase, Solver};
use unipbd_tests::{Bars, Spread, bars, build, crowded, full_size, of_phase, run, shipped};

fn positions(solver: &Solver, phase: Phase) -> Vec<Vector64> {
    of_phase(solver, phase).map(|row| wide(solver.positions()[row])).collect()
}

/// Gas that has not crossed the line where it is removed at the start of the next frame.
fn gas_within<'a>(scene: &'a Scene, solver: &'a Solver) -> impl Iterator<Item = usize> + 'a {
    let top = scene.domain.remove_above.map_or(f64::INFINITY, |corner| corner[1]);
    of_phase(solver, Phase::Gas).filter(move |row| f64::from(solver.positions()[*row].y) < top)
}

/// Figures of a plume while it runs.
#[derive(Default)]
struct Plume {
    gas: Spread,
    smoke: Spread,
    compression: Spread,
    fastest: Spread,
    crowd: Spread,
    /// Top of the smoke at 0.83 s \[m].
    top: f64,
}

/// The plume over so many seconds, or to its end.
fn watch(scene: &Scene, seconds: f64) -> Plume {
    let (dx, frames) = (scene.spacing, (scene.duration.min(seconds) * scene.fps) as u64);
    let mut plume = Plume::default();
    run(&mut build(scene, 2), frames, |solver| {
        let diagnostics = solver.diagnostics();
        plume.gas.add(diagnostics.count(Phase::Gas) as f64);
        plume.smoke.add(diagnostics.count(Phase::Smoke) as f64);
        plume.compression.add(diagnostics.density_error_max);
        let speed = |row: usize| f64::from(solver.velocities()[row].length());
        plume.fastest.add(gas_within(scene, solver).map(speed).fold(0.0, f64::max));
        if solver.frame() % 20 == 0 {
            let gas = gas_within(scene, solver).map(|row| wide(solver.positions()[row])).collect();
            plume.crowd.add(crowded(gas, 0.6 * dx));
        }
        if solver.frame() == 50 {
            plume.top = positions(solver, Phase::Smoke).iter().map(|x| x.y).fold(f64::NEG_INFINITY, f64::max);
        }
    });
    plume
}

fn is_calm(bars: &mut Bars, plume: &Plume, speed: f64, crowd: f64) {
    bars.at_most("peak C", plume.compression.max(), 0.25);
    bars.at_most("largest speed over that of the emitter", plume.fastest.max() / speed, 4.0);
    bars.at_most("worst part of the gas with a neighbour nearer than 0.6 dx", plume.crowd.max(), crowd);
}

#[test]
fn the_shipped_plume_is_large_calm_and_without_clumps() {
    let scene = shipped("open_gas.toml").scene;
    // It grows for 2.5 s.
    let seconds = if full_size("open gas plume to its end") { f64::INFINITY } else { 3.0 };
    let plume = watch(&scene, seconds);
    bars("open gas plume", |bars| {
        bars.at_least("duration [s]", scene.duration, 8.0);
        bars.at_least("gas particles at the peak", plume.gas.max(), 4000.0);
        bars.at_least("smoke particles at the peak", plume.smoke.max(), 1000.0);
        is_calm(bars, &plume, scene.emitter[0].speed, 0.001);
    });
}

#[test]
fn a_jet_without_air_around_it_rises_as_far_as_it_should() {
    let scene = shipped("open_gas_jet.toml").scene;
    let seconds = if full_size("open gas jet to its end") { f64::INFINITY } else { 1.0 };
    let plume = watch(&scene, seconds);
    bars("open gas jet", |bars| {
        // One pair among the first thousand particles is 0.002 of them.
        is_calm(bars, &plume, scene.emitter[0].speed, 0.0025);
        bars.at_most("mean part of the gas with a neighbour nearer than 0.6 dx", plume.crowd.mean(), 0.001);
        bars.within("top of the smoke at 0.83 s [dx]", plume.top / scene.spacing, 0.8 * 77.0, 1.2 * 77.0);
    });
}
