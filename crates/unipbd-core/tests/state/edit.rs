use crate::scenes::{build, liquid, mixed, plume, points, run};
use proptest::prelude::*;
use unipbd_core::edit::Points;
use unipbd_core::math::wide;
use unipbd_core::scene::{BodyDescription, PointMotion, Scene, Solid};
use unipbd_core::{Edit, EditError, Solver, Vector, Vector64};

fn row(solver: &Solver, id: u32) -> usize {
    solver.ids().iter().position(|&other| other == id).expect("it lives")
}

fn velocity(solver: &Solver, id: u32) -> Vector64 {
    wide(solver.velocities()[row(solver, id)])
}

#[test]
fn an_edit_sets_removes_and_adds_at_once() {
    let mut solver = build(&liquid());
    run(&mut solver, 5);
    let (before, given) = (solver.ids().len(), solver.particles().ids_given());
    let generation = solver.id_generation();
    let place = Vector64::new(2.0, 3.0);
    let edit = Edit::new()
        .set_velocities([7, 8], [Vector64::X, Vector64::Y])
        .set_positions([9], [place])
        .remove([0, 100])
        .add_points(Points { velocity: Vector64::NEG_Y, ..Points::new("water", vec![Vector64::new(1.5, 3.0)]) });
    assert_eq!(solver.apply(&edit).unwrap(), given..given + 1);
    assert_eq!(solver.ids().len(), before - 1);
    assert!(!solver.ids().contains(&0) && !solver.ids().contains(&100));
    assert_eq!(velocity(&solver, 7), Vector64::X);
    assert_eq!(velocity(&solver, given), Vector64::NEG_Y);
    assert_eq!(wide(solver.positions()[row(&solver, 9)]), place);
    assert!(solver.id_generation() > generation);
    run(&mut solver, 20);
    assert_eq!(solver.ids().len(), before - 1);
}

#[test]
fn a_faulty_edit_changes_nothing() {
    let nan = Vector64::new(f64::NAN, 0.0);
    let sound = || Edit::new().set_velocities([1], [Vector64::X]).remove([2]);
    let cases = [
        (sound().remove([1_000_000]), "there is no particle with id 1000000"),
        (sound().remove([5, 5]), "the id 5 is given twice"),
        (sound().set_positions([3], [nan]), "position 0 is NaN, not a finite number"),
        (sound().set_positions([3], [Vector64::splat(1e30)]), "is farther than"),
        (sound().set_velocities([3], [Vector64::splat(1e300)]), "not a finite number"),
        (sound().set_velocities([3, 4], [Vector64::X]), "1 velocities are given for 2 particles"),
        (sound().set_temperatures([3], [1.0]), "no temperatures"),
        (
            sound().add_points(Points::new("wine", vec![Vector64::X])),
            "there is no material \"wine\"; the materials are [\"water\"]",
        ),
        (sound().add_points(Points::new("water", vec![nan])), "position 0 is NaN"),
    ];
    let mut solver = build(&liquid());
    let (hash, ids) = (solver.state_hash(), solver.ids().to_vec());
    for (edit, expected) in cases {
        let error = solver.apply(&edit).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert_eq!((solver.state_hash(), solver.ids()), (hash, &ids[..]));
    }
    assert_eq!(solver.apply(&Edit::new().remove([9; 2])).unwrap_err(), EditError::RepeatedId(9));
}

#[test]
fn points_are_where_they_are_put_and_kinematic_ones_keep_their_velocity() {
    let mut kinematic = points("beads", &[[0.0, 0.0]]);
    (kinematic.motion, kinematic.velocity) = (PointMotion::Kinematic, [0.5, 0.25]);
    let falling = points("beads", &[[1.0, 5.0], [2.0, 5.0]]);
    let beads = Solid { name: "beads".into(), gravity_factor: 0.5, ..Solid::default() };
    let scene = Scene { solid: vec![beads], points: vec![falling, kinematic], ..Scene::default() };
    let mut solver = build(&scene);
    run(&mut solver, 60);
    assert_eq!(velocity(&solver, 2), Vector64::new(0.5, 0.25));
    assert!((wide(solver.positions()[row(&solver, 2)]) - Vector64::new(0.5, 0.25)).length() < 1e-5);
    assert!((velocity(&solver, 0).y + 0.5 * 9.81).abs() < 1e-4, "half of gravity for a second");
    assert_eq!(solver.stages().len(), 2, "free flight predicts and updates: {:?}", solver.stages());
    solver.apply(&Edit::new().set_motion([2], PointMotion::Free).set_motion([0], PointMotion::Kinematic)).unwrap();
    let held = velocity(&solver, 0);
    run(&mut solver, 1);
    assert_eq!(velocity(&solver, 0), held);
    assert!(velocity(&solver, 2).y < 0.25);
}

