//! Bodies and liquid: floating, momentum, no leaks.

use crate::support::{run_until, solver};

const SPACING: f64 = 0.05;
/// A box of 16 spacings.
const SIDE: f64 = 0.8;
const WIDTH: f64 = 4.0;

/// Draft of a box that may not turn, from where its bottom came to rest and the water around it [m].
fn draft(ratio: f64) -> f64 {
    let mut solver = solver(&format!(
        r#"
        spacing = {SPACING}
        [solver]
        substeps = 8
        [[liquid]]
        name = "water"
        xsph = 0.05
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [{WIDTH}, 1.6]
        [[tank]]
        min = [0.0, 0.0]
        max = [{WIDTH}, 4.0]
        open = ["top"]
        [[body]]
        name = "box"
        size = [{SIDE}, {SIDE}]
        position = [2.0, 1.7]
        density = {}
        rotation = "locked"
        "#,
        1000.0 * ratio
    ));
    run_until(&mut solver, 10.0);
    let mut bottom = 0.0;
    for frame in 0..60 {
        solver.step_frame().unwrap();
        bottom += (solver.bodies()[0].position.y - 0.5 * SIDE - bottom) / f64::from(frame + 1);
    }
    let water = solver.phases().iter().filter(|phase| phase.name() == "liquid").count() as f64;
    // The water at the bottom is compressed a little: its level follows from the area it has.
    let area = water * SPACING * SPACING / (1.0 + solver.diagnostics().density_error_mean);
    (area / WIDTH - bottom) / (1.0 - SIDE / WIDTH)
}

#[test]
fn boxes_float_as_deep_as_archimedes_says() {
    for ratio in [0.25, 0.5, 0.75] {
        let error = (draft(ratio) - ratio * SIDE) / SPACING;
        println!("ratio {ratio}: draft error {error:.3} spacings");
        assert!(error.abs() <= 0.3, "ratio {ratio}: draft error {error} spacings");
    }
}

#[test]
fn fluid_and_body_keep_their_momentum_together() {
    let mut solver = solver(
        r#"
        spacing = 0.05
        gravity = [0.0, 0.0]
        [solver]
        substeps = 8
        [[liquid]]
        name = "water"
        [[disc]]
        material = "water"
        center = [0.0, 0.0]
        radius = 0.8
        [[body]]
        size = [0.4, 0.4]
        position = [-1.3, 0.1]
        velocity = [3.0, 0.0]
        spin_deg = 90.0
        "#,
    );
    let momentum = |solver: &unipbd_core::Solver| solver.diagnostics().momentum;
    let start = momentum(&solver);
    run_until(&mut solver, 1.0);
    let error = (momentum(&solver) - start).length() / start.length();
    println!("momentum error {error:.2e}; body slowed to {:.2} m/s", solver.bodies()[0].velocity.x);
    assert!(solver.bodies()[0].velocity.x < 2.0, "the body never met the water");
    assert!(error < 1e-5, "momentum changed by {error:e}");
}

/// Water and a box thrown at a corner of a closed tank ten times as fast as they could fall.
fn check_containment(substeps: &str) {
    let height: f64 = 2.0;
    let speed = 10.0 * (2.0 * 9.81 * height).sqrt();
    let along = speed * 0.5_f64.sqrt();
    let mut solver = solver(&format!(
        r#"
        spacing = 0.05
        [solver]
        substeps = {substeps}
        [[liquid]]
        name = "water"
        [[disc]]
        material = "water"
        center = [1.0, 1.0]
        radius = 0.4
        velocity = [{along}, {along}]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, {height}]
        [[body]]
        size = [0.3, 0.3]
        position = [0.5, 0.4]
        velocity = [-{along}, -{along}]
        "#
    ));
    for _ in 0..60 {
        solver.step_frame().unwrap();
        for x in solver.positions() {
            assert!(x.min_element() > -1e-3 && x.max_element() < 2.001, "water or a sample at {x}");
        }
    }
}

#[test]
fn nothing_tunnels_through_walls_at_ten_times_the_speed_of_fall() {
    check_containment("\"auto\"");
    check_containment("8");
}

#[test]
fn a_block_poured_over_a_body_leaves_room_for_it() {
    let solver = solver(
        r#"
        spacing = 0.1
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        [[body]]
        size = [0.8, 0.8]
        position = [1.0, 1.0]
        "#,
    );
    let water = solver.phases().iter().filter(|phase| phase.name() == "liquid").count();
    assert_eq!(water, 400 - 64);
    let worst = solver.diagnostics().density_error_max;
    assert!(worst < 0.05, "{worst}");
}
