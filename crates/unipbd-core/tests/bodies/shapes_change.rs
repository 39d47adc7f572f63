//! Bodies get another shape while a run goes on.

use super::common::{ALL, build, floored, free, go_on_after_each, named, step};
use unipbd_core::edit::{BodyChange, Edit};
use unipbd_core::scene::{
    Block, BodyDescription, BodyKind, JointDescription, JointRule, Liquid, MotionDescription, PressureGridUse, Scene,
    Substeps, Tank,
};
use unipbd_core::shapes::Shape;
use unipbd_core::{Solver, Vector64};

fn shape(shape: Shape) -> BodyChange {
    BodyChange { shape: Some(shape), ..BodyChange::default() }
}

fn cube(name: &str, position: [f64; 2]) -> BodyDescription {
    named(name, BodyDescription::rectangle([0.4, 0.4], position))
}

fn triangle(side: f64) -> Shape {
    Shape::Polygon([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|corner| Vector64::from(corner) * side).to_vec())
}

/// Water in a tank, a float and a shelf.
fn pool(pressure_grid: PressureGridUse, sleep: bool) -> Scene {
    let shelf = BodyDescription { kind: BodyKind::Static, ..BodyDescription::rectangle([0.5, 0.4], [1.6, 0.2]) };
    let mut scene = free(Substeps::Auto, vec![cube("float", [0.6, 1.0]), named("shelf", shelf)]);
    (scene.spacing, scene.solver.pressure_grid, scene.solver.sleep) = (0.08, pressure_grid, sleep);
    scene.tank = vec![Tank::new([0.0, 0.0], [2.0, 3.0])];
    scene.liquid = vec![Liquid::new("water", 1000.0)];
    scene.block = vec![Block::new("water", [0.0, 0.0], [2.0, 0.8])];
    scene.body[0].density = 500.0;
    scene
}

#[test]
fn mass_and_inertia_follow_from_density_and_shape() {
    let mut given = cube("given", [4.0, 3.0]);
    given.mass = Some(70.0);
    let mut solver = build(&free(Substeps::Auto, vec![cube("dense", [0.0, 3.0]), given]));
    step(&mut solver, 0.2);
    let before = solver.bodies()[0].clone();
    let edit = Edit::new()
        .change_body(0, shape(Shape::Disc { radius: 0.3 }))
        .change_body(1, BodyChange { mass: Some(80.0), ..shape(triangle(0.6)) });
    solver.apply(&edit).expect("the shapes are sound");
    let [dense, given] = solver.bodies() else { panic!("two bodies") };
    let exact = 1000.0 * std::f64::consts::PI * 0.09;
    assert!((dense.mass / exact - 1.0).abs() < 1e-12 && (dense.inertia / (0.5 * exact * 0.09) - 1.0).abs() < 1e-12);
    assert_eq!((dense.position, dense.velocity, dense.radius), (before.position, before.velocity, 0.3));
    // A right triangle has m (a^2 + b^2)/18 about its centroid.
    assert!(given.mass == 80.0 && (given.inertia / (80.0 * 2.0 * 0.36 / 18.0) - 1.0).abs() < 1e-12);
    let centroid = given.outline.iter().sum::<Vector64>() / 3.0;
    assert!(centroid.length() < 1e-12, "the centre of mass stays");
    step(&mut solver, 0.2);
    let fall = solver.bodies()[1].velocity.y / (0.4 * 9.81);
    assert!((fall + 1.0).abs() < 1e-6, "it falls on: {fall}");
}

#[test]
fn a_body_that_grows_on_the_floor_is_lifted_gently_and_one_that_shrinks_falls() {
    for substeps in ALL {
        let mut solver = build(&floored(substeps, vec![cube("low", [0.0, 0.2]), cube("high", [0.0, 0.6])]));
        step(&mut solver, 1.5);
        assert!(solver.bodies().iter().all(|body| body.asleep));
        solver.apply(&Edit::new().change_body(0, shape(Shape::rectangle(0.8, 0.5)))).expect("it is sound");
        let mut fastest = 0.0_f64;
        for _ in 0..120 {
            step(&mut solver, 1.0 / 60.0);
            fastest = solver.bodies().iter().map(|body| body.velocity.length()).fold(fastest, f64::max);
        }
        let heights: Vec<f64> = solver.bodies().iter().map(|body| body.position.y).collect();
        println!("{substeps:?}: {heights:.4?}, fastest {fastest:.3} m/s");
        assert!((heights[0] - 0.25).abs() < 0.01 && (heights[1] - 0.7).abs() < 0.015 && fastest < 1.5);
        solver.apply(&Edit::new().change_body(0, shape(Shape::rectangle(0.4, 0.2)))).expect("it is sound");
        step(&mut solver, 2.0);
        let heights: Vec<f64> = solver.bodies().iter().map(|body| body.position.y).collect();
        assert!((heights[0] - 0.1).abs() < 0.01 && (heights[1] - 0.4).abs() < 0.015, "{heights:?}");
    }
}

/// Fastest particle of the next seconds [m/s].
fn fastest(solver: &mut Solver, seconds: f64) -> f64 {
    let mut fastest = 0.0_f64;
    for _ in 0..(seconds * 60.0) as u32 {
        step(solver, 1.0 / 60.0);
        fastest = fastest.max(solver.diagnostics().speed_max);
    }
    fastest
}

