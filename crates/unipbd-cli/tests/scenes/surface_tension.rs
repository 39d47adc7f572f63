//! Forces at surfaces: cohesion of drops, adhesion to walls and bodies.

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
fn cohesion_rounds_a_drop_and_keeps_its_momentum() {
    let scene = |cohesion: f64| {
        format!(
            r#"
            spacing = 0.05
            gravity = [0.0, 0.0]
            [solver]
            substeps = 8
            [[liquid]]
            name = "water"
            xsph = 0.1
            cohesion = {cohesion}
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [1.2, 0.6]
            velocity = [0.5, 0.0]
            "#
        )
    };
    let mut drop = solver(&scene(8.0));
    let mut free = solver(&scene(0.0));
    let before = drop.diagnostics().momentum;
    // Long enough for its swings to die down.
    run_until(&mut drop, 6.0);
    run_until(&mut free, 6.0);
    let after = drop.diagnostics().momentum;
    println!("elongation {:.3} with cohesion, {:.3} without", elongation(&drop), elongation(&free));
    assert!(elongation(&free) > 1.8, "without cohesion the block keeps its shape: {}", elongation(&free));
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
        cohesion = 8.0
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

/// Height of the middle of a film of liquid under a ceiling after a second.
fn film_under(ceiling: &str, adhesion: f64) -> Solver {
    let mut film = solver(&format!(
        r#"
        spacing = 0.05
        [solver]
        substeps = 8
        [[liquid]]
        name = "glue"
        xsph = 0.05
        adhesion = {adhesion}
        [[block]]
        material = "glue"
        min = [0.5, 0.95]
        max = [1.5, 1.0]
        {ceiling}
        "#
    ));
    run_until(&mut film, 1.0);
    film
}

#[test]
fn a_film_hangs_under_a_ceiling_and_under_a_body_by_adhesion_alone() {
    let wall = "[[half_plane]]\nname = \"ceiling\"\npoint = [0.0, 1.0]\nnormal = [0.0, -1.0]";
    let body = "[[body]]\nkind = \"static\"\nsize = [2.0, 0.4]\nposition = [1.0, 1.2]";
    for ceiling in [wall, body] {
        let low = |film: &Solver| {
            let wet = (0..film.positions().len()).filter(|&row| film.phases()[row].name() == "liquid");
            wet.map(|row| film.positions()[row].y).fold(f32::INFINITY, f32::min)
        };
        let (held, dropped) = (film_under(ceiling, 60.0), film_under(ceiling, 0.0));
        println!("lowest at {:.3} m with adhesion, at {:.2} m without", low(&held), low(&dropped));
        assert!(low(&held) > 0.85, "the film hangs, but its lowest particle is at {} m", low(&held));
        assert!(low(&dropped) < -2.0, "without adhesion it falls");
        let weight = 1000.0 * 9.81 * 0.05;
        let force = held.wall_forces().first().map_or(held.bodies().first().map(|b| b.fluid_force), |w| Some(w.force));
        let carried = -force.unwrap().y / weight;
        println!("the ceiling carries {carried:.3} of its weight");
        assert!((carried - 1.0).abs() < 0.05, "{carried}");
    }
}

#[test]
fn a_drop_spreads_on_a_wall_by_adhesion_and_keeps_its_momentum_with_a_body() {
    let drop = |adhesion: f64| {
        let mut drop = solver(&format!(
            r#"
            spacing = 0.05
            gravity = [0.0, 0.0]
            [solver]
            substeps = 8
            [[liquid]]
            name = "water"
            xsph = 0.05
            cohesion = 4.0
            adhesion = {adhesion}
            [[disc]]
            material = "water"
            center = [0.0, 0.45]
            radius = 0.45
            [[half_plane]]
            point = [0.0, 0.0]
            normal = [0.0, 1.0]
            "#
        ));
        run_until(&mut drop, 3.0);
        elongation(&drop)
    };
    let (wetting, plain) = (drop(100.0), drop(0.0));
    println!("width over height {wetting:.2} with adhesion, {plain:.2} without");
    assert!(plain < 1.25, "without adhesion the drop stays round: {plain}");
    assert!(wetting > 1.3 * plain, "with adhesion it spreads: {wetting}");
    let mut free = solver(
        r#"
        spacing = 0.05
        gravity = [0.0, 0.0]
        [solver]
        substeps = 8
        [[liquid]]
        name = "water"
        adhesion = 40.0
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
    assert!(free.bodies()[0].velocity.x > 0.1, "the body was pulled along");
    let error = (free.diagnostics().momentum - start).length() / start.length();
    assert!(error < 1e-5, "momentum changed by {error:e}");
}
