//! A running world is changed: bodies and joints come, change and go, wholly or not at all, and states hold it all.

use super::common::{ALL, build, floored, free, named, step};
use unipbd_core::edit::{BodyChange, Edit};
use unipbd_core::rigid::contact::Motor;
use unipbd_core::scene::{
    Block, BodyDescription, BodyKind, BodySolver, JointDescription, JointRule, Liquid, MotionDescription, Rope, Scene,
    Solid, Substeps, Tank,
};
use unipbd_core::{Solver, State, Vector64};

fn at(x: f64, y: f64) -> Vector64 {
    Vector64::new(x, y)
}

fn cube(name: &str, position: [f64; 2]) -> BodyDescription {
    named(name, BodyDescription::rectangle([0.4, 0.4], position))
}

fn find(solver: &Solver, name: &str) -> usize {
    solver.bodies().iter().position(|body| body.name == name && !body.removed).expect("it is there")
}

/// Water in a tank, and a box.
fn pool() -> Scene {
    let mut scene = free(Substeps::Auto, vec![cube("float", [1.0, 1.0])]);
    scene.spacing = 0.08;
    scene.tank = vec![Tank { name: "tank".into(), ..Tank::new([0.0, 0.0], [2.0, 3.0]) }];
    scene.liquid = vec![Liquid::new("water", 1000.0)];
    scene.block = vec![Block::new("water", [0.0, 0.0], [2.0, 0.8])];
    scene.body[0].density = 500.0;
    scene
}

#[test]
fn bodies_come_and_go() {
    for substeps in ALL {
        let mut solver = build(&floored(substeps, vec![cube("first", [0.0, 0.2])]));
        step(&mut solver, 1.5);
        assert!(solver.bodies()[0].asleep);
        let edit = Edit::new().add_body(cube("second", [0.05, 0.7])).add_body(cube("third", [3.0, 0.2]));
        solver.apply(&edit).expect("the bodies fit");
        step(&mut solver, 2.0);
        let heights: Vec<f64> = solver.bodies().iter().map(|body| body.position.y).collect();
        println!("{substeps:?}: {heights:.4?}");
        assert!((heights[1] - 0.6).abs() < 0.005 && (heights[2] - 0.2).abs() < 0.005, "one lies on the other");
        assert!(solver.bodies().iter().all(|body| body.asleep));
        solver.apply(&Edit::new().remove_body(0)).expect("it is there");
        assert!(solver.bodies()[0].removed && !solver.bodies()[1].asleep && solver.bodies()[2].asleep);
        step(&mut solver, 2.0);
        assert!((solver.bodies()[1].position.y - 0.2).abs() < 0.005, "it falls to the floor");
        solver.apply(&Edit::new().add_body(cube("first", [0.0, 1.0]))).expect("the name is free again");
        step(&mut solver, 2.0);
        assert!((solver.bodies()[3].position.y - 0.6).abs() < 0.005 && find(&solver, "first") == 3);
    }
}

#[test]
fn properties_gravity_and_places_change_at_run_time() {
    for substeps in ALL {
        let mut solver = build(&floored(substeps, vec![cube("box", [0.0, 0.2])]));
        step(&mut solver, 1.5);
        solver.apply(&Edit::new().set_gravity(at(3.0, -9.81))).expect("gravity is finite");
        step(&mut solver, 1.0);
        assert!(solver.bodies()[0].velocity.x == 0.0, "friction of 0.5 holds it");
        let smooth = BodyChange { friction: Some(0.1), ..BodyChange::default() };
        solver.apply(&Edit::new().change_body(0, smooth)).expect("it is there");
        step(&mut solver, 1.0);
        let mu = (0.1f64 * 0.5).sqrt();
        let (gained, exact) = (solver.bodies()[0].velocity.x, 3.0 - mu * 9.81);
        println!("{substeps:?}: slides at {gained:.4} m/s after a second, Coulomb says {exact:.4}");
        assert!((gained / exact - 1.0).abs() < 0.03);
        let heavy = BodyChange { mass: Some(1000.0), gravity_factor: Some(0.5), ..BodyChange::default() };
        solver.apply(&Edit::new().change_body(0, heavy).set_gravity(at(0.0, -9.81))).expect("it is there");
        solver.apply(&Edit::new().move_body(0, at(-2.0, 5.0), 0.1)).expect("the place is near");
        let before = solver.bodies()[0].velocity;
        assert_eq!((solver.bodies()[0].position, solver.bodies()[0].angle), (at(-2.0, 5.0), 0.1));
        step(&mut solver, 0.5);
        let fell = solver.bodies()[0].velocity - before;
        assert!((fell.y + 0.5 * 0.5 * 9.81).abs() < 1e-6 && fell.x.abs() < 1e-9 && solver.bodies()[0].mass == 1000.0);
        let before = solver.bodies()[0].velocity;
        let arm = at(0.0, 0.3);
        let point = solver.bodies()[0].position + arm;
        solver.apply(&Edit::new().push_body(0, at(500.0, 0.0), point)).expect("it is dynamic");
        let body = &solver.bodies()[0];
        assert!((body.velocity.x - before.x - 0.5).abs() < 1e-9);
        assert!((body.angular_velocity - arm.perp_dot(at(500.0, 0.0)) / body.inertia).abs() < 1e-9);
    }
}

