//! Viscosity of any strength, and the shear that walls and bodies feel: dx = 0.1 m.

use std::f64::consts::PI;
use unipbd_core::Solver;
use unipbd_core::math::wide;
use unipbd_core::scene::{Scene, Substeps};
use unipbd_tests::{bars, build, mean_of, run, scene};

fn mean_speed(solver: &Solver) -> f64 {
    mean_of(solver.velocities().iter().map(|velocity| f64::from(velocity.x)))
}

/// A film ten spacings deep on a floor without slip, on a slope of 20 degrees.
fn film(nu: f64) -> Scene {
    let (pull, weight) = (9.81 * 20f64.to_radians().sin(), 9.81 * 20f64.to_radians().cos());
    scene(&format!(
        "spacing = 0.1\ngravity = [{pull}, {}]\n[domain]\nperiodic_x = [0.0, 2.0]\n\
         [[liquid]]\nname = \"oil\"\nkinematic_viscosity = {nu}\n\
         [[half_plane]]\nname = \"floor\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nslip = \"none\"\n\
         [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [2.0, 1.0]",
        -weight
    ))
}

#[test]
fn a_film_flows_as_nusselt_says_at_any_viscosity_and_loads_its_floor() {
    let pull = 9.81 * 20f64.to_radians().sin();
    bars("film, 10 dx", |bars| {
        for nu in [1.0, 20.0, 500.0] {
            for substeps in [Substeps::Auto, Substeps::Fixed(2), Substeps::Fixed(12)] {
                let mut scene = film(nu);
                scene.solver.substeps = substeps;
                let mut solver = build(&scene, 2);
                let (mut speeds, mut shear) = (Vec::new(), Vec::new());
                run(&mut solver, if nu == 1.0 { 150 } else { 40 }, |_| ());
                run(&mut solver, 20, |solver| {
                    speeds.push(mean_speed(solver));
                    shear.push(solver.wall_forces()[0].force.x);
                });
                // Nusselt 1916: g sin(theta) h^2/(3 nu) on average, and the floor carries the whole weight along it.
                let what = format!("nu = {nu}, {substeps:?}");
                bars.within(&format!("{what}: speed over Nusselt"), mean_of(speeds) * 3.0 * nu / pull, 0.97, 1.03);
                bars.within(&format!("{what}: shear over weight"), mean_of(shear) / (2000.0 * pull), 0.97, 1.03);
                assert_eq!(solver.take_events(), [], "there is nothing to warn of");
            }
        }
    });
}

#[test]
fn both_walls_of_a_couette_flow_feel_its_shear() {
    let scene = scene(
        "spacing = 0.1\ngravity = [0.0, 0.0]\n[domain]\nperiodic_x = [0.0, 2.0]\n\
         [[liquid]]\nname = \"oil\"\nkinematic_viscosity = 5.0\nsurface = \"none\"\n\
         [[half_plane]]\nname = \"floor\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nslip = \"none\"\n\
         [[half_plane]]\nname = \"lid\"\npoint = [0.0, 1.0]\nnormal = [0.0, -1.0]\nslip = \"none\"\nvelocity = [1.0, 0.0]\n\
         [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [2.0, 1.0]",
    );
    let mut solver = build(&scene, 2);
    run(&mut solver, 60, |_| ());
    let forces = solver.wall_forces();
    let shear = 1000.0 * 5.0 * 1.0 * 2.0;
    bars("Couette, 10 dx", |bars| {
        bars.within("shear on the floor over mu U/H", forces[0].force.x / shear, 0.97, 1.03);
        bars.within("shear on the lid over -mu U/H", forces[1].force.x / -shear, 0.97, 1.03);
        bars.within("mean speed over U/2", mean_speed(&solver) / 0.5, 0.97, 1.03);
    });
}

