//! The shipped plume of gas and smoke in the open.

use unipbd_core::math::{Vector64, wide};
use unipbd_core::{Phase, Solver};
use unipbd_tests::{Spread, bars, build, crowded, of_phase, run, shipped};

fn positions(solver: &Solver, phase: Phase) -> Vec<Vector64> {
    of_phase(solver, phase).map(|row| wide(solver.positions()[row])).collect()
}

#[test]
fn the_shipped_plume_is_large_calm_and_without_clumps() {
    let scene = shipped("open_gas.toml").scene;
    let (dx, frames) = (scene.spacing, (scene.duration * scene.fps) as u64);
    let speed = scene.emitter[0].speed;
    let [mut gas, mut smoke, mut compression, mut fastest, mut crowd] = [Spread::default(); 5];
    let mut top = f64::NAN;
    run(&mut build(&scene, 2), frames, |solver| {
        let diagnostics = solver.diagnostics();
        gas.add(diagnostics.count(Phase::Gas) as f64);
        smoke.add(diagnostics.count(Phase::Smoke) as f64);
        compression.add(diagnostics.density_error_max);
        fastest.add(diagnostics.speed_max);
        if solver.frame() % 20 == 0 {
            crowd.add(crowded(positions(solver, Phase::Gas), 0.6 * dx));
        }
        if solver.frame() == 50 {
            top = positions(solver, Phase::Smoke).iter().map(|x| x.y).fold(f64::NEG_INFINITY, f64::max);
        }
    });
    bars("open gas plume", |bars| {
        bars.at_least("duration [s]", scene.duration, 8.0);
        bars.at_least("gas particles at the peak", gas.max(), 4000.0);
        bars.at_least("smoke particles at the peak", smoke.max(), 1000.0);
        bars.at_most("peak C", compression.max(), 0.25);
        bars.at_most("largest speed over that of the emitter", fastest.max() / speed, 4.0);
        bars.at_most("worst part of the gas with a neighbour nearer than 0.6 dx", crowd.max(), 0.003);
        bars.at_most("mean part of the gas with a neighbour nearer than 0.6 dx", crowd.mean(), 0.001);
        bars.within("top of the smoke at 0.83 s [dx]", top / dx, 0.8 * 77.0, 1.2 * 77.0);
    });
}