#[test]
fn joints_come_go_and_turn_faster() {
    for substeps in ALL {
        let mut solver = build(&free(substeps, vec![cube("wheel", [0.0, 0.0])]));
        let hinge = JointDescription::new(JointRule::Hinge, "wheel", [0.0, 0.0]);
        let hinge = JointDescription { motor_speed_deg: Some(90.0), motor_torque: 1e5, ..hinge };
        solver.apply(&Edit::new().add_joint(hinge)).expect("there is a wheel");
        step(&mut solver, 1.0);
        let spin = solver.bodies()[0].angular_velocity;
        assert!((spin - 90f64.to_radians()).abs() < 1e-6 && solver.bodies()[0].position.length() < 1e-6);
        assert!((solver.joints()[0].force.y / (160.0 * 9.81) - 1.0).abs() < 1e-3, "the hinge carries the wheel");
        solver.apply(&Edit::new().set_motor(0, Some(Motor { speed: -1.0, max_torque: 1e5 }))).expect("it has one");
        step(&mut solver, 1.0);
        assert!((solver.bodies()[0].angular_velocity + 1.0).abs() < 1e-6);
        solver.apply(&Edit::new().remove_joint(0)).expect("it is there");
        step(&mut solver, 0.5);
        assert!((solver.bodies()[0].velocity.y + 0.5 * 9.81).abs() < 1e-6, "it falls");
        assert!(solver.joints()[0].removed && solver.apply(&Edit::new().remove_joint(0)).is_err());
    }
}

#[test]
fn a_kinematic_body_begins_its_script_where_and_when_it_is_put() {
    let mut solver = build(&free(Substeps::Auto, vec![cube("other", [9.0, 0.0])]));
    step(&mut solver, 1.0);
    let motion = MotionDescription { velocity: [1.0, 0.5], spin_deg: 30.0, ..MotionDescription::default() };
    let lift = BodyDescription { kind: BodyKind::Kinematic, motion: Some(motion), ..cube("lift", [1.0, 2.0]) };
    solver.apply(&Edit::new().add_body(lift)).expect("it fits");
    assert_eq!((solver.bodies()[1].position, solver.bodies()[1].velocity), (at(1.0, 2.0), at(1.0, 0.5)));
    step(&mut solver, 1.0);
    assert!((solver.bodies()[1].position - at(2.0, 2.5)).length() < 1e-9);
    solver.apply(&Edit::new().move_body(1, at(-5.0, 0.0), 0.0)).expect("it is there");
    step(&mut solver, 1.0);
    assert!((solver.bodies()[1].position - at(-4.0, 0.5)).length() < 1e-9, "the script goes on from there");
}

#[test]
fn what_falls_into_water_floats_and_water_closes_over_what_is_taken_away() {
    let mut solver = build(&pool());
    step(&mut solver, 2.0);
    let count = solver.ids().len();
    let log = BodyDescription { density: 400.0, ..BodyDescription::rectangle([0.5, 0.24], [0.4, 1.6]) };
    solver.apply(&Edit::new().add_body(named("log", log))).expect("it fits");
    let samples = solver.bodies()[1].samples.len();
    assert!(samples > 10 && solver.ids().len() == count + samples);
    step(&mut solver, 4.0);
    let lift = solver.bodies()[1].fluid_force.y / (solver.bodies()[1].mass * 9.81);
    println!("lift over weight {lift:.3}, {} samples", samples);
    assert!((lift - 1.0).abs() < 0.15, "it floats");
    solver.apply(&Edit::new().remove_body(1)).expect("it is there");
    assert_eq!(solver.ids().len(), count);
    step(&mut solver, 2.0);
    assert!(solver.bodies()[1].removed && solver.diagnostics().density_error_mean < 0.05);
    let more = Edit::new().add_block("water", at(0.4, 1.4), at(1.2, 2.0), solver.spacing());
    let added = solver.apply(&more).expect("it fits");
    assert_eq!(added.len(), 80);
    step(&mut solver, 1.0);
}

/// A short rope far away.
fn bead_rope() -> Rope {
    Rope {
        material: "bead".into(),
        from: [5.0, 3.0],
        to: [5.2, 3.0],
        length: None,
        compliance: 0.0,
        held: Default::default(),
        link: Default::default(),
        tethers: Default::default(),
        body: None,
        from_body: None,
    }
}

/// Steps both, and sees that they go the same way bit for bit.
fn go_on(one: &mut Solver, other: &mut Solver, frames: u32) {
    for _ in 0..frames {
        assert_eq!(one.step_frame(), other.step_frame());
        assert_eq!(one.state_hash(), other.state_hash());
    }
    assert_eq!(one.bodies(), other.bodies());
    assert_eq!(one.joints(), other.joints());
}