/// Drag over Faxén's of a disc that is dragged along a closed channel.
fn dragged(solver: &str, slip: &str) -> f64 {
    let (d, nu, speed) = (1.2, 1.2, 0.1);
    let (width, length) = (4.0 * d, 8.0 * d);
    let scene = scene(&format!(
        "spacing = 0.1\ngravity = [0.0, 0.0]\n[solver]\n{solver}\n\
         [[liquid]]\nname = \"oil\"\nkinematic_viscosity = {nu}\nsurface = \"none\"\n\
         [[tank]]\nmin = [0.0, 0.0]\nmax = [{length}, {width}]\nopen = []\nslip = \"none\"\n\
         [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [{length}, {width}]\n\
         [[body]]\nkind = \"kinematic\"\nradius = {}\nposition = [{}, {}]\nslip = \"{slip}\"\nmotion = {{ velocity = [{speed}, 0.0] }}",
        0.5 * d,
        0.4 * length,
        0.5 * width
    ));
    let (mut solver, mut drags) = (build(&scene, 2), Vec::new());
    run(&mut solver, 10, |_| ());
    run(&mut solver, 10, |solver| drags.push(-solver.bodies()[0].fluid_force.x));
    // Faxén 1946, for a width of four diameters.
    let k: f64 = 0.25;
    let wall = (1.0 / k).ln() - 0.9157 + 1.7244 * k.powi(2) - 1.7302 * k.powi(4) + 2.4056 * k.powi(6);
    mean_of(drags) * wall / (4.0 * PI * 1000.0 * nu * speed)
}

#[test]
fn a_disc_dragged_through_a_channel_feels_the_drag_of_faxen() {
    bars("disc, D = 12 dx", |bars| {
        let alone = "substeps = 32\npressure_grid = \"off\"";
        bars.within("particles alone: drag over Faxén", dragged(alone, "none"), 0.95, 1.05);
        bars.within("on the grid: drag over Faxén", dragged("pressure_grid = \"on\"", "none"), 0.95, 1.05);
        bars.at_most("drag with slip over Faxén", dragged(alone, "free"), 0.8);
    });
}

/// Mean speed of a disc that sinks along a channel of four diameters, over its terminal speed. `drag` is that over mu U.
fn sinking(grid: &str, nu: f64, (reynolds, drag): (f64, f64), (diameters, frames): (f64, u64)) -> f64 {
    let d = 0.8;
    let (width, height, speed) = (4.0 * d, diameters * d, reynolds * nu / d);
    let heavier = drag * 1000.0 * nu * speed / (9.81 * PI * d * d / 4.0);
    let scene = scene(&format!(
        "spacing = 0.1\n[solver]\npressure_grid = \"{grid}\"\n[[liquid]]\nname = \"oil\"\nkinematic_viscosity = {nu}\n\
         [[tank]]\nmin = [0.0, 0.0]\nmax = [{width}, {}]\nslip = \"none\"\n\
         [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [{width}, {height}]\n\
         [[body]]\nradius = {}\nposition = [{}, {}]\ndensity = {}\nslip = \"none\"",
        height + 1.0,
        0.5 * d,
        0.5 * width,
        0.75 * height,
        1000.0 + heavier
    ));
    let (mut solver, mut speeds) = (build(&scene, 2), Vec::new());
    run(&mut solver, frames, |_| ());
    run(&mut solver, 45, |solver| speeds.push(-solver.bodies()[0].velocity.y));
    mean_of(speeds) / speed
}

#[test]
fn a_disc_sinks_in_a_channel_at_its_terminal_speed() {
    // Drag over mu U at Reynolds numbers of 1 to 20: Boltzmann's equation on a lattice of 24 cells per diameter, which has
    // Faxén's 21.96 within 0.2 % where nothing is inert.
    bars("sinking disc, D = 8 dx", |bars| {
        // Particles alone resist being rearranged, the more the higher the pressure.
        let alone = sinking("off", 1.2, (1.0, 22.15), (10.0, 60));
        bars.within("Re = 1, particles alone: speed over its terminal speed", alone, 0.82, 1.05);
        for (nu, drag, way) in [
            (1.2, (1.0, 22.15), (10.0, 60)),
            (0.3, (1.0, 22.15), (10.0, 120)),
            (0.24, (5.0, 24.6), (10.0, 99)),
            (0.12, (10.0, 29.1), (12.0, 120)),
            (0.06, (20.0, 38.2), (20.0, 180)),
        ] {
            let what = format!("Re = {}, nu = {nu}: speed over its terminal speed", drag.0);
            bars.within(&what, sinking("on", nu, drag, way), 0.95, 1.05);
        }
    });
}

