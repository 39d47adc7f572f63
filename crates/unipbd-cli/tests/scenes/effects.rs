//! Effects by themselves: drag, injectors, sinks, heaters, the baroclinic source.

use unipbd_core::Solver;

use crate::support::{run_until, solver};

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
