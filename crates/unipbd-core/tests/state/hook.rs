use crate::scenes::{all, build, build_on, liquid, plume, run};
use unipbd_core::scene::{PointMotion, Scene, Solid};
use unipbd_core::{Edit, SolverError, Vector};

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
fn a_hook_moves_scripted_particles_as_it_likes() {
    let mut solver = build(&liquid());
    solver.apply(&Edit::new().set_motion([0], PointMotion::Scripted)).unwrap();
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