fn restored(scene: &Scene, state: &State) -> Solver {
    let mut solver = build(scene);
    solver.restore(state).expect("the state is of this scene");
    solver
}

#[test]
fn a_changed_world_is_saved_and_restored_bit_for_bit() {
    let dry = floored(Substeps::Auto, vec![cube("a", [0.0, 0.2]), cube("b", [0.0, 0.6])]);
    let mut bodiless = floored(Substeps::Fixed(4), Vec::new());
    bodiless.solid = vec![Solid { name: "bead".into(), ..Solid::default() }];
    bodiless.rope = vec![bead_rope()];
    for scene in [dry, bodiless, pool()] {
        let mut solver = build(&scene);
        step(&mut solver, 0.3);
        let early = solver.save();
        let count = solver.bodies().len() as u32;
        let rod = JointDescription::new(JointRule::Rod, "new", [0.9, 1.7]);
        let rod = JointDescription { other: Some("newer".into()), other_at: Some([1.2, 2.2]), ..rod };
        let edit = Edit::new()
            .add_body(cube("new", [0.9, 1.7]))
            .add_body(BodyDescription { kind: BodyKind::Static, ..cube("newer", [1.2, 2.2]) })
            .add_joint(JointDescription { name: "rod".into(), ..rod })
            .set_gravity(at(0.5, -7.0));
        solver.apply(&edit).expect("it fits");
        for round in 0..6 {
            step(&mut solver, 0.1);
            let state = State::from_bytes(&solver.save().to_bytes()).expect("it is whole");
            let mut fresh = restored(&scene, &state);
            go_on(&mut fresh, &mut solver, 3);
            let change = BodyChange { mass: Some(50.0 + f64::from(round)), ..BodyChange::default() };
            let edit = match round {
                0 => Edit::new().change_body(count, change),
                1 => Edit::new().move_body(count + 1, at(1.1, 2.3), 0.2),
                2 => Edit::new().remove_body(count),
                3 => Edit::new().add_body(cube("new", [0.5, 2.0])),
                _ => Edit::new().set_gravity(at(0.0, -9.81)),
            };
            for solver in [&mut solver, &mut fresh] {
                solver.apply(&edit).expect("it fits");
            }
            go_on(&mut fresh, &mut solver, 4);
        }
        // Back to before anything came.
        let mut fresh = restored(&scene, &early);
        solver.restore(&early).expect("it is a state of this run");
        assert_eq!(solver.bodies().len() as u32, count);
        go_on(&mut fresh, &mut solver, 10);
    }
}

#[test]
fn an_edit_of_bodies_applies_wholly_or_not_at_all() {
    let mut scene = pool();
    scene.body.push(BodyDescription { solver: BodySolver::ShapeMatching, ..cube("soft", [0.4, 2.0]) });
    let mut solver = build(&scene);
    step(&mut solver, 0.2);
    let (hash, bodies) = (solver.state_hash(), solver.bodies().to_vec());
    let joint = |body: &str| JointDescription::new(JointRule::Hinge, body, [0.0, 0.0]);
    let good = || Edit::new().set_gravity(at(1.0, 0.0)).add_body(cube("new", [1.5, 2.0])).remove_body(0);
    let bad_change = BodyChange { restitution: Some(1.5), ..BodyChange::default() };
    let cases = [
        (good().add_body(cube("new", [1.0, 2.5])), "already"),
        (good().add_body(cube("other", [f64::NAN, 2.5])), "finite"),
        (good().add_body(BodyDescription { size: None, ..cube("other", [1.0, 2.5]) }), "no shape"),
        (good().add_body(BodyDescription { solver: BodySolver::ShapeMatching, ..cube("x", [1.0, 2.0]) }), "particles"),
        (good().remove_body(0), "taken away"),
        (good().remove_body(7), "no body 7"),
        (good().remove_body(1), "particles"),
        (good().move_body(2, at(1e12, 0.0), 0.0), "farther"),
        (good().change_body(2, bad_change), "restitution"),
        (good().push_body(1, at(1.0, 0.0), at(0.0, 0.0)), "particles"),
        (good().add_joint(joint("nobody")), "no body \"nobody\""),
        (good().add_joint(joint("float")), "no body \"float\""),
        (good().add_joint(JointDescription { compliance: 1.0, ..joint("new") }), "compliance"),
        (good().remove_joint(0), "no joint 0"),
        (good().set_gravity(at(f64::INFINITY, 0.0)), "gravity"),
        (good().remove([999_999]), "no particle"),
    ];
    for (edit, expected) in cases {
        let error = solver.apply(&edit).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error} without {expected}");
        assert!(solver.state_hash() == hash && solver.bodies() == bodies, "nothing has changed");
    }
    solver.apply(&good()).expect("the good part alone is fine");
}
