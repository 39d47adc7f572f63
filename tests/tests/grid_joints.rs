//! Bodies on joints with the pressure grid: the pressure moves them as far as their joints let it.

use unipbd_core::math::Vector64;
use unipbd_core::scene::{PressureGridUse, Scene};
use unipbd_core::{Phase, Solver};
use unipbd_tests::{bars, build, mean_of, of_phase, run, shipped, water};

const DX: f64 = 0.025;

/// A tank of this width, filled to this depth.
fn tank(width: f64, depth: f64, rest: &str) -> Scene {
    let tank = format!("[[tank]]\nmin = [0.0, 0.0]\nmax = [{width}, 2.0]\nopen = [\"top\"]");
    water(width, depth, DX, &format!("{tank}\n{rest}"))
}

/// Means over the two seconds after the third.
struct Rest {
    heights: Vec<f64>,
    pull: Vector64,
    compression: f64,
    /// Root mean square speed of the fastest body \[dx/s].
    speed: f64,
}

fn at_rest(solver: &mut Solver) -> Rest {
    let (mut compression, mut places, mut squares, mut pull) = (Vec::new(), Vec::new(), Vec::new(), Vector64::ZERO);
    run(solver, 180, |solver| compression.push(solver.diagnostics().density_error_mean));
    run(solver, 120, |solver| {
        places.push(solver.bodies().iter().map(|body| body.position.y).collect::<Vec<_>>());
        squares.push(solver.bodies().iter().map(|body| body.velocity.length_squared()).fold(0.0, f64::max));
        pull += solver.joints()[0].force / 120.0;
    });
    let bodies = 0..solver.bodies().len();
    Rest {
        heights: bodies.map(|body| mean_of(places.iter().map(|places| places[body]))).collect(),
        pull,
        compression: mean_of(compression),
        speed: mean_of(squares).sqrt() / DX,
    }
}

/// How much too deep the first body lies \[dx] in a tank of this width, with this area of bodies below the level, where
/// its draft should be this and half of its height is `half` \[m].
fn too_deep((solver, rest): (&Solver, &Rest), width: f64, below: f64, draft: f64, half: f64) -> f64 {
    let level = (of_phase(solver, Phase::Liquid).count() as f64 * DX * DX + below) / width;
    (level - draft + half - rest.heights[0]) / DX
}

#[track_caller]
fn build_with_grid(scene: &Scene) -> Solver {
    let choice = scene.pressure_grid();
    assert!(choice.used, "{}", choice.reason);
    build(scene, 2)
}

fn body(name: &str, shape: &str, position: [f64; 2], density: f64) -> String {
    format!("[[body]]\nname = \"{name}\"\n{shape}\nposition = {position:?}\ndensity = {density:?}\n")
}

#[test]
fn a_buoy_pulls_on_its_rod_with_its_lift() {
    let buoy = body("buoy", "radius = 0.15", [1.0, 0.6], 400.0);
    let rod = "[[joint]]\nkind = \"rod\"\nbody = \"buoy\"\nat = [1.0, 0.6]\nother_at = [1.0, 0.05]";
    let mut solver = build_with_grid(&tank(2.0, 1.2, &(buoy + rod)));
    let rest = at_rest(&mut solver);
    let lift = 600.0 * std::f64::consts::PI * 0.15 * 0.15 * 9.81;
    bars("buoy under water on a rod", |bars| {
        bars.within("pull over its lift", -rest.pull.y / lift, 0.98, 1.02);
        bars.at_most("mean compression", rest.compression, 0.003);
        bars.at_most("speed of the buoy [dx/s]", rest.speed, 0.3);
    });
}

