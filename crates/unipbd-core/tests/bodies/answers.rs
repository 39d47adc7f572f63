//! Scenes of bodies whose results follow from a formula, at the solver's own number of substeps and at given ones.

use unipbd_core::rigid::Body;
use unipbd_core::scene::{
    BodyDescription, HalfPlane, JointDescription, JointRule, Obstacle, Scene, SolverSettings, Substeps,
};
use unipbd_core::{BuildOptions, Solver};

const ALL: [Substeps; 4] = [Substeps::Auto, Substeps::Fixed(1), Substeps::Fixed(4), Substeps::Fixed(16)];

fn scene(substeps: Substeps, body: Vec<BodyDescription>, floor: Option<f64>) -> Scene {
    let plane = |friction| HalfPlane { friction: Some(friction), ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) };
    Scene {
        spacing: 0.05,
        gravity: [0.0, -9.81],
        body,
        half_plane: floor.map(plane).into_iter().collect(),
        solver: SolverSettings { substeps, ..SolverSettings::default() },
        ..Scene::default()
    }
}

fn rectangle(size: [f64; 2], position: [f64; 2]) -> BodyDescription {
    BodyDescription::rectangle(size, position)
}

fn disc(radius: f64, position: [f64; 2]) -> BodyDescription {
    BodyDescription { radius: Some(radius), size: None, ..BodyDescription::rectangle([1.0, 1.0], position) }
}

fn run(scene: &Scene, seconds: f64) -> Solver {
    let mut solver = build(scene);
    step(&mut solver, seconds);
    solver
}

fn build(scene: &Scene) -> Solver {
    scene.build(BuildOptions { threads: Some(1), ..BuildOptions::default() }).expect("the scene is sound")
}

fn step(solver: &mut Solver, seconds: f64) {
    for _ in 0..(seconds * 60.0).round() as u32 {
        solver.step_frame().expect("no body diverges");
    }
}

fn energy(bodies: &[Body], gravity: f64) -> f64 {
    let of = |b: &Body| {
        let turning = 0.5 * b.inertia * b.angular_velocity * b.angular_velocity;
        0.5 * b.mass * b.velocity.length_squared() + turning + b.mass * gravity * b.position.y
    };
    bodies.iter().map(of).sum()
}

#[test]
fn an_oblique_bounce_has_the_friction_of_its_rebound() {
    for substeps in ALL {
        for (friction, restitution, start) in
            [(0.2, 0.8, 0.5035), (0.2, 0.8, 0.55), (0.1, 0.5, 0.507), (0.2, 0.0, 0.51)]
        {
            let ball = BodyDescription { friction, restitution, velocity: [5.0, -4.0], ..disc(0.2, [0.0, start]) };
            let mut scene = scene(substeps, vec![ball], Some(friction));
            scene.gravity = [0.0, 0.0];
            let solver = run(&scene, 0.5);
            let body = &solver.bodies()[0];
            let exact = friction * (1.0 + restitution) * 4.0;
            let change = 5.0 - body.velocity.x;
            println!("{substeps:?} mu {friction} e {restitution} from {start} m: {change:.4} m/s, exact {exact:.4}");
            assert!((change / exact - 1.0).abs() < 0.01, "change of the tangential speed");
            assert!((body.velocity.y - 4.0 * restitution).abs() < 0.01);
            assert!((body.angular_velocity * 0.2 + 2.0 * exact).abs() < 0.02 * exact, "I w = r J");
        }
    }
}

#[test]
fn elastic_bodies_keep_their_energy() {
    for substeps in ALL {
        let ball = BodyDescription { restitution: 1.0, ..disc(0.1, [0.0, 1.1]) };
        let mut solver = build(&scene(substeps, vec![ball], Some(0.0)));
        step(&mut solver, 10.0);
        let mut top = 0.0f64;
        for _ in 0..60 {
            step(&mut solver, 1.0 / 60.0);
            top = top.max(solver.bodies()[0].position.y - 0.1);
        }
        println!("{substeps:?}: an elastic ball reaches {top:.4} m of 1 m after 10 s");
        assert!((top - 1.0).abs() < 0.01);
    }
}

