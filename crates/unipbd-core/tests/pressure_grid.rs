//! The pressure grid: fluids with the substeps of their speed alone.

use unipbd_core::scene::{Block, Disc, Domain, Liquid, Obstacle, PressureGridUse, Scene, SolverSettings, Tank};
use unipbd_core::{BuildOptions, Solver};

const GRAVITY: f64 = 9.81;

fn grid() -> SolverSettings {
    SolverSettings { pressure_grid: PressureGridUse::On, ..SolverSettings::default() }
}

/// Water of this width and depth in the left of a tank of this width [m], at 10 particles per metre.
fn pool(water: [f64; 2], tank: f64) -> Scene {
    let tank = Tank { name: "tank".into(), ..Tank::new([0.0, 0.0], [tank, water[1] + 2.0]) };
    Scene {
        solver: grid(),
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], water)],
        tank: vec![tank],
        ..Scene::default()
    }
}

fn build(scene: &Scene, threads: usize) -> Solver {
    let options = BuildOptions { threads: Some(threads), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(solver: &mut Solver, frames: u32, mut look: impl FnMut(&Solver)) {
    for _ in 0..frames {
        solver.step_frame().expect("the scene is calm");
        look(solver);
    }
}

#[test]
fn a_deep_column_stands_on_one_substep() {
    let depth = 20.0;
    let mut solver = build(&pool([1.6, depth], 1.6), 1);
    run(&mut solver, 300, |_| ());
    let (mut worst, mut height, mut slope, mut floor) = (0.0_f64, 0.0, 0.0, 0.0);
    run(&mut solver, 30, |solver| {
        let diagnostics = solver.diagnostics();
        assert_eq!(diagnostics.substeps, 1);
        worst = worst.max(diagnostics.density_error_max);
        let mean = solver.positions().iter().map(|x| f64::from(x.y)).sum::<f64>() / solver.positions().len() as f64;
        height += 2.0 * mean / 30.0;
        let (mut top, mut bottom) = (0.0, 0.0);
        for (x, pressure) in solver.positions().iter().zip(solver.pressures()) {
            let below = 2.0 * mean - f64::from(x.y);
            top += below * f64::from(*pressure);
            bottom += below * below;
        }
        slope += top / bottom / 30.0;
        let down = solver.wall_forces().into_iter().find(|wall| wall.name == "tank bottom").expect("it is measured");
        floor -= down.force.y / 30.0;
    });
    let weight = 1000.0 * 0.01 * solver.positions().len() as f64 * GRAVITY;
    eprintln!("C {worst:.4}, height {height:.3}, slope {slope:.3}, floor {:.4}", floor / weight);
    assert!(worst < 0.013, "{worst}");
    assert!((height / depth - 1.0).abs() < 0.012, "{height}");
    assert!((slope / GRAVITY - 1.0).abs() < 0.02, "{slope}");
    assert!((floor / weight - 1.0).abs() < 0.01, "{}", floor / weight);
}

#[test]
fn a_dam_breaks_without_gaining_energy() {
    let mut solver = build(&pool([2.0, 4.0], 8.0), 1);
    let energy = |solver: &Solver| {
        let diagnostics = solver.diagnostics();
        diagnostics.kinetic_energy + diagnostics.potential_energy
    };
    let (start, mut most, mut mean) = (energy(&solver), f64::NEG_INFINITY, 0.0);
    run(&mut solver, 180, |solver| {
        most = most.max(energy(solver) / start - 1.0);
        mean += solver.diagnostics().density_error_mean / 180.0;
        let inside = |x: f32, most: f32| (-1e-4..=most + 1e-4).contains(&x);
        let out = solver.positions().iter().find(|x| !inside(x.x, 8.0) || x.y < -1e-4);
        assert_eq!(out, None, "at {} s", solver.time());
    });
    eprintln!("gain {most:.4}, mean C {mean:.5}");
    assert!(most < 0.005, "{most}");
    assert!(mean < 0.004, "{mean}");
}

#[test]
fn a_falling_drop_keeps_its_momentum() {
    let drop = |velocity| Disc {
        material: "water".into(),
        center: [0.0, 0.0],
        radius: 1.5,
        velocity,
        jitter: 0.2,
        temperature: 0.0,
    };
    let scene = Scene { tank: Vec::new(), block: Vec::new(), disc: vec![drop([3.0, 1.0])], ..pool([1.0, 1.0], 1.0) };
    let mut solver = build(&scene, 1);
    let (before, time) = (solver.diagnostics().momentum, solver.time());
    run(&mut solver, 60, |_| ());
    let mass = 10.0 * solver.positions().len() as f64;
    let fallen = solver.diagnostics().momentum.y - before.y + mass * GRAVITY * (solver.time() - time);
    let drifted = solver.diagnostics().momentum.x - before.x;
    assert!(fallen.abs() < 1e-3 * mass && drifted.abs() < 1e-3 * mass, "{fallen} {drifted} of {mass}");
}

#[test]
fn the_bits_do_not_depend_on_threads_or_on_a_pause() {
    let obstacle = Obstacle::new([6.0, 0.0], [6.65, 1.35]);
    let scene = Scene { obstacle: vec![obstacle], ..pool([5.0, 10.0], 12.0) };
    let (mut one, mut two) = (build(&scene, 1), build(&scene, 2));
    run(&mut one, 40, |_| ());
    run(&mut two, 20, |_| ());
    let mut other = build(&scene, 3);
    other.restore(&two.save()).expect("it is a state of this scene");
    run(&mut other, 20, |_| ());
    assert_eq!(one.state_hash(), other.state_hash());
    assert_eq!(one.diagnostics(), other.diagnostics());
}

#[test]
fn what_it_does_not_support_is_refused_at_once() {
    let domain = Domain { periodic_x: Some([0.0, 2.0]), ..Domain::default() };
    let scene = Scene { domain, tank: Vec::new(), ..pool([1.0, 1.0], 2.0) };
    let problems = scene.build(BuildOptions::default()).err().expect("it is not possible").to_string();
    for word in ["pressure_grid", "periodic"] {
        assert!(problems.contains(word), "{problems}");
    }
}
