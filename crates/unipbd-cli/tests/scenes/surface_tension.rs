//! Forces at surfaces: drops become round, and keep their momentum beside others, walls and bodies.

use unipbd_core::Solver;

use crate::support::{run_until, solver};

/// How far a cloud of particles reaches in x against y: the ratio of its standard deviations.
fn elongation(solver: &Solver) -> f64 {
    let count = solver.positions().len() as f32;
    let mean = solver.positions().iter().sum::<unipbd_core::Vector>() / count;
    let spread = solver.positions().iter().map(|x| (*x - mean) * (*x - mean)).sum::<unipbd_core::Vector>();
    f64::from((spread.x / spread.y).sqrt())
}

#[test]
fn tension_rounds_a_drop_and_keeps_its_momentum() {
    let scene = |tension: f64| {
        format!(
            r#"
            spacing = 0.05
            gravity = [0.0, 0.0]
            [[liquid]]
            name = "water"
            kinematic_viscosity = 0.03
            surface_tension = {tension}
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [1.2, 0.6]
            velocity = [0.5, 0.0]
            "#
        )
    };
    let (mut drop, mut free) = (solver(&scene(40.0)), solver(&scene(0.0)));
    let before = drop.diagnostics().momentum;
    // Long enough for its swings to die down.
    run_until(&mut drop, 12.0);
    run_until(&mut free, 12.0);
    let after = drop.diagnostics().momentum;
    println!("elongation {:.3} with tension, {:.3} without", elongation(&drop), elongation(&free));
    assert!(elongation(&free) > 1.8, "without tension the block keeps its shape: {}", elongation(&free));
    assert!(elongation(&drop) < 1.33 && elongation(&drop) > 0.75, "the drop is not round: {}", elongation(&drop));
    assert!((after - before).length() < 1e-4 * before.length());
}

#[test]
fn drops_farther_apart_than_the_kernel_do_not_feel_each_other() {
    // Kernel radius 0.15; the gap is a little wider, and the list holds pairs across it.
    let mut solver = solver(
        r#"
        spacing = 0.05
        gravity = [0.0, 0.0]
        [solver]
        substeps = 8
        [[liquid]]
        name = "water"
        surface_tension = 8.0
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [0.3, 0.3]
        [[block]]
        material = "water"
        min = [0.42, 0.0]
        max = [0.72, 0.3]
        "#,
    );
    let left = |solver: &Solver| {
        let pairs = solver.positions().iter().zip(solver.velocities());
        pairs.filter(|(x, _)| x.x < 0.36).map(|(_, velocity)| velocity.x).sum::<f32>() / 36.0
    };
    solver.step_frame().expect("drops at rest");
    assert!(left(&solver).abs() < 1e-5, "the left drop moves at {} m/s", left(&solver));
}

#[test]
fn a_drop_keeps_its_momentum_with_a_body_that_it_wets() {
    let mut free = solver(
        r#"
        spacing = 0.05
        gravity = [0.0, 0.0]
        [[liquid]]
        name = "water"
        surface_tension = 40.0
        contact_angle = 60.0
        [[disc]]
        material = "water"
        center = [-0.5, 0.0]
        radius = 0.4
        velocity = [1.0, 0.2]
        [[body]]
        size = [0.4, 0.4]
        position = [0.3, 0.0]
        "#,
    );
    let start = free.diagnostics().momentum;
    run_until(&mut free, 1.0);
    assert!(free.bodies()[0].velocity.x > 0.1, "the body was pushed along");
    let error = (free.diagnostics().momentum - start).length() / start.length();
    assert!(error < 1e-5, "momentum changed by {error:e}");
}