#[test]
fn a_float_lies_at_the_draft_that_its_sinker_gives_it() {
    let bodies =
        body("float", "size = [0.6, 0.3]", [1.0, 1.15], 300.0) + &body("sinker", "radius = 0.12", [1.0, 0.6], 2500.0);
    let rod =
        "[[joint]]\nkind = \"rod\"\nbody = \"float\"\nother = \"sinker\"\nat = [1.0, 1.15]\nother_at = [1.0, 0.6]";
    let mut solver = build_with_grid(&tank(2.0, 1.2, &(bodies + rod)));
    let rest = at_rest(&mut solver);
    let masses: Vec<f64> = solver.bodies().iter().map(|body| body.mass).collect();
    let below = (masses[0] + masses[1]) / 1000.0;
    let disc = masses[1] / 2500.0;
    let draft = (below - disc) / 0.6;
    bars("float on a sinker", |bars| {
        bars.within("draft off [dx]", too_deep((&solver, &rest), 2.0, below, draft, 0.15), -0.15, 0.15);
        bars.within("pull over the weight of the sinker in water", -rest.pull.y / (1500.0 * disc * 9.81), 0.98, 1.02);
        bars.at_most("mean compression", rest.compression, 0.003);
    });
}

#[test]
fn a_boat_lies_at_the_draft_of_hull_and_mast() {
    let bodies =
        body("hull", "size = [0.8, 0.3]", [1.0, 0.83], 350.0) + &body("mast", "size = [0.05, 0.5]", [1.0, 1.23], 300.0);
    let weld = "[[joint]]\nkind = \"weld\"\nbody = \"mast\"\nother = \"hull\"\nat = [1.0, 0.98]";
    let mut solver = build_with_grid(&tank(2.0, 0.8, &(bodies + weld)));
    let rest = at_rest(&mut solver);
    let below = (84.0 + 7.5) / 1000.0;
    bars("boat with a mast", |bars| {
        bars.within("draft off [dx]", too_deep((&solver, &rest), 2.0, below, below / 0.8, 0.15), -0.15, 0.15);
        bars.within("load on the mast's foot over its weight", rest.pull.y / (7.5 * 9.81), 0.98, 1.02);
    });
}

#[test]
fn a_counterweight_over_a_pulley_lifts_a_float() {
    let bodies = body("float", "size = [0.4, 0.4]", [0.5, 0.8], 800.0)
        + &body("counter", "size = [0.2, 0.2]", [1.3, 1.2], 1200.0);
    let pulley = "[[joint]]\nkind = \"pulley\"\nbody = \"float\"\nother = \"counter\"\nat = [0.5, 1.0]\n\
                  other_at = [1.3, 1.3]\nwheel = [0.5, 1.9]\nother_wheel = [1.3, 1.9]";
    let mut solver = build_with_grid(&tank(1.6, 0.8, &(bodies + pulley)));
    let rest = at_rest(&mut solver);
    let below = (128.0 - 48.0) / 1000.0;
    bars("float on a pulley", |bars| {
        bars.within("draft off [dx]", too_deep((&solver, &rest), 1.6, below, below / 0.4, 0.2), -0.15, 0.15);
        bars.within("pull over the counterweight", rest.pull.y / (48.0 * 9.81), 0.98, 1.02);
    });
}

#[test]
fn a_moored_buoy_pulls_on_its_rope_with_its_lift() {
    // With one substep per frame it shook at 2.5 dx/s.
    let buoy = body("buoy", "radius = 0.15", [1.0, 0.5], 400.0);
    let rope = "[[solid]]\nname = \"cord\"\ndensity = 200.0\n[[rope]]\nmaterial = \"cord\"\nfrom = [1.0, 0.05]\n\
                to = [1.0, 0.35]\nheld = \"from\"\nbody = \"buoy\"";
    let mut scene = tank(2.0, 0.9, &(buoy + rope));
    assert!(!scene.pressure_grid().used);
    scene.solver.pressure_grid = PressureGridUse::On;
    let mut solver = build(&scene, 2);
    let rest = at_rest(&mut solver);
    let lift = 600.0 * std::f64::consts::PI * 0.15 * 0.15 * 9.81;
    bars("buoy under water on a rope", |bars| {
        bars.within("substeps", f64::from(solver.diagnostics().substeps), 4.0, 5.0);
        bars.within("pull over its lift", -rest.pull.y / lift, 0.97, 1.03);
        bars.at_most("mean compression", rest.compression, 0.003);
        bars.at_most("speed of the buoy [dx/s]", rest.speed, 0.3);
    });
}

/// Mean spin [degrees/s] of a body between two times \[s].
fn mean_spin(solver: &mut Solver, name: &str, [from, to]: [u64; 2]) -> f64 {
    let mut spins = Vec::new();
    run(solver, from, |_| ());
    run(solver, to - from, |solver| {
        spins.push(solver.bodies().iter().find(|body| body.name == name).expect("it is there").angular_velocity);
    });
    mean_of(spins).to_degrees()
}