#[test]
fn a_kinematic_particle_of_a_uniform_liquid_stays_put() {
    let mut solver = build(&liquid());
    let at = wide(solver.positions()[row(&solver, 55)]);
    let edit = Edit::new().set_velocities([55], [Vector64::ZERO]).set_motion([55], PointMotion::Kinematic);
    solver.apply(&edit).unwrap();
    run(&mut solver, 60);
    assert_eq!(wide(solver.positions()[row(&solver, 55)]), at);
}

#[test]
fn bodies_are_pushed_as_a_whole_and_their_samples_left_alone() {
    let mut scene = liquid();
    scene.body.push(BodyDescription::rectangle([0.4, 0.4], [1.8, 2.0]));
    let mut solver = build(&scene);
    run(&mut solver, 2);
    let edit = Edit::new().set_body_velocity(0, Vector64::new(0.5, 1.0), 2.0);
    solver.apply(&edit).unwrap();
    assert_eq!((solver.bodies()[0].velocity, solver.bodies()[0].angular_velocity), (Vector64::new(0.5, 1.0), 2.0));
    let before = solver.bodies()[0].position;
    run(&mut solver, 3);
    assert!(solver.bodies()[0].position.x > before.x + 0.01);
    let sample = (0..solver.ids().len()).find(|&row| solver.phases()[row] == unipbd_core::Phase::Rigid).unwrap();
    let sample = solver.ids()[sample];
    for edit in [Edit::new().remove([sample]), Edit::new().set_velocities([sample], [Vector64::X])] {
        assert!(solver.apply(&edit).unwrap_err().to_string().contains("rigid body"));
    }
    assert!(solver.apply(&Edit::new().set_body_velocity(1, Vector64::X, 0.0)).is_err());
    assert!(solver.apply(&Edit::new().set_body_velocity(0, Vector64::X, f64::NAN)).is_err());
}

#[test]
fn edits_of_every_scene_leave_a_run_that_saves_and_goes_on() {
    for scene in [liquid(), plume(), mixed()] {
        let mut solver = build(&scene);
        for round in 0..12 {
            run(&mut solver, 3);
            let gone: Vec<u32> = solver.ids().iter().copied().filter(|id| id % 13 == round).collect();
            let name = solver.materials()[0].name.clone();
            let fresh = Points::new(&name, vec![Vector64::new(0.5 + 0.1 * f64::from(round), 3.0)]);
            solver.apply(&Edit::new().remove(gone).add_points(fresh)).unwrap();
            let mut other = build(&scene);
            other.restore(&solver.save()).unwrap();
            assert_eq!(other.density_errors(), solver.density_errors());
            assert_eq!(other.step_frame(), solver.step_frame());
            assert_eq!(other.diagnostics(), solver.diagnostics());
            assert_eq!(other.state_hash(), solver.state_hash());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn whatever_is_asked_an_edit_applies_wholly_or_not_at_all(
        removed in proptest::collection::vec(0_u32..240, 0..20),
        moved in proptest::collection::vec((0_u32..240, -1e3..1e3_f64, any::<f64>()), 0..6),
        added in proptest::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 0..5),
    ) {
        let mut solver = build(&liquid());
        let (hash, count) = (solver.state_hash(), solver.ids().len());
        let ids: Vec<u32> = moved.iter().map(|(id, ..)| *id).collect();
        let velocities: Vec<Vector64> = moved.iter().map(|(_, x, y)| Vector64::new(*x, *y)).collect();
        let positions: Vec<Vector64> = added.iter().map(|(x, y)| Vector64::new(*x, *y)).collect();
        let number = positions.len();
        let edit = Edit::new().set_velocities(ids, velocities).remove(removed.clone());
        match solver.apply(&edit.add_points(Points::new("water", positions))) {
            Ok(new) => {
                prop_assert_eq!(new.len(), number);
                prop_assert_eq!(solver.ids().len(), count - removed.len() + number);
                prop_assert!(solver.velocities().iter().copied().all(Vector::is_finite));
                let hash = solver.state_hash();
                let saved = solver.save();
                prop_assert_eq!({ solver.restore(&saved).unwrap(); solver.state_hash() }, hash);
            }
            Err(_) => prop_assert_eq!(solver.state_hash(), hash),
        }
    }
}
