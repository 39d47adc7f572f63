//! Loads where fluids and bodies meet: heavy bodies on water and gas, hot gas below a lid, stones on a floor. Most are
//! carried by the particles alone, without the pressure grid.

use unipbd_core::Solver;
use unipbd_core::scene::{BodyDescription, Gas, Scene};
use unipbd_tests::{bars, build, run, scene};

use crate::outlines::fluid;

/// Water below a locked block as wide as its tank, without the pressure grid.
fn piston(depth: f64, bottom: f64, mass: f64) -> Scene {
    scene(&format!(
        r#"
        spacing = 0.05
        [solver]
        pressure_grid = "off"
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [0.8, {depth}]
        [[tank]]
        min = [0.0, 0.0]
        max = [0.8, 6.0]
        [[body]]
        size = [0.8, 0.2]
        position = [0.4, {}]
        mass = {mass}
        friction = 0.0
        rotation = "locked"
        "#,
        bottom + 0.1
    ))
}

/// Largest energy gained in 2 s over that of the start, and whether there was a warning of the density.
fn gained(solver: &mut Solver) -> (f64, bool) {
    let start = solver.diagnostics().energy();
    let mut most = 0.0_f64;
    run(solver, 120, |solver| most = most.max(solver.diagnostics().energy() / start - 1.0));
    (most, solver.take_events().iter().any(|event| event.message.contains("density")))
}

#[test]
fn squeezed_water_throws_no_body_higher_than_it_fell() {
    // The target cannot be held: the stiffness stays what it is, and the run says so.
    for (mass, most) in [(320.0, 0.005), (1600.0, 0.02), (6400.0, 0.2)] {
        let (gain, warned) = gained(&mut build(&piston(0.4, 0.7, mass), 1));
        bars("block dropped 0.3 m on water in a shaft, no grid", |bars| {
            bars.at_most(&format!("energy gained, {mass} kg"), gain, most);
        });
        assert!(warned || mass < 1000.0, "{mass} kg: a compression above its band is warned of");
    }
}

#[test]
fn water_that_falls_as_a_slab_does_not_rebound_to_where_it_was() {
    let mut slab = piston(0.4, 1.0, 1.0);
    slab.body.clear();
    (slab.block[0].min, slab.block[0].max) = ([0.0, 0.5], [0.8, 0.9]);
    let (gain, _) = gained(&mut build(&slab, 1));
    bars("slab of water falls 0.5 m, no grid", |bars| bars.at_most("energy gained", gain, 0.005));
}

/// Largest speed [m/s], mean C and worst C of uniformly hot gas in a closed box within 3 s.
fn hot_gas(grid: &str) -> [f64; 3] {
    let hot = scene(&format!(
        r#"
        spacing = 0.05
        [solver]
        pressure_grid = "{grid}"
        [[gas]]
        name = "air"
        gravity_factor = 0.5
        [[block]]
        material = "air"
        min = [0.0, 0.0]
        max = [1.0, 1.0]
        temperature = 1.0
        [[tank]]
        min = [0.0, 0.0]
        max = [1.0, 1.0]
        "#
    ));
    let mut most = [0.0_f64; 3];
    run(&mut build(&hot, 1), 180, |solver| {
        let now = solver.diagnostics();
        let figures = [now.speed_max, now.density_error_mean, now.density_error_max];
        most = std::array::from_fn(|k| most[k].max(figures[k]));
    });
    most
}

#[test]
fn hot_gas_rests_below_a_lid() {
    let [speed, mean, _] = hot_gas("off");
    bars("uniformly hot gas in a closed box, no grid, 3 s", |bars| {
        bars.at_most("largest speed [dx/s]", speed / 0.05, 20.0);
        bars.at_most("largest mean C", mean, 0.02);
    });
    let [speed, _, worst] = hot_gas("auto");
    bars("uniformly hot gas in a closed box, 3 s", |bars| {
        bars.at_most("largest speed [dx/s]", speed / 0.05, 1.0);
        bars.at_most("worst C", worst, 0.01);
    });
}

