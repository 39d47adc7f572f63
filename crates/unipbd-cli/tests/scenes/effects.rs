//! Effects by themselves: surface tension, drag, injectors, sinks, heaters.

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
            viscosity = 0.1
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

#[test]
fn a_lone_particle_with_quadratic_drag_falls_at_its_terminal_speed() {
    let mut rain = solver(
        r#"
        spacing = 0.05
        [solver]
        substeps = 4
        [[liquid]]
        name = "rain"
        quadratic_drag = 0.4
        [[block]]
        material = "rain"
        min = [0.0, 0.0]
        max = [0.05, 0.05]
        "#,
    );
    run_until(&mut rain, 3.0);
    let speed = rain.diagnostics().speed_max;
    let terminal = (9.81_f64 / 0.4).sqrt();
    assert!((speed / terminal - 1.0).abs() < 1e-2, "{speed} m/s instead of {terminal} m/s");
}

#[test]
fn injectors_and_sinks_move_as_many_particles_as_their_rates_say() {
    let mut pool = solver(
        r#"
        spacing = 0.1
        [[liquid]]
        name = "water"
        [[smoke]]
        name = "dye"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [2.0, 1.0]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        [[injector]]
        material = "dye"
        region = { center = [1.0, 0.5], radius = 0.3 }
        rate = 90.0
        stop = 1.0
        [[injector]]
        material = "water"
        region = { min = [0.0, 0.0], max = [2.0, 0.5] }
        rate = 1000.0
        capacity = 200
        stop = 1.0
        [[sink]]
        region = { min = [0.0, 0.0], max = [0.5, 0.5] }
        materials = ["water"]
        rate = 20.0
        start = 1.0
        "#,
    );
    let count = |pool: &Solver, name: &str| pool.phases().iter().filter(|phase| phase.name() == name).count();
    run_until(&mut pool, 1.0);
    assert_eq!(count(&pool, "smoke"), 90);
    assert_eq!(count(&pool, "liquid"), 200, "the pool is full and at its capacity");
    run_until(&mut pool, 2.0);
    assert_eq!(count(&pool, "smoke"), 90);
    assert!((179..=181).contains(&count(&pool, "liquid")), "{}", count(&pool, "liquid"));
}

#[test]
fn an_injector_refills_what_a_sink_takes_up_to_its_capacity() {
    let mut pool = solver(
        r#"
        spacing = 0.1
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [2.0, 1.0]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        [[injector]]
        material = "water"
        region = { min = [0.0, 1.2], max = [2.0, 1.8] }
        rate = 1000.0
        capacity = 200
        [[sink]]
        region = { min = [0.0, 0.0], max = [0.5, 0.5] }
        rate = 20.0
        "#,
    );
    let first = pool.particles().ids_given();
    for _ in 0..120 {
        pool.step_frame().unwrap();
        assert!((198..=200).contains(&pool.positions().len()), "{}", pool.positions().len());
    }
    let added = pool.particles().ids_given() - first;
    assert!((38..=40).contains(&added), "{added} particles were let in for 40 taken out");
}

#[test]
fn heaters_bring_gas_to_their_temperature() {
    let mut room = solver(
        r#"
        spacing = 0.1
        gravity = [0.0, 0.0]
        [[gas]]
        name = "air"
        [[block]]
        material = "air"
        min = [0.0, 0.0]
        max = [1.0, 1.0]
        [[tank]]
        min = [0.0, 0.0]
        max = [1.0, 1.0]
        [[heater]]
        region = { min = [0.0, 0.0], max = [0.5, 1.0] }
        temperature = 2.0
        rate = 10.0
        "#,
    );
    run_until(&mut room, 2.0);
    for (x, temperature) in room.positions().iter().zip(room.temperatures()) {
        let expected = if x.x < 0.5 { 2.0 } else { 0.0 };
        assert!((temperature - expected).abs() < 1e-3, "{temperature} at {x}");
    }
}