#[test]
fn a_disc_and_the_fluid_that_drags_it_keep_their_momentum() {
    for (grid, density, most) in [("off", 1000.0, 1e-5), ("off", 20.0, 1e-5), ("on", 1000.0, 1e-4), ("on", 20.0, 1e-4)]
    {
        let scene = scene(&format!(
            "spacing = 0.1\ngravity = [0.0, 0.0]\n[solver]\npressure_grid = \"{grid}\"\n\
             [[liquid]]\nname = \"oil\"\nkinematic_viscosity = 2.0\n\
             [[block]]\nmaterial = \"oil\"\nmin = [-2.0, -1.0]\nmax = [2.0, 1.0]\nvelocity = [0.5, 0.0]\n\
             [[body]]\nradius = 0.5\nposition = [0.0, 0.0]\nslip = \"none\"\ndensity = {density}",
        ));
        let mut solver = build(&scene, 2);
        let start = solver.diagnostics().momentum;
        run(&mut solver, 30, |_| ());
        let end = solver.diagnostics().momentum;
        let turned = wide(solver.velocities()[0]).length();
        bars("disc in a stream", |bars| {
            let change = (end - start).length() / start.length();
            bars.at_most(&format!("density {density}, grid {grid}: change of momentum over momentum"), change, most);
            bars.within("speed of the disc over that of the fluid", solver.bodies()[0].velocity.x / turned, 0.9, 1.1);
        });
    }
}

#[test]
fn light_discs_rise_in_a_viscous_fluid_at_their_terminal_speed() {
    let (d, nu) = (0.8, 0.4);
    for (grid, ratio, least) in [("on", 0.1, 0.9), ("on", 0.01, 0.9), ("off", 0.1, 0.4)] {
        let scene = scene(&format!(
            "spacing = 0.1\n[solver]\npressure_grid = \"{grid}\"\n[[liquid]]\nname = \"oil\"\nkinematic_viscosity = {nu}\n\
             [[tank]]\nmin = [0.0, 0.0]\nmax = [3.2, 9.0]\nslip = \"none\"\n\
             [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [3.2, 8.0]\n\
             [[body]]\nradius = {}\nposition = [1.6, 2.0]\ndensity = {}\nslip = \"none\"",
            0.5 * d,
            1000.0 * ratio
        ));
        let mut solver = build(&scene, 2);
        let (mut speeds, mut fastest) = (Vec::new(), 0.0_f64);
        run(&mut solver, 120, |_| ());
        run(&mut solver, 240, |solver| {
            speeds.push(solver.bodies()[0].velocity.y);
            fastest = fastest.max(solver.bodies()[0].velocity.length());
        });
        // Faxén's drag, at a Reynolds number of 1.
        let speed = 9.81 * PI * d * d / 4.0 * (1.0 - ratio) / (22.1 * nu);
        bars("rising disc", |bars| {
            bars.within(
                &format!("grid {grid}, density ratio {ratio}: speed over its terminal speed"),
                mean_of(speeds) / speed,
                least,
                1.1,
            );
            bars.at_most(
                &format!("grid {grid}, density ratio {ratio}: largest speed over the terminal one"),
                fastest / speed,
                1.5,
            );
        });
    }
}

#[test]
fn what_holds_a_body_holds_it_against_shear() {
    let scene = |kind: &str, rest: &str| {
        scene(&format!(
            "spacing = 0.1\ngravity = [0.0, 0.0]\n[solver]\nsubsteps = 8\npressure_grid = \"off\"\n\
             [domain]\nperiodic_x = [0.0, 4.0]\n\
             [[liquid]]\nname = \"oil\"\nkinematic_viscosity = 5.0\nsurface = \"none\"\n\
             [[half_plane]]\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nslip = \"none\"\nvelocity = [1.0, 0.0]\n\
             [[half_plane]]\npoint = [0.0, 3.0]\nnormal = [0.0, -1.0]\nslip = \"none\"\nvelocity = [1.0, 0.0]\n\
             [[block]]\nmaterial = \"oil\"\nmin = [0.0, 0.0]\nmax = [4.0, 3.0]\n\
             [[body]]\nname = \"disc\"\nkind = \"{kind}\"\nradius = 0.5\nposition = [2.0, 1.5]\ndensity = 20.0\n\
             slip = \"none\"\n{rest}"
        ))
    };
    let drag = |scene: &Scene| {
        let (mut solver, mut drags) = (build(scene, 2), Vec::new());
        run(&mut solver, 30, |_| ());
        run(&mut solver, 30, |solver| drags.push(solver.bodies()[0].fluid_force.x));
        mean_of(drags)
    };
    let (fixed, welded) =
        (scene("kinematic", ""), scene("dynamic", "[[joint]]\nkind = \"weld\"\nbody = \"disc\"\nat = [2.0, 1.5]"));
    let ratio = drag(&welded) / drag(&fixed);
    bars("light disc on a weld", |bars| bars.within("drag over that of a disc that is moved", ratio, 0.99, 1.01));
}