#[test]
fn a_float_that_grows_displaces_more_water() {
    for grid in [PressureGridUse::On, PressureGridUse::Off] {
        // A body that comes is pushed at as gently, or hard.
        let mut other = build(&pool(grid, false));
        step(&mut other, 2.0);
        let new = BodyDescription { density: 500.0, ..BodyDescription::rectangle([0.32, 0.4], [1.0, 0.6]) };
        other.apply(&Edit::new().add_body(named("new", new))).expect("it fits");
        let bar = fastest(&mut other, 1.0);
        let mut solver = build(&pool(grid, false));
        step(&mut solver, 2.0);
        let before = solver.bodies()[0].samples.len();
        solver.apply(&Edit::new().change_body(0, shape(Shape::rectangle(0.64, 0.4)))).expect("it is sound");
        assert!(solver.bodies()[0].samples.len() > before);
        let samples = solver.phases().iter().filter(|phase| phase.name() == "rigid").count();
        assert_eq!(samples, solver.bodies()[0].samples.len(), "those of the old shape are gone");
        let fastest = fastest(&mut solver, 2.0);
        let mut lift = 0.0;
        for _ in 0..120 {
            step(&mut solver, 1.0 / 60.0);
            lift += solver.bodies()[0].fluid_force.y / (solver.bodies()[0].mass * 9.81) / 120.0;
        }
        let height = solver.bodies()[0].position.y;
        println!(
            "{grid:?}: {height:.3} m high, lift over weight {lift:.3}, fastest {fastest:.2} m/s, {bar:.2} m/s with a new body"
        );
        assert!((lift - 1.0).abs() < 0.1 && fastest < 1.2 * bar + 1.0);
        // A shelf is a wall to the water, by its outline.
        solver.apply(&Edit::new().change_body(1, shape(Shape::Disc { radius: 0.3 }))).expect("it is sound");
        step(&mut solver, 1.0);
        let center = solver.bodies()[1].position;
        let near = |x: &unipbd_core::Vector| (unipbd_core::math::wide(*x) - center).length() < 0.25;
        assert!(!solver.positions().iter().any(near), "no water is in it");
    }
}

#[test]
fn changed_shapes_are_saved_and_restored_bit_for_bit() {
    let motion = MotionDescription { spin_deg: 50.0, velocity: [0.1, 0.0], ..MotionDescription::default() };
    let mut dry = floored(Substeps::Auto, vec![cube("float", [0.0, 0.2]), cube("shelf", [0.0, 0.6])]);
    let turning = BodyDescription { kind: BodyKind::Kinematic, motion: Some(motion), ..cube("turning", [0.9, 0.5]) };
    dry.body.push(turning);
    dry.joint = vec![JointDescription::new(JointRule::Hinge, "shelf", [0.0, 0.8])];
    for scene in [dry, pool(PressureGridUse::On, false), pool(PressureGridUse::Off, true)] {
        let mut solver = build(&scene);
        step(&mut solver, 0.3);
        let edits = [
            Edit::new().change_body(0, shape(triangle(0.7))),
            Edit::new().change_body(1, shape(Shape::Disc { radius: 0.25 })),
            Edit::new().change_body(0, shape(Shape::rectangle(0.5, 0.3))).add_body(cube("new", [1.0, 2.0])),
            Edit::new().change_body(0, shape(triangle(0.6))).remove_body(0),
            Edit::new().change_body(scene.body.len() as u32 - 1, shape(triangle(0.5))),
        ];
        go_on_after_each(&scene, &mut solver, edits);
    }
}

#[test]
fn a_script_goes_on_when_its_body_changes_shape() {
    let motion = MotionDescription { velocity: [0.5, 0.25], ..MotionDescription::default() };
    let lift = BodyDescription { kind: BodyKind::Kinematic, motion: Some(motion), ..cube("lift", [1.0, 2.0]) };
    let mut solver = build(&free(Substeps::Auto, vec![lift]));
    step(&mut solver, 1.0);
    solver.apply(&Edit::new().change_body(0, shape(triangle(0.9)))).expect("it is sound");
    assert!((solver.bodies()[0].position - Vector64::new(1.5, 2.25)).length() < 1e-9);
    step(&mut solver, 1.0);
    assert!((solver.bodies()[0].position - Vector64::new(2.0, 2.5)).length() < 1e-9);
}

#[test]
fn a_faulty_shape_changes_nothing() {
    let mut solver = build(&pool(PressureGridUse::Off, false));
    step(&mut solver, 0.1);
    let (hash, bodies) = (solver.state_hash(), solver.bodies().to_vec());
    let crossed = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(Vector64::from).to_vec();
    let cases = [
        (Shape::Disc { radius: -1.0 }, "radius"),
        (Shape::Disc { radius: f64::NAN }, "radius"),
        (Shape::Disc { radius: 1e7 }, "the new shape cannot be made"),
        (Shape::Polygon(crossed), "cross"),
        (Shape::Polygon(Vec::new()), "corners"),
    ];
    for (new, expected) in cases {
        let good = Edit::new().change_body(1, shape(triangle(0.5)));
        let error = solver.apply(&good.change_body(0, shape(new))).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error} without {expected}");
        assert!(solver.state_hash() == hash && solver.bodies() == bodies, "nothing has changed");
    }
}