/// A box of gas whose temperature grows from left to right, with this baroclinic strength.
fn warm_to_the_right(baroclinic: f64, slope: f64) -> Solver {
    let columns: String = (0..40)
        .map(|column| {
            let x = 0.05 * f64::from(column);
            format!(
                "[[block]]\nmaterial = \"air\"\nmin = [{x:.3}, 0.0]\nmax = [{:.3}, 2.0]\ntemperature = {:.6}\n",
                x + 0.05,
                slope * (x + 0.025)
            )
        })
        .collect();
    solver(&format!(
        r#"
        spacing = 0.05
        [solver]
        substeps = 8
        [[gas]]
        name = "air"
        gravity_factor = -0.3
        baroclinic = {baroclinic}
        {columns}
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.0]
        open = []
        "#
    ))
}

/// Mean vorticity well inside the box: circulation of a least-squares linear velocity field.
fn vorticity(solver: &Solver) -> f64 {
    let inside = |x: &unipbd_core::Vector| (x.x - 1.0).abs() < 0.5 && (x.y - 1.0).abs() < 0.5;
    let rows: Vec<usize> = (0..solver.positions().len()).filter(|&row| inside(&solver.positions()[row])).collect();
    let count = rows.len() as f64;
    let place = |row: &usize| solver.positions()[*row].as_dvec2();
    let speed = |row: &usize| solver.velocities()[*row].as_dvec2();
    let (center, mean) = (
        rows.iter().map(place).sum::<unipbd_core::Vector64>() / count,
        rows.iter().map(speed).sum::<unipbd_core::Vector64>() / count,
    );
    let spread = |axis: usize| rows.iter().map(|row| (place(row) - center)[axis].powi(2)).sum::<f64>();
    let slope = |of: usize, along: usize| {
        rows.iter().map(|row| (speed(row) - mean)[of] * (place(row) - center)[along]).sum::<f64>() / spread(along)
    };
    slope(1, 0) - slope(0, 1)
}

#[test]
fn the_baroclinic_source_is_beta_times_the_density_gradient_across_gravity() {
    for (beta, slope) in [(2.0, 0.5), (1.0, -0.5), (4.0, 0.25)] {
        let (mut with, mut without) = (warm_to_the_right(beta, slope), warm_to_the_right(0.0, slope));
        let frames = 6;
        for _ in 0..frames {
            with.step_frame().unwrap();
            without.step_frame().unwrap();
        }
        let time = f64::from(frames) / 60.0;
        let grown = (vorticity(&with) - vorticity(&without)) / time;
        // rho/rho0 = 1 - 0.3 T: beta (d rho/dx g_y - d rho/dy g_x).
        let expected = beta * (-0.3 * slope) * -9.81;
        println!("beta {beta}, slope {slope}: {grown:.4} 1/s^2, expected {expected:.4}");
        assert!((grown / expected - 1.0).abs() < 0.1, "{grown} instead of {expected}");
    }
}

#[test]
fn the_baroclinic_source_turns_gas_and_does_not_lift_it() {
    let momentum = |baroclinic: f64| {
        let mut cloud = solver(&format!(
            r#"
            spacing = 0.05
            [solver]
            substeps = 8
            [[gas]]
            name = "air"
            baroclinic = {baroclinic}
            [[block]]
            material = "air"
            min = [-1.0, 0.0]
            max = [0.0, 1.0]
            temperature = 1.0
            [[block]]
            material = "air"
            min = [0.0, 0.0]
            max = [1.0, 1.0]
            "#
        ));
        for _ in 0..6 {
            cloud.step_frame().unwrap();
        }
        cloud.diagnostics()
    };
    let (with, without) = (momentum(2.0), momentum(0.0));
    let lift = (with.momentum - without.momentum).length();
    let scale = 1.2 * 2.0 * 2.0 * 0.15 * 9.81 * 0.1;
    println!("lift {:.1e} of what each half is pushed by", lift / scale);
    assert!(lift < 1e-3 * scale, "{lift} kg m/s");
    println!("kinetic energy {} J with, {} J without", with.kinetic_energy, without.kinetic_energy);
    assert!(with.kinetic_energy > 1.2 * without.kinetic_energy);
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
        viscosity = 0.05
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
            viscosity = 0.05
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