#[test]
fn elastic_boxes_without_gravity_keep_their_energy() {
    let boxes = (0..25).map(|k| {
        let (x, y) = (f64::from(k % 5), f64::from(k / 5));
        BodyDescription {
            restitution: 1.0,
            friction: 0.0,
            velocity: [(7.0 * x + 3.0 * y).sin(), (3.0 * x - 5.0 * y).cos()],
            spin_deg: 60.0 * (x + 2.0 * y).sin(),
            ..rectangle([0.4, 0.4], [0.8 * x, 0.8 * y])
        }
    });
    let mut scene = scene(Substeps::Auto, boxes.collect(), None);
    scene.gravity = [0.0, 0.0];
    let mut solver = build(&scene);
    let before = energy(solver.bodies(), 0.0);
    step(&mut solver, 20.0);
    let kept = energy(solver.bodies(), 0.0) / before;
    println!("25 elastic boxes keep {kept:.4} of their energy in 20 s");
    assert!((kept - 1.0).abs() < 0.01);
}

fn tiles(width: f64, depth: f64) -> Vec<Obstacle> {
    let count = (15.0 / width) as i32;
    let tile = |k: i32| {
        // Every second one is thicker: their sides are covered in part.
        let low = if k % 2 == 0 { -depth } else { -2.0 * depth };
        Obstacle::new([f64::from(k) * width - 1.0, low], [f64::from(k + 1) * width - 1.0, 0.0])
    };
    (0..count).map(tile).collect()
}

#[test]
fn a_smooth_body_slides_over_flush_solids() {
    for substeps in ALL {
        for (width, shape) in [(0.5, 0), (0.5, 1), (0.5, 2), (0.13, 0), (0.7, 1)] {
            let body = match shape {
                0 => rectangle([0.4, 0.4], [0.0, 0.2]),
                1 => {
                    let outline = Some(vec![[-0.3, -0.2], [0.3, -0.2], [0.0, 0.4]]);
                    BodyDescription { outline, size: None, ..rectangle([1.0, 1.0], [0.0, 0.2]) }
                }
                _ => disc(0.2, [0.0, 0.2]),
            };
            let body = BodyDescription { friction: 0.0, velocity: [3.0, 0.0], ..body };
            let mut walls = scene(substeps, vec![body.clone()], None);
            walls.obstacle = tiles(width, 0.5);
            let mut statics = scene(substeps, vec![body], None);
            statics.body.extend(tiles(width, 0.5).iter().map(|tile| {
                let size = [tile.max[0] - tile.min[0], tile.max[1] - tile.min[1]];
                let middle = [0.5 * (tile.max[0] + tile.min[0]), 0.5 * (tile.max[1] + tile.min[1])];
                BodyDescription { kind: unipbd_core::scene::BodyKind::Static, ..rectangle(size, middle) }
            }));
            for (name, scene) in [("obstacles", walls), ("static bodies", statics)] {
                let solver = run(&scene, 4.0);
                let body = &solver.bodies()[0];
                println!("{substeps:?} shape {shape} on {name} of {width} m: x {:.4}", body.position.x);
                assert!((body.position.x - 12.0).abs() < 0.12 && body.angle.abs() < 0.01);
            }
        }
    }
}

#[test]
fn a_box_on_a_slope_tips_where_its_diagonal_says() {
    for substeps in ALL {
        for (size, spacing) in [([0.2, 0.6], 0.05), ([0.2, 0.6], 0.1), ([0.5, 0.5], 0.05)] {
            let tips = |part: f64| {
                let body = BodyDescription { friction: 2.0, ..rectangle(size, [0.0, 0.5 * size[1]]) };
                let mut scene = scene(substeps, vec![body], Some(2.0));
                let slope = (part * size[0] / size[1]).atan();
                scene.gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
                scene.spacing = spacing;
                run(&scene, 5.0).bodies()[0].angle.abs() > 0.1
            };
            // One substep leaves more motion at the start.
            let near = if substeps == Substeps::Fixed(1) { 0.03 } else { 0.01 };
            let (stands, falls) = (!tips(1.0 - near), tips(1.0 + near));
            println!("{substeps:?}: {size:?} m, spacing {spacing} m: stands below {stands}, falls above b/h {falls}");
            assert!(stands && falls);
        }
    }
}

