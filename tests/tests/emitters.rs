//! Emitters start, stop, and give way.

use unipbd_core::Phase;
use unipbd_tests::{Spread, bars, build, run, scene};

/// A jet of gas and smoke that stops after half a second.
const SHORT_JET: &str = r#"
spacing = 0.02
[[gas]]
name = "air"
drag = 30.0
lifetime = 0.6
[[smoke]]
name = "smoke"
[[emitter]]
material = "air"
position = [0.0, 0.0]
width = 0.1
speed = 1.0
temperature = 1.0
stop = 0.5
sheath = { thickness = 0.1 }
smoke = { material = "smoke", per_particle = 3 }
"#;

#[test]
fn all_gas_is_gone_a_second_after_the_last_has_had_its_time() {
    let mut solver = build(&scene(SHORT_JET), 1);
    let mut peak = Spread::default();
    run(&mut solver, 30, |solver| peak.add(solver.diagnostics().count(Phase::Gas) as f64));
    assert!(peak.max() > 300.0, "{} particles of gas", peak.max());
    run(&mut solver, 60 * 16 / 10, |_| ());
    let diagnostics = solver.diagnostics();
    assert_eq!(diagnostics.count(Phase::Gas), 0, "at {} s", solver.time());
    assert!(diagnostics.count(Phase::Smoke) > 0, "smoke without a lifetime stays");
}

#[test]
fn a_wide_jet_leaves_at_its_full_flow_from_the_start() {
    for grid in ["off", "on"] {
        let scene = scene(&format!(
            r#"
            spacing = 0.01
            gravity = [0.0, 0.0]
            [solver]
            pressure_grid = "{grid}"
            [[liquid]]
            name = "water"
            [[emitter]]
            material = "water"
            position = [0.0, 0.0]
            width = 0.4
            speed = 3.0
            "#
        ));
        let mut solver = build(&scene, 2);
        run(&mut solver, 12, |_| ());
        let ahead = solver.positions().iter().filter(|x| x.y > 0.0).count() as f64;
        bars("jet 40 dx wide", |bars| {
            bars.within(&format!("water ahead over what it should be, grid {grid}"), ahead / 2400.0, 0.96, 1.02);
        });
    }
}

/// A nozzle between two walls at the bottom of a closed box that is full of gas already.
const BLOCKED: &str = r#"
spacing = 0.02
[[gas]]
name = "air"
[[block]]
material = "air"
min = [-0.4, 0.08]
max = [0.4, 0.8]
jitter = 0.1
[[obstacle]]
min = [-0.4, 0.0]
max = [-0.16, 0.08]
[[obstacle]]
min = [0.16, 0.0]
max = [0.4, 0.08]
[[tank]]
min = [-0.4, 0.0]
max = [0.4, 0.8]
[[emitter]]
material = "air"
position = [0.0, 0.08]
width = 0.32
speed = 2.0
"#;

#[test]
fn a_blocked_emitter_settles() {
    let mut solver = build(&scene(BLOCKED), 2);
    let mut compression = Spread::default();
    run(&mut solver, 120, |solver| compression.add(solver.diagnostics().density_error_max));
    let mut late = Spread::default();
    let before = solver.diagnostics().count(Phase::Gas);
    run(&mut solver, 60, |solver| late.add(solver.diagnostics().density_error_max));
    let after = solver.diagnostics().count(Phase::Gas);
    bars("blocked emitter", |bars| {
        bars.at_most("peak C", compression.max(), 0.1);
        bars.at_most("peak C in the third second", late.max(), 0.1);
        bars.at_most("growth in the third second", after as f64 / before as f64 - 1.0, 0.01);
    });
}
