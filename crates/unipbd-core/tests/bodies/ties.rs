//! Ropes with bodies, carried ends, pulleys, soft bodies.

use super::common::{ALL, build, floored, free, named, run, step};
use unipbd_core::edit::Edit;
use unipbd_core::scene::{
    BodyDescription, BodySolver, Held, JointDescription, JointRule, PointMotion, Rope, Scene, Solid, Substeps,
};
use unipbd_core::{Solver, Vector64};

fn rope(from: [f64; 2], to: [f64; 2]) -> Rope {
    Rope {
        material: "cord".into(),
        from,
        to,
        length: None,
        compliance: 0.0,
        held: Held::default(),
        link: Default::default(),
        tethers: Default::default(),
        body: Some("last".into()),
        from_body: None,
    }
}

fn with_rope(scene: Scene, rope: Rope) -> Scene {
    let solid = vec![Solid { name: "cord".into(), ..Solid::default() }];
    Scene { solid, rope: vec![rope], ..scene }
}

fn first_point(solver: &Solver) -> Vector64 {
    let row = (0..solver.ids().len()).find(|&row| solver.ids()[row] == 0).expect("the rope has points");
    solver.positions()[row].as_dvec2()
}

#[test]
fn a_body_follows_the_end_of_its_rope_that_a_script_carries() {
    for substeps in ALL {
        let ball = named("last", BodyDescription::disc(0.1, [0.0, -1.1]));
        let mut solver = build(&with_rope(free(substeps, vec![ball]), rope([0.0, 0.0], [0.0, -1.0])));
        step(&mut solver, 1.0);
        let carry = Edit::new().set_velocities([0], [Vector64::new(2.0, 0.5)]).set_motion([0], PointMotion::Kinematic);
        solver.apply(&carry).expect("the end is held");
        let mut longest = 0.0f64;
        for _ in 0..240 {
            step(&mut solver, 1.0 / 60.0);
            longest = longest.max((solver.bodies()[0].position - first_point(&solver)).length());
        }
        let (end, body) = (first_point(&solver), solver.bodies()[0].position);
        println!("{substeps:?}: end at {end:.3}, body at {body:.3}, never farther than {longest:.4} of 1.1 m");
        assert!((end - Vector64::new(8.0, 2.0)).length() < 0.01, "the script carries the end");
        assert!(longest < 1.1 * 1.02 && (body - end).length() < 1.13);
        // Let go, the rope no longer holds the body.
        solver.apply(&Edit::new().set_motion([0], PointMotion::Free)).expect("the end is let go");
        let before = solver.bodies()[0].velocity;
        step(&mut solver, 0.5);
        let fell = solver.bodies()[0].velocity - before;
        println!("  let go: {fell:.3} m/s gained in 0.5 s");
        assert!((fell.y + 9.81 * 0.5).abs() < 0.05 && fell.x.abs() < 0.05);
    }
}

#[test]
fn a_towed_body_follows_the_one_that_tows() {
    for substeps in ALL {
        let body = |name: &str, x: f64, velocity: f64| {
            let shape = BodyDescription::rectangle([0.4, 0.2], [x, 0.1]);
            named(name, BodyDescription { velocity: [velocity, 0.0], friction: 0.0, ..shape })
        };
        let tow = Rope { from_body: Some("first".into()), ..rope([0.7, 0.1], [0.0, 0.1]) };
        let tow = Rope { to: [0.2, 0.1], length: Some(0.6), ..tow };
        let scene = with_rope(floored(substeps, vec![body("last", 0.0, 0.0), body("first", 0.9, 3.0)]), tow);
        let solver = run(&scene, 2.0);
        let [last, first] = [&solver.bodies()[0], &solver.bodies()[1]];
        let gap = first.position.x - 0.2 - last.position.x - 0.2;
        println!("{substeps:?}: both move at {:.4} and {:.4} m/s, {gap:.4} m apart", last.velocity.x, first.velocity.x);
        assert!((last.velocity.x - 1.5).abs() < 0.015 && (first.velocity.x - 1.5).abs() < 0.015, "momentum is shared");
        assert!((gap - 0.6).abs() < 0.01);
    }
}

#[test]
fn a_pulley_accelerates_as_atwood_says() {
    for substeps in ALL {
        for (masses, ratio) in [([3.0, 1.0], 1.0), ([1.0, 10.0], 1.0), ([1.0, 3.0], 2.0)] {
            let body = |k: usize| {
                let ball = BodyDescription::disc(0.1, [2.0 * k as f64, -2.0]);
                named(["a", "b"][k], BodyDescription { mass: Some(masses[k]), ..ball })
            };
            let mut scene = free(substeps, vec![body(0), body(1)]);
            let joint = JointDescription::new(JointRule::Pulley, "a", [0.0, -1.9]);
            scene.joint = vec![JointDescription {
                other: Some("b".into()),
                other_at: Some([2.0, -1.9]),
                wheel: Some([0.0, 0.0]),
                other_wheel: Some([2.0, 0.0]),
                ratio,
                ..joint
            }];
            let solver = run(&scene, 0.5);
            // The second goes 1/ratio as far: m1 a = m1 g - T, m2 a/ratio = ratio T - m2 g.
            let [m1, m2] = masses;
            let exact = 9.81 * (m1 * ratio * ratio - m2 * ratio) / (m1 * ratio * ratio + m2);
            let measured = -solver.bodies()[0].velocity.y / 0.5;
            let other = solver.bodies()[1].velocity.y / 0.5;
            println!("{substeps:?} {masses:?} kg ratio {ratio}: {measured:.4} of {exact:.4} m/s^2");
            assert!((measured / exact - 1.0).abs() < 0.01 && (other * ratio / exact - 1.0).abs() < 0.01);
            let tension = m1 * (9.81 - exact);
            assert!((solver.joints()[0].force.y / tension - 1.0).abs() < 0.01, "the rope's load is read");
        }
    }
}

#[test]
fn a_soft_body_has_the_same_shape_at_every_number_of_substeps() {
    let height = |substeps: u32, compliance: f64| {
        let shape = BodyDescription::rectangle([0.6, 0.6], [0.0, 0.32]);
        let soft = BodyDescription { solver: BodySolver::ShapeMatching, compliance, ..shape };
        let mut solver = build(&floored(Substeps::Fixed(substeps), vec![soft]));
        step(&mut solver, 6.0);
        let frames = 60;
        (0..frames)
            .map(|_| {
                step(&mut solver, 1.0 / 60.0);
                solver.bodies()[0].position.y / f64::from(frames)
            })
            .sum::<f64>()
    };
    let mut worst = 0.0f64;
    for compliance in [0.0, 3e-8, 1e-7, 2e-7, 4e-7, 1e-6] {
        let heights: Vec<f64> = [2, 4, 8, 16, 32].map(|substeps| height(substeps, compliance)).into();
        println!("compliance {compliance:e} m/N: mean height {heights:.4?} m at 2 to 32 substeps");
        let (low, high) = heights.iter().fold((f64::MAX, 0.0f64), |(l, h), &y| (l.min(y), h.max(y)));
        worst = worst.max((high - low) / 0.6);
    }
    assert!(worst < 0.02, "the same shape");
    assert!(height(8, 1e-6) < height(8, 4e-7) && height(8, 4e-7) < height(8, 0.0), "softer is lower");
}