#[test]
fn a_driven_wheel_turns_in_the_spray_it_throws() {
    // Where fluid clung to what leaves it, it turned at 62 degrees/s.
    let mut scene = shipped("water_wheel.toml").scene.into_scene();
    assert!(scene.pressure_grid().reason.contains("not convex"), "{}", scene.pressure_grid().reason);
    scene.solver.pressure_grid = PressureGridUse::On;
    let with_grid = mean_spin(&mut build(&scene, 2), "driven", [90, 180]);
    bars("wheel with paddles, driven at 200 degrees/s", |bars| {
        bars.within("spin with the grid [degrees/s]", with_grid, -205.0, -160.0);
    });
}

#[test]
fn a_driven_oar_turns_as_fast_as_its_motor() {
    let oar = body("oar", "size = [1.0, 0.15]", [1.0, 0.8], 600.0);
    let motor = "[[joint]]\nkind = \"hinge\"\nbody = \"oar\"\nat = [1.0, 0.8]\nmotor_speed_deg = -150.0\n\
                 motor_torque = 1000.0";
    let mut solver = build_with_grid(&tank(2.0, 0.8, &(oar + motor)));
    let spin = mean_spin(&mut solver, "oar", [60, 180]);
    bars("oar of 6 dx, half under water", |bars| {
        bars.within("spin over that of the motor", spin / -150.0, 0.95, 1.01);
    });
}

#[test]
fn joints_that_the_grid_moves_badly_are_named() {
    let hinge = "[[joint]]\nkind = \"hinge\"\nbody = \"flap\"\nat = [1.0, 1.0]\n";
    let flap =
        |width: f64| tank(2.0, 0.8, &(body("flap", &format!("size = [{width}, 0.9]"), [1.0, 0.5], 900.0) + hinge));
    assert!(flap(4.0 * DX).pressure_grid().used);
    let thin = flap(2.0 * DX).pressure_grid();
    assert!(!thin.used && thin.reason.contains("flap"), "{}", thin.reason);
    let chain = |count: usize| {
        let link = |k: usize| {
            let x = 0.1 + 0.05 * k as f64;
            let joint = format!(
                "[[joint]]\nkind = \"rod\"\nbody = \"b{k}\"\nother = \"b{}\"\nat = [{x:?}, 0.9]\nother_at = [{:?}, 0.9]\n",
                k + 1,
                x + 0.05
            );
            body(&format!("b{k}"), "radius = 0.02", [x, 0.9], 500.0) + if k + 1 < count { &joint } else { "" }
        };
        tank(2.0, 0.8, &(0..count).map(link).collect::<String>()).pressure_grid()
    };
    assert!(chain(32).used, "{}", chain(32).reason);
    assert!(!chain(33).used && chain(33).reason.contains("33"), "{}", chain(33).reason);
}

#[test]
fn bodies_on_joints_give_the_same_bits_on_any_number_of_threads_and_after_a_pause() {
    let bodies = body("float", "size = [0.6, 0.3]", [0.7, 1.15], 300.0)
        + &body("sinker", "radius = 0.12", [0.7, 0.6], 2500.0)
        + &body("plate", "size = [0.1, 0.6]", [1.5, 0.9], 1500.0);
    let joints = "[[joint]]\nkind = \"rod\"\nbody = \"float\"\nother = \"sinker\"\nat = [0.7, 1.15]\nother_at = [0.7, 0.6]\n\
                  [[joint]]\nkind = \"hinge\"\nbody = \"plate\"\nat = [1.5, 1.2]\nmotor_speed_deg = 90.0\n\
                  motor_torque = 100.0";
    let scene = tank(2.0, 1.0, &(bodies + joints));
    let (mut one, mut two) = (build_with_grid(&scene), build(&scene, 1));
    run(&mut one, 20, |_| ());
    run(&mut two, 11, |_| ());
    let mut three = build(&scene, 3);
    three.restore(&two.save()).expect("it is a state of this scene");
    run(&mut three, 9, |_| ());
    assert_eq!(one.state_hash(), three.state_hash());
}
