//! What a run says of itself: pressures, and warnings where it cannot do what is asked.

use unipbd_core::scene::{Block, Liquid, Obstacle, Scene, Slip, Substeps, Tank};
use unipbd_core::{BuildOptions, Real, Solver};

const SPACING: f64 = 0.1;

/// Water 20 deep in a tank 16 spacings wide.
fn pool() -> Scene {
    Scene {
        spacing: SPACING,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [1.6, 2.0])],
        tank: vec![Tank { name: "tank".to_owned(), ..Tank::new([0.0, 0.0], [1.6, 4.0]) }],
        ..Scene::default()
    }
}

fn built(scene: &Scene) -> Solver {
    scene.build(BuildOptions { threads: Some(1), ..BuildOptions::default() }).expect("the scene is good")
}

/// Pressure over that of hydrostatics, by least squares over the particles that `counts` takes, over the
/// last half second of 7 s.
fn over_hydrostatics(solver: &mut Solver, counts: impl Fn(f64) -> bool) -> f64 {
    let (mut top, mut bottom) = (0.0, 0.0);
    for frame in 0..420 {
        solver.step_frame().expect("it runs");
        if frame < 390 {
            continue;
        }
        let positions = solver.positions();
        let level = 2.0 * positions.iter().map(|x| f64::from(x.y)).sum::<f64>() / positions.len() as f64;
        for (x, p) in positions.iter().zip(solver.pressures()).filter(|(x, _)| counts(f64::from(x.x) / SPACING)) {
            let expected = 9.81 * (level - f64::from(x.y));
            top += expected * f64::from(*p);
            bottom += expected * expected;
        }
    }
    top / bottom
}

#[test]
fn pressures_are_those_of_the_depth_in_the_middle_and_beside_a_wall() {
    let middle = over_hydrostatics(&mut built(&pool()), |x| (4.0..12.0).contains(&x));
    assert!((middle - 1.0).abs() < 0.02, "{middle}");
    let beside = over_hydrostatics(&mut built(&pool()), |x| !(2.0..14.0).contains(&x));
    assert!((beside - 1.0).abs() < 0.06, "{beside}");
}

#[test]
fn pressures_beside_an_obstacle_are_those_of_the_depth() {
    let mut scene = pool();
    scene.tank[0].max[0] = 3.2;
    let (min, max) = ([1.6, 0.0], [3.2, 4.0]);
    scene.obstacle.push(Obstacle { name: String::new(), min, max, friction: None, slip: Slip::Free });
    let whole = over_hydrostatics(&mut built(&scene), |_| true);
    assert!((whole - 1.0).abs() < 0.02, "{whole}");
}

#[test]
fn nothing_pushes_before_the_first_frame() {
    let mut solver = built(&pool());
    assert!(solver.pressures().iter().all(|pressure| *pressure == 0.0));
    solver.step_frame().expect("it runs");
    assert!(solver.pressures().iter().any(|pressure| *pressure > 0.0));
    assert!(solver.diagnostics().pressure_max > 0.0);
}

#[test]
fn the_largest_pressure_is_that_of_all_pressures() {
    let mut solver = built(&pool());
    for _ in 0..60 {
        solver.step_frame().expect("it runs");
    }
    let largest = solver.pressures().iter().copied().fold(0.0, Real::max);
    let found = solver.diagnostics().pressure_max;
    assert!(found <= f64::from(largest) && found >= 0.98 * f64::from(largest), "{found} {largest}");
}

/// A stir with this viscosity, in two substeps per frame.
fn stirred(kinematic_viscosity: f64) -> Solver {
    let mut scene = pool();
    scene.liquid[0].kinematic_viscosity = kinematic_viscosity;
    scene.solver.substeps = Substeps::Fixed(2);
    built(&scene)
}

#[test]
fn viscosity_of_any_strength_is_whole_and_warns_of_nothing() {
    let mut solver = stirred(1e3);
    for _ in 0..5 {
        solver.step_frame().expect("it runs");
    }
    assert_eq!(solver.take_events(), []);
    assert_eq!(solver.diagnostics().substeps_wanted, 2);
}

#[test]
fn viscosity_that_is_stable_warns_of_nothing() {
    let mut solver = stirred(0.01);
    solver.step_frame().expect("it runs");
    assert_eq!(solver.take_events(), []);
}

#[test]
fn the_mean_of_c_counts_compression_and_the_mean_of_its_amount_counts_dilation_too() {
    let mut solver = built(&pool());
    for _ in 0..10 {
        solver.step_frame().expect("it runs");
    }
    let errors: Vec<f64> = solver.density_errors().iter().map(|error| f64::from(*error)).collect();
    let mean = |of: fn(f64) -> f64| errors.iter().map(|error| of(*error)).sum::<f64>() / errors.len() as f64;
    let found = solver.diagnostics();
    assert!((found.density_error_mean - mean(|error| error.max(0.0))).abs() < 1e-12);
    assert!((found.density_error_mean_abs - mean(f64::abs)).abs() < 1e-12);
    assert!(found.density_error_mean_abs > 2.0 * found.density_error_mean, "the surface is dilated: {found:?}");
    assert_eq!(found.materials[0].density_error_mean_abs, found.density_error_mean_abs);
}
