//! What walls carry, how friction combines, waking, and swings that must not fall asleep.

use super::common::{ALL, build, floored, free, named, run, step};
use unipbd_core::scene::{
    Block, BodyDescription, FrictionRule, HalfPlane, JointDescription, JointRule, Liquid, Substeps, Tank,
};

#[test]
fn a_named_wall_reports_bodies_and_fluids_apart_and_together() {
    for substeps in ALL {
        let mut scene = free(substeps, vec![BodyDescription::rectangle([0.4, 0.4], [0.5, 0.2])]);
        scene.tank = vec![Tank { name: "tank".into(), ..Tank::new([0.0, 0.0], [1.0, 2.0]) }];
        scene.half_plane = vec![HalfPlane { name: "unused".into(), ..HalfPlane::new([0.0, -1.0], [0.0, 1.0]) }];
        let solver = run(&scene, 2.0);
        let bottom = |solver: &unipbd_core::Solver| {
            solver.wall_forces().into_iter().find(|wall| wall.name == "tank bottom").expect("it is measured")
        };
        let dry = bottom(&solver);
        println!("{substeps:?}: the floor carries {:.3} N of 1569.6 N", -dry.contact_force.y);
        assert!((dry.contact_force.y + 160.0 * 9.81).abs() < 1.0 && dry.fluid_force.y == 0.0);
        assert_eq!(dry.force, dry.contact_force);
        assert!(solver.wall_forces()[0].force.length() == 0.0, "nothing touches the other wall");
    }
    let stone = BodyDescription { density: 3000.0, ..BodyDescription::rectangle([0.3, 0.3], [0.5, 0.16]) };
    let mut scene = free(Substeps::Auto, vec![stone]);
    scene.tank = vec![Tank { name: "tank".into(), ..Tank::new([0.0, 0.0], [1.0, 2.0]) }];
    scene.liquid = vec![Liquid { xsph: 0.05, ..Liquid::new("water", 1000.0) }];
    scene.block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.6])];
    let mut solver = build(&scene);
    step(&mut solver, 4.0);
    let (mut fluid, mut contact, mut total) = (0.0, 0.0, 0.0);
    for _ in 0..60 {
        step(&mut solver, 1.0 / 60.0);
        let wall = solver.wall_forces().into_iter().find(|wall| wall.name == "tank bottom").expect("it is measured");
        (fluid, contact) = (fluid - wall.fluid_force.y / 60.0, contact - wall.contact_force.y / 60.0);
        total -= wall.force.y / 60.0;
    }
    let water = solver.phases().iter().filter(|phase| phase.name() == "liquid").count() as f64 * 2.5 * 9.81;
    let all = water + 270.0 * 9.81;
    println!("water {fluid:.0} N, stone {contact:.0} N, both {total:.0} N of {all:.0} N");
    assert!((total / all - 1.0).abs() < 0.02 && (fluid + contact - total).abs() < 1.0 && contact > 500.0);
}

#[test]
fn friction_combines_by_the_rule_of_the_scene() {
    let exact = |rule: FrictionRule| rule.combine(0.2, 0.8);
    for rule in [
        FrictionRule::GeometricMean,
        FrictionRule::Average,
        FrictionRule::Multiply,
        FrictionRule::Minimum,
        FrictionRule::Maximum,
    ] {
        for substeps in ALL {
            let puck = BodyDescription {
                friction: 0.2,
                velocity: [8.0, 0.0],
                ..BodyDescription::rectangle([0.6, 0.2], [0.0, 0.1])
            };
            let mut scene = floored(substeps, vec![puck]);
            scene.half_plane[0].friction = Some(0.8);
            scene.contacts.friction_rule = rule;
            let mut solver = build(&scene);
            step(&mut solver, 0.1);
            let before = solver.bodies()[0].velocity.x;
            step(&mut solver, 0.5);
            let measured = (before - solver.bodies()[0].velocity.x) / (9.81 * 0.5);
            println!("{rule:?} {substeps:?}: coefficient {measured:.4} of {:.4}", exact(rule));
            assert!((measured / exact(rule) - 1.0).abs() < 0.01);
        }
    }
}

#[test]
fn walls_and_bodies_have_the_same_friction_by_default() {
    let puck = BodyDescription { velocity: [3.0, 0.0], ..BodyDescription::rectangle([0.6, 0.2], [0.0, 0.1]) };
    let solver = run(&floored(Substeps::Auto, vec![puck]), 2.0);
    let way = solver.bodies()[0].position.x;
    println!("slides {way:.3} m, v^2/(2 mu g) = {:.3} m", 9.0 / 9.81);
    assert!((way / (9.0 / 9.81) - 1.0).abs() < 0.02 && solver.bodies()[0].velocity.x == 0.0);
}

#[test]
fn a_woken_body_is_awake_with_those_it_slept_with() {
    let stack = (0..3).map(|k| BodyDescription::rectangle([0.4, 0.4], [0.0, 0.2 + 0.4 * f64::from(k)]));
    let apart = BodyDescription::rectangle([0.4, 0.4], [3.0, 0.2]);
    let mut solver = run(&floored(Substeps::Auto, stack.chain([apart]).collect()), 2.0);
    let asleep = |solver: &unipbd_core::Solver| solver.bodies().iter().map(|body| body.asleep).collect::<Vec<_>>();
    assert_eq!(asleep(&solver), [true; 4]);
    assert!(solver.wake_body(1) && !solver.wake_body(9));
    assert_eq!(asleep(&solver), [false, false, false, true]);
    solver.wake();
    assert_eq!(asleep(&solver), [false; 4]);
    step(&mut solver, 2.0);
    assert_eq!(asleep(&solver), [true; 4], "they fall asleep again");
}

#[test]
fn a_swing_never_sleeps_however_small_or_long() {
    for substeps in ALL {
        for (length, amplitude) in [(0.5, 0.3), (0.5, 1e-3), (5.0, 0.05), (50.0, 0.01), (50.0, 1e-3)] {
            let bob = BodyDescription::disc(0.2, [length * f64::sin(amplitude), -length * f64::cos(amplitude)]);
            let mut scene = free(substeps, vec![named("bob", bob)]);
            let rod = JointDescription::new(JointRule::Rod, "bob", scene.body[0].position);
            scene.joint = vec![JointDescription { other_at: Some([0.0, 0.0]), ..rod }];
            let mut solver = build(&scene);
            let (mut slept, mut least) = (false, 0.0f64);
            for _ in 0..60 * 20 {
                step(&mut solver, 1.0 / 60.0);
                slept |= solver.bodies()[0].asleep;
                least = least.min(solver.bodies()[0].position.x);
            }
            println!("{substeps:?} {length} m, {amplitude} rad: swings to {:.4} of that", -least / length / amplitude);
            assert!(!slept && (-least / length / amplitude - 1.0).abs() < 0.02);
        }
    }
}
