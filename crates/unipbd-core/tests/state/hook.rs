use crate::scenes::{all, build, build_on, liquid, plume, run};
use unipbd_core::rigid::{BodyKind, Twist};
use unipbd_core::scene::{BodyDescription, PointMotion, Scene, Solid};
use unipbd_core::{Edit, SolverError, Vector, Vector64};

#[derive(Debug, PartialEq)]
enum Failure {
    Own,
    Solver(SolverError),
}

impl From<SolverError> for Failure {
    fn from(error: SolverError) -> Self {
        Failure::Solver(error)
    }
}

#[test]
fn a_hook_that_does_nothing_changes_nothing() {
    for (name, scene) in all() {
        let (mut plain, mut hooked) = (build(&scene), build_on(&scene, 2));
        let mut calls = 0;
        for _ in 0..30 {
            let report = plain.step_frame().unwrap();
            let hook = |_: &mut unipbd_core::SubstepView<'_>| -> Result<(), SolverError> {
                calls += 1;
                Ok(())
            };
            assert_eq!(hooked.step_frame_with(hook).unwrap(), report);
        }
        assert_eq!(hooked.state_hash(), plain.state_hash(), "{name}");
        assert_eq!(calls, plain.step(), "{name}: once per substep");
    }
}

#[test]
fn a_spring_to_the_origin_swings_a_free_point_on_a_circle() {
    let mut scene = Scene { gravity: [0.0; 2], ..Scene::default() };
    scene.solid.push(Solid { name: "bead".into(), ..Solid::default() });
    let mut bead = crate::scenes::points("bead", &[[1.0, 0.0]]);
    bead.velocity = [0.0, 3.0];
    scene.points.push(bead);
    scene.solver.substeps = unipbd_core::scene::Substeps::Fixed(50);
    let mut solver = build(&scene);
    while solver.time() < 2.0 {
        let frame = solver.step_frame_with(|view| -> Result<(), SolverError> {
            let pull = -9.0 * view.positions()[0];
            view.add_acceleration(0, pull);
            Ok(())
        });
        frame.unwrap();
        assert!((solver.positions()[0].length() - 1.0).abs() < 0.01);
    }
    let angle = 3.0 * solver.time();
    let expected = Vector::new(angle.cos() as _, angle.sin() as _);
    assert!((solver.positions()[0] - expected).length() < 0.02);
}

#[test]
fn accelerations_follow_their_rows_while_an_emitter_adds_particles() {
    let mut solver = build(&plume());
    run(&mut solver, 30);
    for _ in 0..20 {
        let frame = solver.step_frame_with(|view| -> Result<(), SolverError> {
            view.accelerations_mut().fill(Vector::new(400.0, 0.0));
            Ok(())
        });
        frame.unwrap();
    }
    let free = (0..solver.ids().len()).filter(|&row| solver.particles().inverse_masses()[row] > 0.0);
    let velocities: Vec<_> = free.map(|row| solver.velocities()[row].x).collect();
    let mean = velocities.iter().sum::<unipbd_core::Real>() / velocities.len() as unipbd_core::Real;
    assert!(mean > 2.0, "the whole plume is blown away: {mean} m/s");
}

#[test]
fn a_failing_hook_leaves_a_run_that_goes_on_to_the_same_end() {
    let mut expected = build(&liquid());
    run(&mut expected, 20);
    let mut solver = build(&liquid());
    while solver.frame() < 20 {
        let mut calls = 0;
        let outcome = solver.step_frame_with(|_| {
            calls += 1;
            if calls == 3 { Err(Failure::Own) } else { Ok(()) }
        });
        match outcome {
            Err(error) => assert_eq!(error, Failure::Own),
            Ok(_) => assert!(calls < 3),
        }
        assert!(solver.density_errors().iter().all(|error| error.is_finite()));
        let saved = solver.save();
        solver.restore(&saved).unwrap();
    }
    assert_eq!(solver.state_hash(), expected.state_hash());
    assert_eq!(solver.time(), expected.time());
}