#[test]
fn gas_throws_the_body_that_seals_it_no_higher_than_it_fell() {
    for (density, mass, bottom) in [(10.0, 3.0, 0.6), (1.2, 30.0, 0.6), (100.0, 3000.0, 0.6), (10.0, 30.0, 0.9)] {
        let mut sealed = piston(0.6, bottom, mass);
        sealed.liquid.clear();
        sealed.gas = vec![Gas { name: "water".into(), density, ..Gas::default() }];
        let mut solver = build(&sealed, 1);
        let (gain, _) = gained(&mut solver);
        bars("block on gas in a shaft, no grid", |bars| {
            bars.at_most(
                &format!("energy gained, {mass} kg on {density} kg/m^2, dropped {:.1} m", bottom - 0.6),
                gain,
                0.01,
            );
            bars.at_most("mean C", solver.diagnostics().density_error_mean, 0.03);
        });
    }
}

/// A steel block that falls on a raft and takes it to the floor: water is shut in between bodies that hold each other.
fn sunk_raft(raft: f64, block: f64, width: f64, aside: f64) -> Scene {
    scene(&format!(
        r#"
        spacing = 0.02
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [1.0, 0.6]
        [[tank]]
        min = [0.0, 0.0]
        max = [1.0, 1.2]
        [[body]]
        name = "block"
        size = [0.3, 0.1]
        position = [{}, 0.9]
        density = {block}
        [[body]]
        name = "raft"
        size = [{width}, 0.15]
        position = [0.5, 0.65]
        density = {raft}
        "#,
        0.5 + aside
    ))
}

#[test]
fn water_shut_in_between_bodies_gains_no_energy() {
    for (raft, block, width, aside) in
        [(150.0, 7800.0, 0.5, 0.0), (300.0, 7800.0, 0.7, 0.0), (300.0, 11000.0, 0.7, 0.03), (600.0, 11000.0, 0.8, 0.0)]
    {
        let mut solver = build(&sunk_raft(raft, block, width, aside), 1);
        let start = solver.diagnostics().energy();
        let mut most = [0.0_f64; 2];
        run(&mut solver, 200, |solver| {
            let now = solver.diagnostics();
            most = [most[0].max(now.energy() / start - 1.0), most[1].max(now.speed_max)];
        });
        bars("block on a raft in a tank", |bars| {
            let of = format!("{block} kg/m^2 on {width} m of {raft} kg/m^2");
            bars.at_most(&format!("energy gained, {of}"), most[0], 0.002);
            bars.at_most(&format!("fastest [m/s], {of}"), most[1], 15.0);
        });
    }
}

/// Discs of stone on the floor of a tank, and more between them, under water.
fn sunk_discs(grid: &str) -> Scene {
    let mut sunk = scene(&format!(
        r#"
        spacing = 0.02
        [solver]
        pressure_grid = "{grid}"
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [1.2, 0.5]
        [[tank]]
        name = "tank"
        min = [0.0, 0.0]
        max = [1.2, 1.4]
        "#
    ));
    let places =
        (0..5).map(|k| [0.2 + 0.2 * f64::from(k), 0.06]).chain((0..4).map(|k| [0.3 + 0.2 * f64::from(k), 0.3]));
    sunk.body = places.map(|place| BodyDescription { density: 2500.0, ..BodyDescription::disc(0.06, place) }).collect();
    sunk
}

#[test]
fn a_floor_carries_the_weight_of_water_and_of_what_lies_in_it() {
    for (grid, most) in [("off", 0.01), ("on", 0.03)] {
        let mut solver = build(&sunk_discs(grid), 1);
        let of_water = fluid(&solver).count() as f64 * 1000.0 * 0.02 * 0.02;
        let weight = 9.81 * (of_water + solver.bodies().iter().map(|body| body.mass).sum::<f64>());
        run(&mut solver, 180, |_| ());
        let mut floor = 0.0;
        run(&mut solver, 60, |solver| {
            let force =
                solver.wall_forces().into_iter().find(|wall| wall.name == "tank bottom").expect("it is measured");
            floor -= force.force.y / 60.0;
        });
        bars("discs of stone on the floor under water", |bars| {
            bars.at_most(
                &format!("force on the floor off the weight, grid {grid}"),
                (floor / weight - 1.0).abs(),
                most,
            );
        });
    }
}