#[test]
fn heavy_bodies_stand_on_light_ones() {
    for (masses, size) in [
        (vec![1.0, 100.0], 0.5),
        (vec![1.0, 100.0], 0.1),
        (vec![1.0, 1000.0], 0.5),
        (vec![1.0, 10.0, 100.0, 1000.0], 0.5),
        (vec![1.0, 1.0, 1.0, 50.0], 0.3),
    ] {
        let body = |(k, &mass): (usize, &f64)| {
            let position = [0.0, size * (k as f64 + 0.5)];
            BodyDescription { mass: Some(mass), ..rectangle([size, size], position) }
        };
        let scene = scene(Substeps::Auto, masses.iter().enumerate().map(body).collect(), Some(0.5));
        let mut solver = build(&scene);
        let (mut worst, mut most) = (0.0f64, 0);
        for _ in 0..300 {
            most = most.max(solver.step_frame().expect("no body diverges").substeps);
            worst = worst.max(solver.diagnostics().contact_penetration / size);
        }
        let top = &solver.bodies()[masses.len() - 1].position;
        let sunk = size * (masses.len() as f64 - 0.5) - top.y;
        println!("{masses:?} kg of {size} m: overlap {worst:.1e} of a body, {sunk:.1e} m at the end, {most} substeps");
        assert!(worst < 0.01 && sunk < 0.01 * size && top.x.abs() < 0.01 * size);
    }
}

#[test]
fn a_light_chain_carries_a_heavy_body() {
    let link = |k: usize| BodyDescription {
        name: format!("{k}"),
        mass: Some(if k == 9 { 100.0 } else { 1.0 }),
        ..rectangle([0.1, 0.5], [0.0, -0.25 - 0.5 * k as f64])
    };
    let hinge = |k: usize| JointDescription {
        other: k.checked_sub(1).map(|above| above.to_string()),
        ..JointDescription::new(JointRule::Hinge, &k.to_string(), [0.0, -0.5 * k as f64])
    };
    let mut scene = scene(Substeps::Auto, (0..10).map(link).collect(), None);
    scene.joint = (0..10).map(hinge).collect();
    let mut solver = build(&scene);
    let mut worst = 0.0f64;
    for _ in 0..300 {
        solver.step_frame().expect("no body diverges");
        worst = worst.max((solver.bodies()[9].position.y + 4.75).abs() / 5.0);
    }
    println!("a chain of 5 m stretches by {:.3} %", 100.0 * worst);
    assert!(worst < 0.01);
}

#[test]
fn fast_and_spinning_bodies_get_substeps() {
    let first = |velocity: [f64; 2], spin_deg: f64| {
        let body = BodyDescription { velocity, spin_deg, ..rectangle([0.2, 0.2], [0.0, 1.0]) };
        let report = build(&scene(Substeps::Auto, vec![body], Some(0.5))).step_frame();
        let substeps = report.expect("no body diverges").substeps;
        println!("{velocity:?} m/s, {spin_deg} deg/s: {substeps} substeps");
        substeps
    };
    assert_eq!(first([0.0, 0.0], 0.0), 2);
    assert!(first([300.0, 0.0], 0.0) >= 40 && first([0.0, 0.0], 5730.0) >= 6);
}

#[test]
fn nothing_in_motion_sleeps() {
    for substeps in ALL {
        let drifting = BodyDescription { velocity: [0.04, 0.0], ..disc(0.2, [0.0, 0.0]) };
        let mut free = scene(substeps, vec![drifting], None);
        free.gravity = [0.0, 0.0];
        let gone = run(&free, 10.0).bodies()[0].position.x;

        let puck = BodyDescription { velocity: [0.03, 0.0], friction: 0.0, ..rectangle([0.4, 0.2], [0.0, 0.1]) };
        let slid = run(&scene(substeps, vec![puck], Some(0.0)), 10.0).bodies()[0].position.x;

        let arm = BodyDescription { name: "arm".into(), ..rectangle([1.0, 0.1], [0.5, 0.0]) };
        let mut crane = scene(substeps, vec![arm.clone()], None);
        let motor = JointDescription::new(JointRule::Hinge, "arm", [0.0, 0.0]);
        crane.joint = vec![JointDescription { motor_speed_deg: Some(2.0), motor_torque: 1e6, ..motor }];
        let turned = run(&crane, 20.0).bodies()[0].angle.to_degrees();

        let rod = BodyDescription { size: Some([0.1, 1.0]), angle_deg: 0.0115, position: [-1e-4, 0.5], ..arm };
        let mut upright = scene(substeps, vec![rod], None);
        upright.joint = vec![JointDescription::new(JointRule::Hinge, "arm", [0.0, 0.0])];
        let fell = run(&upright, 5.0).bodies()[0].angle.to_degrees();
        println!("{substeps:?}: drift {gone:.4} m, puck {slid:.4} m, motor {turned:.3} deg, rod {fell:.1} deg");
        assert!((gone - 0.4).abs() < 0.01 && (slid - 0.3).abs() < 0.01 && (turned - 40.0).abs() < 1.0);
        assert!(fell > 90.0, "a rod 2e-4 rad off upright falls");
    }
}