#[test]
fn a_hook_moves_kinematic_particles_as_it_likes() {
    let mut solver = build(&liquid());
    solver.apply(&Edit::new().set_motion([0], PointMotion::Kinematic)).unwrap();
    for _ in 0..30 {
        let frame = solver.step_frame_with(|view| -> Result<(), SolverError> {
            let row = view.ids().iter().position(|&id| id == 0).unwrap();
            assert_eq!(view.inverse_mass(row), 0.0);
            view.set_velocity(row, Vector::new(0.0, 1.0));
            Ok(())
        });
        frame.unwrap();
    }
    let row = solver.ids().iter().position(|&id| id == 0).unwrap();
    assert!((solver.positions()[row].y - 0.55).abs() < 0.01, "{}", solver.positions()[row]);
}

/// A body in empty space without gravity.
fn lone_body(kind: BodyKind) -> Scene {
    let mut scene = Scene { gravity: [0.0; 2], ..Scene::default() };
    scene.body.push(BodyDescription { kind, ..BodyDescription::rectangle([0.5, 0.2], [0.0, 0.0]) });
    scene
}

#[test]
fn a_hook_pushes_a_body_with_a_force_and_a_torque() {
    let mut solver = build(&lone_body(BodyKind::Dynamic));
    let (mass, inertia) = (solver.bodies()[0].mass, solver.bodies()[0].inertia);
    run(&mut solver, 120);
    while solver.time() < 3.0 {
        let frame = solver.step_frame_with(|view| -> Result<(), SolverError> {
            assert!(view.body_pose(0).position.is_finite());
            view.push_body(0, Vector64::new(0.5 * mass, 0.0), 2.0 * inertia);
            Ok(())
        });
        frame.unwrap();
    }
    let body = &solver.bodies()[0];
    assert!((body.velocity.x - 0.5).abs() < 1e-9 && body.velocity.y == 0.0, "{:?}", body.velocity);
    assert!((body.angular_velocity - 2.0).abs() < 1e-9, "it was asleep and is woken");
    assert_eq!(body.fluid_force, Vector64::ZERO);
}

#[test]
fn a_kinematic_body_is_driven_step_by_step_and_a_saved_state_knows_it() {
    let mut solver = build(&lone_body(BodyKind::Kinematic));
    let drive = |solver: &mut unipbd_core::Solver, speed: f64, spin: f64| {
        solver.apply(&Edit::new().set_body_velocity(0, Vector64::new(speed, 0.0), spin)).unwrap();
        run(solver, 30);
    };
    drive(&mut solver, 1.0, 0.5);
    let saved = solver.save();
    run(&mut solver, 30);
    let (place, angle) = (solver.bodies()[0].position, solver.bodies()[0].angle);
    assert!((place.x - 1.0).abs() < 1e-9 && (angle - 0.5).abs() < 1e-9, "{place} {angle}");
    let expected = solver.state_hash();
    solver.restore(&saved).unwrap();
    run(&mut solver, 30);
    assert_eq!(solver.state_hash(), expected);
    drive(&mut solver, 0.0, 0.0);
    assert_eq!(solver.bodies()[0].position, place);
    let frame = solver.step_frame_with(|view| -> Result<(), SolverError> {
        view.set_body_velocity(0, Twist { linear: Vector64::new(0.0, 3.0), angular: 0.0 });
        Ok(())
    });
    frame.unwrap();
    assert!((solver.bodies()[0].position.y - 0.05).abs() < 1e-9);
}

#[test]
fn a_driven_paddle_pushes_the_water_before_it() {
    let mut scene = liquid();
    let paddle = BodyDescription::rectangle([0.1, 0.8], [2.4, 0.4]);
    scene.body.push(BodyDescription { kind: BodyKind::Kinematic, ..paddle });
    let mut solver = build(&scene);
    run(&mut solver, 90);
    let mean = |solver: &unipbd_core::Solver| {
        let free = (0..solver.ids().len()).filter(|&row| solver.phases()[row] == unipbd_core::Phase::Liquid);
        let places: Vec<f64> = free.map(|row| f64::from(solver.positions()[row].x)).collect();
        places.iter().sum::<f64>() / places.len() as f64
    };
    let before = mean(&solver);
    let edit = Edit::new().set_body_velocity(0, Vector64::new(-1.0, 0.0), 0.0);
    solver.apply(&edit).unwrap();
    run(&mut solver, 60);
    assert!((solver.bodies()[0].position.x - 1.4).abs() < 1e-9);
    assert!(mean(&solver) < before - 0.1, "{before} {}", mean(&solver));
}
