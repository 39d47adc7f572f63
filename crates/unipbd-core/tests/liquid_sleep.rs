//! A pool at rest falls asleep, costs nothing, and wakes where something happens to it.

use unipbd_core::edit::Points;
use unipbd_core::scene::{
    Block, BodyDescription, Emitter, Liquid, PressureGridUse, Scene, SolverSettings, Substeps, Tank,
};
use unipbd_core::{BuildOptions, Edit, Phase, Solver, Vector64};

const SPACING: f64 = 0.1;

/// A pool this many particles wide and deep, rather viscous so that it comes to rest soon.
fn pool(wide: f64, deep: f64, sleep: bool) -> Scene {
    let (width, depth) = (wide * SPACING, deep * SPACING);
    Scene {
        spacing: SPACING,
        liquid: vec![Liquid { xsph: 0.05, ..Liquid::new("water", 1000.0) }],
        block: vec![Block::new("water", [0.0, 0.0], [width, depth])],
        tank: vec![Tank::new([0.0, 0.0], [width, depth + 4.0])],
        solver: SolverSettings { sleep, substeps: Substeps::Fixed(8), ..SolverSettings::default() },
        ..Scene::default()
    }
}

fn build(scene: &Scene, threads: usize) -> Solver {
    let options = BuildOptions { threads: Some(threads), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(solver: &mut Solver, seconds: f64) -> u64 {
    let frames = (seconds * 60.0).round() as u32;
    (0..frames).map(|_| solver.step_frame().expect("the pool is calm").rows_stepped).sum()
}

/// Runs until everything sleeps.
fn run_to_sleep(solver: &mut Solver, seconds: f64) {
    while solver.particles().asleep() < solver.particles().len() {
        run(solver, 0.1);
        let asleep = solver.particles().asleep();
        assert!(solver.time() < seconds, "{asleep} of {} asleep at {:.1} s", solver.particles().len(), solver.time());
    }
}

/// A round drop at rest above the surface.
fn drop_in(solver: &mut Solver, x: f64, y: f64) {
    let places = (-3..=3).flat_map(|i| (-3..=3).map(move |j| (f64::from(i), f64::from(j))));
    let round = places.filter(|(i, j)| i * i + j * j < 9.5);
    let drop: Vec<_> = round.map(|(i, j)| Vector64::new(x + i * SPACING, y + j * SPACING)).collect();
    solver.apply(&Edit::new().add_points(Points::new("water", drop))).expect("there is room");
}

/// Heights of the centre of mass and of the surface, the mean over columns four spacings wide \[m].
fn heights(solver: &Solver) -> (f64, f64) {
    let liquid = || solver.positions().iter().zip(solver.phases()).filter(|(_, phase)| **phase == Phase::Liquid);
    let mean = liquid().map(|(x, _)| f64::from(x.y)).sum::<f64>() / liquid().count() as f64;
    let columns = (liquid().map(|(x, _)| f64::from(x.x)).fold(0.0, f64::max) / (4.0 * SPACING)) as usize;
    let mut tops = vec![0.0_f64; columns];
    for (x, _) in liquid() {
        let column = ((f64::from(x.x) / (4.0 * SPACING)) as usize).min(columns - 1);
        tops[column] = tops[column].max(f64::from(x.y));
    }
    (mean, tops.iter().sum::<f64>() / columns as f64)
}

#[test]
fn a_settled_pool_sleeps_and_steps_no_row() {
    let mut solver = build(&pool(40.0, 20.0, true), 1);
    let awake = run(&mut solver, 1.0);
    assert_eq!(awake, 60 * 8 * 800);
    run_to_sleep(&mut solver, 20.0);
    println!("asleep after {:.1} s", solver.time());
    let (hash, places) = (solver.state_hash(), solver.positions().to_vec());
    let work = run(&mut solver, 1.0);
    assert_eq!(work, 0, "asleep no row is stepped");
    assert_eq!(solver.positions(), places);
    assert!(solver.velocities().iter().all(|velocity| velocity.length() == 0.0));
    assert_ne!(solver.state_hash(), hash, "time goes on");
    assert!(solver.density_errors().iter().all(|error| error.abs() < 0.5));
}

#[test]
fn a_scene_that_does_not_sleep_has_no_such_stage_and_columns() {
    let mut solver = build(&pool(10.0, 10.0, false), 1);
    run(&mut solver, 0.1);
    assert!(solver.timings().iter().all(|(name, _)| *name != "sleep"));
    let mut sleeper = build(&pool(10.0, 10.0, true), 1);
    run(&mut sleeper, 0.1);
    assert!(sleeper.timings().iter().any(|(name, _)| *name == "sleep"));
    assert!(sleeper.positions() == solver.positions(), "until it sleeps a pool moves as any other");
}

#[test]
fn a_drop_wakes_what_is_around_it_and_the_pool_ends_as_one_that_never_slept() {
    let mut solvers = [true, false].map(|sleep| build(&pool(120.0, 16.0, sleep), 2));
    run_to_sleep(&mut solvers[0], 40.0);
    let slept = solvers[0].time();
    run(&mut solvers[1], slept);
    let count = solvers[0].particles().len();
    for solver in &mut solvers {
        drop_in(solver, 2.0, 2.6);
    }
    let work: Vec<u64> = solvers.iter_mut().map(|solver| run(solver, 0.5)).collect();
    let asleep = solvers[0].particles().asleep();
    println!("slept at {slept:.1} s; after the splash {asleep} of {count} asleep, {work:?} rows stepped");
    assert!(asleep < count && asleep > count / 4, "near the splash it is awake, far away it sleeps");
    assert!(work[0] < work[1]);
    solvers.iter_mut().for_each(|solver| {
        run(solver, 10.0);
    });
    let [slept, unslept] = [heights(&solvers[0]), heights(&solvers[1])];
    let apart = [(slept.0 - unslept.0) / SPACING, (slept.1 - unslept.1) / SPACING];
    println!("centre of mass {:+.3} and surface {:+.3} spacings from the unslept run", apart[0], apart[1]);
    assert!(apart.iter().all(|apart| apart.abs() < 0.1));
}

#[test]
fn threads_do_not_change_who_sleeps() {
    let hash = |threads: usize| {
        let mut solver = build(&pool(110.0, 40.0, true), threads);
        let mut slept = 0;
        for second in 0..16 {
            run(&mut solver, 1.0);
            slept = slept.max(solver.particles().asleep());
            if second == 13 {
                drop_in(&mut solver, 2.0, 5.0);
            }
        }
        (solver.state_hash(), slept)
    };
    let one = hash(1);
    assert!(one.1 > 0, "something slept");
    assert_eq!(hash(3), one);
}

#[test]
fn a_body_at_rest_in_a_pool_sleeps_with_it_and_wakes_with_it() {
    let raft = BodyDescription { density: 500.0, ..BodyDescription::rectangle([0.8, 0.4], [2.0, 2.2]) };
    let rock = BodyDescription { density: 3000.0, ..BodyDescription::rectangle([0.5, 0.5], [3.3, 0.3]) };
    let mut solver = build(&Scene { body: vec![raft, rock], ..pool(40.0, 20.0, true) }, 1);
    run_to_sleep(&mut solver, 40.0);
    let (places, force) = (solver.bodies().to_vec(), solver.bodies()[0].fluid_force);
    println!("asleep after {:.1} s, raft at {}, force {force}", solver.time(), places[0].position);
    assert!(solver.bodies().iter().all(|body| body.asleep));
    assert!((force.y / (solver.bodies()[0].mass * 9.81) - 1.0).abs() < 0.1, "the water carries the raft");
    assert_eq!(run(&mut solver, 2.0), 0);
    let still = solver.bodies().iter().zip(&places).all(|(now, then)| now.position == then.position);
    assert!(still && solver.bodies()[0].fluid_force == force, "a sleeping body keeps its load");
    solver.apply(&Edit::new().set_body_velocity(0, Vector64::new(0.0, -2.0), 0.0)).expect("it is there");
    run(&mut solver, 0.1);
    assert!(!solver.bodies()[0].asleep && solver.particles().asleep() < solver.particles().len());
    assert!(solver.bodies()[0].position.y < places[0].position.y - 0.02, "pushed down");
    run(&mut solver, 6.0);
    let back = solver.bodies()[0].position.y - places[0].position.y;
    println!("back at {:+.2} spacings", back / SPACING);
    assert!(back.abs() < 0.5 * SPACING, "and up again");
}

#[test]
fn an_edit_wakes_the_liquid_around_it() {
    let mut solver = build(&pool(60.0, 16.0, true), 1);
    run_to_sleep(&mut solver, 40.0);
    let (state, count) = (solver.save(), solver.particles().len());
    let row = (0..count).min_by(|&a, &b| solver.positions()[a].x.total_cmp(&solver.positions()[b].x)).expect("some");
    let id = solver.ids()[row];
    let near = Edit::new().set_velocities([id], [Vector64::new(1.0, 0.0)]);
    let far = Edit::new().set_positions([id], [Vector64::new(3.0, 3.0)]);
    for edit in [near, far, Edit::new().remove([id])] {
        solver.restore(&state).expect("its own state");
        assert_eq!(solver.particles().asleep(), count);
        solver.apply(&edit).expect("the edit is sound");
        let asleep = solver.particles().asleep();
        assert!(asleep < count && asleep > count / 2, "{asleep} of {count} still asleep after {edit:?}");
        assert!(run(&mut solver, 0.05) > 0);
    }
}

#[test]
fn a_hook_that_pushes_wakes_what_it_pushes() {
    let mut solver = build(&pool(60.0, 16.0, true), 1);
    run_to_sleep(&mut solver, 40.0);
    let look = |_: &mut unipbd_core::SubstepView<'_>| Ok::<(), unipbd_core::SolverError>(());
    solver.step_frame_with(look).expect("it goes on");
    assert_eq!(solver.particles().awake(), 0, "looking wakes nobody");
    let push = |view: &mut unipbd_core::SubstepView<'_>| {
        let left: Vec<usize> = (0..view.ids().len()).filter(|&row| view.positions()[row].x < 0.5).collect();
        left.into_iter().for_each(|row| view.add_acceleration(row, unipbd_core::Vector::new(0.0, 30.0)));
        Ok::<(), unipbd_core::SolverError>(())
    };
    solver.step_frame_with(push).expect("it goes on");
    let (awake, count) = (solver.particles().awake(), solver.particles().len());
    assert!(awake > 0 && awake < count / 2, "{awake} of {count} awake");
}

#[test]
fn a_state_saved_while_a_part_sleeps_goes_on_bit_for_bit() {
    let mut solver = build(&pool(60.0, 16.0, true), 1);
    run_to_sleep(&mut solver, 40.0);
    drop_in(&mut solver, 1.0, 2.3);
    run(&mut solver, 0.3);
    let asleep = solver.particles().asleep();
    assert!(asleep > 0 && asleep < solver.particles().len());
    let bytes = solver.save().to_bytes();
    run(&mut solver, 1.0);
    let mut other = build(&pool(60.0, 16.0, true), 2);
    other.restore(&unipbd_core::State::from_bytes(&bytes).expect("a state")).expect("the same scene");
    assert_eq!(other.particles().asleep(), asleep);
    run(&mut other, 1.0);
    assert_eq!(other.state_hash(), solver.state_hash());
}

#[test]
fn an_emitter_that_opens_wakes_what_its_stream_hits() {
    let opens = 30.0;
    let tap = Emitter { direction: [0.0, -1.0], start: opens, ..Emitter::new("water", [1.0, 2.6], 0.5, 2.0) };
    let mut solver = build(&Scene { emitter: vec![tap], ..pool(120.0, 16.0, true) }, 1);
    run_to_sleep(&mut solver, opens);
    let (count, closed) = (solver.particles().len(), opens - solver.time());
    assert_eq!(run(&mut solver, closed - 0.1), 0, "a closed emitter wakes nobody");
    run(&mut solver, 0.8);
    let (now, awake) = (solver.particles().len(), solver.particles().awake());
    println!("{count} slept; {} came, {awake} awake", now - count);
    assert!(now > count && awake > now - count, "those that came and those that they hit are awake");
    assert!(solver.particles().asleep() > count / 4, "far away they sleep on");
}

/// The same with the pressure grid, and measured walls.
fn with_grid(scene: Scene) -> Scene {
    let solver = SolverSettings { pressure_grid: PressureGridUse::On, substeps: Substeps::Auto, ..scene.solver };
    let tank = scene.tank.into_iter().map(|tank| Tank { name: "t".into(), ..tank }).collect();
    Scene { solver, tank, ..scene }
}

/// Force on the floor over the weight of the water.
fn floor(solver: &Solver) -> f64 {
    let weight = solver.particles().len() as f64 * 1000.0 * SPACING * SPACING * 9.81;
    let walls = solver.wall_forces();
    -walls.iter().find(|wall| wall.name == "t bottom").expect("it is measured").force.y / weight
}

#[test]
fn a_pool_with_the_pressure_grid_sleeps_and_a_drop_wakes_a_part_of_it() {
    let mut solvers = [true, false].map(|sleep| build(&with_grid(pool(120.0, 16.0, sleep)), 2));
    run_to_sleep(&mut solvers[0], 5.0);
    let slept = solvers[0].time();
    run(&mut solvers[1], slept);
    let (places, pressed) = (solvers[0].positions().to_vec(), floor(&solvers[0]));
    assert_eq!(run(&mut solvers[0], 1.0), 0, "asleep no row is stepped");
    assert!(solvers[0].positions() == places && floor(&solvers[0]) == pressed, "all stays as it is");
    assert!((pressed - 1.0).abs() < 0.02, "the floor carries the pool: {pressed}");
    let count = solvers[0].particles().len();
    solvers.iter_mut().for_each(|solver| drop_in(solver, 2.0, 2.6));
    let work: Vec<u64> = solvers.iter_mut().map(|solver| run(solver, 0.4)).collect();
    let asleep = solvers[0].particles().asleep();
    println!("slept at {slept:.1} s; {asleep} of {count} asleep after the splash, {work:?} rows stepped");
    assert!(asleep < count && asleep > count / 4 && work[0] < work[1]);
    let far = |solver: &Solver| -> Vec<usize> {
        (0..solver.particles().len()).filter(|&row| solver.positions()[row].x > 8.0).collect()
    };
    let fastest = far(&solvers[0]).into_iter().map(|row| solvers[0].velocities()[row].length()).fold(0.0, f32::max);
    assert!(fastest < 0.1, "far from the drop nothing moves: {fastest} m/s");
    solvers.iter_mut().for_each(|solver| {
        run(solver, 4.0);
    });
    let [slept, unslept] = [heights(&solvers[0]), heights(&solvers[1])];
    let apart = [(slept.0 - unslept.0) / SPACING, (slept.1 - unslept.1) / SPACING];
    println!("centre of mass {:+.3} and surface {:+.3} spacings from the unslept run", apart[0], apart[1]);
    assert!(apart[0].abs() < 0.1 && apart[1].abs() < 0.2, "{apart:?}");
}

#[test]
fn a_sleeping_pool_with_the_pressure_grid_goes_on_bit_for_bit_on_any_number_of_threads() {
    let scene = with_grid(pool(110.0, 16.0, true));
    let mut solver = build(&scene, 1);
    run_to_sleep(&mut solver, 5.0);
    drop_in(&mut solver, 1.0, 2.3);
    run(&mut solver, 0.3);
    let asleep = solver.particles().asleep();
    assert!(asleep > 0 && asleep < solver.particles().len());
    let mut other = build(&scene, 3);
    other.restore(&solver.save()).expect("the same scene");
    for solver in [&mut solver, &mut other] {
        run(solver, 1.0);
    }
    assert_eq!(other.state_hash(), solver.state_hash());
}

#[test]
fn a_raft_sleeps_in_a_pool_with_the_pressure_grid_and_wakes_when_pushed() {
    let raft = BodyDescription { density: 500.0, ..BodyDescription::rectangle([0.8, 0.4], [2.0, 2.0]) };
    let mut solver = build(&with_grid(Scene { body: vec![raft], ..pool(40.0, 20.0, true) }), 1);
    run_to_sleep(&mut solver, 40.0);
    let raft = solver.bodies()[0].clone();
    println!("asleep after {:.1} s, raft at {}, force {}", solver.time(), raft.position, raft.fluid_force);
    assert!(raft.asleep && (raft.fluid_force.y / (raft.mass * 9.81) - 1.0).abs() < 0.1);
    assert_eq!(run(&mut solver, 2.0), 0);
    assert!(solver.bodies()[0].position == raft.position && solver.bodies()[0].fluid_force == raft.fluid_force);
    solver.apply(&Edit::new().set_body_velocity(0, Vector64::new(0.0, -2.0), 0.0)).expect("it is there");
    run(&mut solver, 0.1);
    assert!(!solver.bodies()[0].asleep && solver.bodies()[0].position.y < raft.position.y - 0.02, "pushed down");
    run(&mut solver, 6.0);
    assert!((solver.bodies()[0].position.y - raft.position.y).abs() < 0.5 * SPACING, "and up again");
}