#[test]
fn bodies_at_rest_sleep_if_they_may() {
    let stack = (0..4).map(|k| rectangle([0.4, 0.4], [0.0, 0.2 + 0.4 * f64::from(k)])).collect();
    let mut sleeping = scene(Substeps::Auto, stack, Some(0.5));
    let solver = run(&sleeping, 2.0);
    assert!(solver.bodies().iter().all(|body| body.asleep));
    sleeping.contacts.sleep = false;
    assert!(run(&sleeping, 2.0).bodies().iter().all(|body| !body.asleep));
}

#[test]
fn dropped_boxes_come_to_rest() {
    for substeps in [Substeps::Auto, Substeps::Fixed(2), Substeps::Fixed(4), Substeps::Fixed(16)] {
        for angle_deg in [15.0, 5.0] {
            let body = |k: i32| BodyDescription { angle_deg, ..rectangle([0.3, 0.2], [0.0, 0.5 + 0.5 * f64::from(k)]) };
            let solver = run(&scene(substeps, (0..4).map(body).collect(), Some(0.5)), 20.0);
            let fastest = solver.bodies().iter().map(|body| body.velocity.length()).fold(0.0, f64::max);
            println!("{substeps:?}: 4 boxes dropped at {angle_deg} degrees move at {fastest:.1e} m/s after 20 s");
            assert!(fastest < 0.01);
        }
    }
}

#[test]
fn bodies_tied_by_a_slack_rope_collide() {
    for substeps in ALL {
        let body = |name: &str, y: f64| BodyDescription { name: name.into(), ..rectangle([0.4, 0.4], [0.0, y]) };
        let mut scene = scene(substeps, vec![body("a", 0.2), body("b", 1.0)], Some(0.5));
        let rope = JointDescription::new(JointRule::Rope, "a", [0.2, 0.2]);
        let rope = JointDescription { other: Some("b".into()), other_at: Some([0.2, 1.0]), length: Some(2.0), ..rope };
        scene.joint = vec![rope.clone()];
        let tied = run(&scene, 3.0).bodies()[1].position.y;
        scene.joint = vec![JointDescription { collide_connected: Some(false), ..rope }];
        let through = run(&scene, 3.0).bodies()[1].position.y;
        println!("{substeps:?}: rests at {tied:.4} m, without collision at {through:.4} m");
        assert!((tied - 0.6).abs() < 0.01 && (through - 0.2).abs() < 0.01);
    }
}

#[test]
fn a_conveyor_carries_a_body_at_its_speed() {
    for substeps in ALL {
        let mut on_plane = scene(substeps, vec![rectangle([0.4, 0.4], [0.0, 0.2])], Some(0.5));
        on_plane.half_plane[0].velocity = [1.5, 0.0];
        let carried = run(&on_plane, 3.0).bodies()[0].velocity.x;
        let kind = unipbd_core::scene::BodyKind::Static;
        let belt = BodyDescription { kind, surface_speed: -1.5, ..rectangle([20.0, 0.4], [0.0, -0.2]) };
        let on_body = scene(substeps, vec![rectangle([0.4, 0.4], [0.0, 0.2]), belt], None);
        let by_body = run(&on_body, 3.0).bodies()[0].velocity.x;
        println!("{substeps:?}: carried at {carried:.4} and {by_body:.4} of 1.5 m/s");
        assert!((carried - 1.5).abs() < 1e-3 && (by_body - 1.5).abs() < 1e-3);
    }
}

#[test]
fn sleeping_bodies_load_their_support() {
    let kind = unipbd_core::scene::BodyKind::Static;
    let table = BodyDescription { kind, ..rectangle([2.0, 0.2], [0.0, -0.1]) };
    let scene = scene(Substeps::Auto, vec![rectangle([0.4, 0.4], [0.0, 0.2]), table], None);
    let mut solver = build(&scene);
    for seconds in [0.3, 2.0] {
        step(&mut solver, seconds);
        let (asleep, load) = (solver.bodies()[0].asleep, solver.bodies()[1].contact_force);
        println!("asleep {asleep}: the table carries {:.3} N", -load.y);
        assert!((load.y + 160.0 * 9.81).abs() < 1.0);
    }
    assert!(solver.bodies()[0].asleep);
}
