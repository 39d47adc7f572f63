//! The first body of a scene of fluids comes at run time.

use crate::scenes::{build, build_on, grid, liquid, mixed, plume, run};
use unipbd_core::edit::Edit;
use unipbd_core::scene::{
    BodyDescription, BodyKind, JointDescription, JointRule, Liquid, MotionDescription, Scene, Slip, SolverSettings,
};
use unipbd_core::{BuildOptions, Solver, Stage, State, Vector64};

fn crate_at(position: [f64; 2]) -> BodyDescription {
    BodyDescription { name: "crate".into(), density: 500.0, ..BodyDescription::rectangle([0.5, 0.3], position) }
}

fn sleepy() -> Scene {
    let solver = SolverSettings { sleep: true, ..SolverSettings::default() };
    Scene { solver, ..liquid() }
}

fn sticky() -> Scene {
    let honey = Liquid { name: "water".into(), kinematic_viscosity: 0.05, ..Liquid::default() };
    Scene { liquid: vec![honey], ..liquid() }
}

/// A crate that falls, a shelf that is a wall by its outline, a paddle that a viscous fluid sticks to.
fn three() -> Edit {
    let shelf = BodyDescription {
        name: "shelf".into(),
        kind: BodyKind::Static,
        ..BodyDescription::rectangle([0.6, 0.5], [2.0, 0.6])
    };
    let turn = MotionDescription { spin_deg: 60.0, ..MotionDescription::default() };
    let paddle = BodyDescription {
        name: "paddle".into(),
        kind: BodyKind::Kinematic,
        slip: Slip::None,
        motion: Some(turn),
        ..BodyDescription::rectangle([0.5, 0.3], [1.3, 1.9])
    };
    let rod = JointDescription::new(JointRule::Rod, "crate", [0.6, 3.2]);
    Edit::new()
        .add_body(crate_at([0.6, 3.2]))
        .add_body(shelf)
        .add_body(paddle)
        .add_joint(JointDescription { other_at: Some([0.6, 3.8]), ..rod })
}

fn go_on(one: &mut Solver, other: &mut Solver, frames: u32) {
    for _ in 0..frames {
        assert_eq!(one.step_frame(), other.step_frame());
        assert_eq!(one.state_hash(), other.state_hash());
    }
    assert_eq!(one.bodies(), other.bodies());
    assert_eq!(one.diagnostics(), other.diagnostics());
}

#[test]
fn the_first_bodies_are_saved_and_restored_bit_for_bit() {
    for scene in [liquid(), grid(), sleepy(), sticky(), plume(), mixed()] {
        let mut solver = build(&scene);
        run(&mut solver, 4);
        let early = solver.save();
        let mut untouched = build(&scene);
        untouched.restore(&early).expect("it is a state of this scene");
        solver.apply(&three()).expect("they fit");
        assert_eq!(solver.bodies().len(), 3);
        for _ in 0..2 {
            let state = State::from_bytes(&solver.save().to_bytes()).expect("it is whole");
            let mut fresh = build_on(&scene, 3);
            fresh.restore(&state).expect("it is a state of this scene");
            go_on(&mut solver, &mut fresh, 4);
        }
        let late = solver.save();
        solver.apply(&Edit::new().remove_body(0).remove_body(1).remove_body(2)).expect("they are there");
        run(&mut solver, 2);
        let mut fresh = build(&scene);
        fresh.restore(&solver.save()).expect("it is a state of this scene");
        go_on(&mut solver, &mut fresh, 3);
        // Back to before any came, then forward again.
        solver.restore(&early).expect("it is a state of this scene");
        assert_eq!(solver.materials(), untouched.materials());
        assert_eq!(solver.stages(), untouched.stages());
        go_on(&mut solver, &mut untouched, 6);
        for solver in [&mut solver, &mut untouched] {
            solver.restore(&late).expect("it is a state of this scene");
        }
        go_on(&mut solver, &mut untouched, 3);
    }
}

#[test]
fn a_state_with_bodies_that_makes_no_sense_leaves_a_run_without_bodies_as_it_was() {
    let mut solver = build(&liquid());
    let mut other = build(&Scene { spacing: 0.05, ..liquid() });
    other.apply(&three()).expect("they fit");
    run(&mut solver, 2);
    let hash = solver.state_hash();
    assert!(solver.restore(&other.save()).is_err());
    assert_eq!((solver.state_hash(), solver.materials().len(), solver.bodies().len()), (hash, 1, 0));
    let mut same = build(&liquid());
    run(&mut same, 2);
    go_on(&mut solver, &mut same, 3);
}

#[test]
fn what_no_body_needs_is_not_run_before_the_first_and_is_after() {
    for scene in [liquid(), grid(), sleepy()] {
        let mut solver = build(&scene);
        let bodies = [Stage::Contacts, Stage::MoveBodies, Stage::PlaceSamples];
        assert!(bodies.iter().all(|stage| !solver.stages().contains(stage)));
        let materials = solver.materials().len();
        let faulty = three().add_body(crate_at([0.6, 3.2]));
        assert!(solver.apply(&faulty).expect_err("there are two crates").to_string().contains("already"));
        assert!(bodies.iter().all(|stage| !solver.stages().contains(stage)), "nothing has changed");
        assert_eq!(solver.materials().len(), materials);
        solver.apply(&three()).expect("they fit");
        assert!(bodies.iter().all(|stage| solver.stages().contains(stage)));
        assert_eq!(solver.materials().len(), materials + 1);
    }
}

#[test]
fn a_first_body_floats_at_its_draft_and_is_felt_by_walls_of_any_solver() {
    for scene in [liquid(), grid()] {
        let mut scene = scene;
        scene.block[0].max = [2.5, 1.0];
        let mut solver = build(&scene);
        run(&mut solver, 60);
        let energy = |solver: &Solver| solver.diagnostics().kinetic_energy;
        let far = BodyDescription { kind: BodyKind::Static, ..crate_at([40.0, 0.0]) };
        solver.apply(&Edit::new().add_body(BodyDescription { name: "far".into(), ..far })).expect("it fits");
        run(&mut solver, 60);
        println!("energy of motion at rest: {:.4} J", energy(&solver));
        assert!(energy(&solver) < 0.5, "2500 kg of water hardly move: {} J", energy(&solver));
        solver.apply(&Edit::new().add_body(crate_at([1.2, 1.3]))).expect("it fits");
        run(&mut solver, 300);
        let mut lift = 0.0;
        for _ in 0..60 {
            run(&mut solver, 1);
            lift += solver.bodies()[1].fluid_force.y / 60.0 / (solver.bodies()[1].mass * 9.81);
        }
        println!("lift over weight {lift:.3}, {:.3} m above the level", solver.bodies()[1].position.y - 1.0);
        assert!((lift - 1.0).abs() < 0.05 && (solver.bodies()[1].position.y - 1.0).abs() < 0.1);
    }
}

#[test]
fn a_first_body_in_the_middle_of_a_pool_pushes_it_aside_gently() {
    let mut scene = liquid();
    scene.block[0].max = [2.5, 1.0];
    let mut solver = scene.build(BuildOptions { threads: Some(3), ..BuildOptions::default() }).expect("it is sound");
    run(&mut solver, 30);
    solver.apply(&Edit::new().add_body(crate_at([1.2, 0.5]))).expect("it fits");
    let mut fastest = 0.0_f64;
    for _ in 0..120 {
        run(&mut solver, 1);
        fastest = fastest.max(solver.diagnostics().speed_max);
    }
    println!("fastest {fastest:.2} m/s");
    assert!(fastest < 6.0, "nothing is thrown about: {fastest} m/s");
    let inside = |position: Vector64| {
        let body = &solver.bodies()[0];
        let arm = Vector64::from_angle(-body.angle).rotate(position - body.position);
        arm.x.abs() < 0.2 && arm.y.abs() < 0.1
    };
    let water = (0..solver.ids().len()).filter(|&row| solver.phases()[row].is_fluid());
    let caught = water.filter(|&row| inside(unipbd_core::math::wide(solver.positions()[row]))).count();
    assert_eq!(caught, 0, "no water stays in the crate");
}
