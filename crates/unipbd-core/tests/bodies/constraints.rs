//! Joints beyond hinges: limits, welds, sliders, spring-dampers, breaking; damping, filters, groups, sensors.

use super::common::{ALL, build, floored, free, named, run, step};
use unipbd_core::scene::{BodyDescription, BodyKind, JointDescription, JointRule, Scene, Substeps};

fn arm(name: &str, position: [f64; 2]) -> BodyDescription {
    named(name, BodyDescription::rectangle([1.0, 0.1], position))
}

fn joined(scene: Scene, joint: JointDescription) -> Scene {
    Scene { joint: vec![joint], ..scene }
}

#[test]
fn a_hinge_stops_at_its_limits() {
    for substeps in ALL {
        let hinge = JointDescription::new(JointRule::Hinge, "arm", [0.0, 0.0]);
        let hinge = JointDescription { limits_deg: Some([-30.0, 20.0]), ..hinge };
        let mut solver = build(&joined(free(substeps, vec![arm("arm", [0.5, 0.0])]), hinge));
        let (mut lowest, mut apart) = (0.0f64, 0.0f64);
        for _ in 0..180 {
            step(&mut solver, 1.0 / 60.0);
            let body = &solver.bodies()[0];
            lowest = lowest.min(body.angle.to_degrees());
            let end = body.position - unipbd_core::Vector64::from_angle(body.angle) * 0.5;
            apart = apart.max(end.length());
        }
        let body = &solver.bodies()[0];
        let (torque, exact) = (solver.joints()[0].torque, body.mass * 9.81 * 0.5 * 30f64.to_radians().cos());
        println!("{substeps:?}: lowest {lowest:.3} deg, apart {apart:.1e} m, torque {torque:.2} of {exact:.2} N m");
        assert!((lowest + 30.0).abs() < 0.1 && (body.angle.to_degrees() + 30.0).abs() < 0.1 && apart < 2e-3);
        assert!((torque / exact - 1.0).abs() < 0.01 && body.velocity.length() < 1e-6);
    }
}

#[test]
fn a_weld_holds_a_cantilever() {
    for substeps in ALL {
        let weld = JointDescription::new(JointRule::Weld, "arm", [0.0, 0.0]);
        let solver = run(&joined(free(substeps, vec![arm("arm", [0.5, 0.0])]), weld), 3.0);
        let (body, joint) = (&solver.bodies()[0], &solver.joints()[0]);
        let weight = body.mass * 9.81;
        println!("{substeps:?}: sags {:.1e} rad; {:.2} N, {:.2} N m", body.angle, joint.force.y, joint.torque);
        assert!(body.angle.abs() < 1e-6 && (body.position.x - 0.5).abs() < 1e-6 && body.position.y.abs() < 1e-6);
        assert!((joint.force.y / weight - 1.0).abs() < 1e-3 && (joint.torque / (0.5 * weight) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn welded_bodies_fall_as_one() {
    for substeps in ALL {
        let pair = vec![arm("a", [0.0, 3.0]), arm("b", [1.0, 3.0])];
        let weld = JointDescription::new(JointRule::Weld, "a", [0.5, 3.0]);
        let weld = JointDescription { other: Some("b".into()), ..weld };
        let mut scene = joined(free(substeps, pair), weld);
        scene.body[0].velocity = [0.0, 2.0];
        let solver = run(&scene, 1.0);
        let [a, b] = [&solver.bodies()[0], &solver.bodies()[1]];
        let turned = unipbd_core::Vector64::from_angle(a.angle);
        let apart = (b.position - a.position - turned).length();
        println!("{substeps:?}: turned {:.3} rad, angles {:.1e} apart, {apart:.1e} m", a.angle, a.angle - b.angle);
        assert!((a.angle - b.angle).abs() < 2e-3 && apart < 5e-3);
        // One rod of 2 m: w = (m v / 2) / ((2 m) 4 / 12) with v = 2 m/s; momentum is kept.
        assert!(((a.velocity.y + b.velocity.y) / 2.0 - (1.0 - 9.81)).abs() < 1e-6);
        let inertia = 2.0 * (a.inertia + a.mass * 0.25);
        let exact = -0.5 * a.mass * 2.0 / inertia;
        assert!((a.angular_velocity / exact - 1.0).abs() < 0.01, "{} of {exact} rad/s", a.angular_velocity);
    }
}

#[test]
fn a_slider_moves_along_its_axis_alone() {
    for substeps in ALL {
        let slope = 30f64.to_radians();
        let slider = JointDescription::new(JointRule::Slider, "box", [0.0, 0.0]);
        let slider = JointDescription { axis: Some([slope.cos(), slope.sin()]), limits: Some([-2.0, 1.0]), ..slider };
        let body = named("box", BodyDescription::rectangle([0.4, 0.2], [0.1, 0.05]));
        let mut solver = build(&joined(free(substeps, vec![body]), slider));
        step(&mut solver, 0.5);
        let start = unipbd_core::Vector64::new(0.1, 0.05);
        let axis = unipbd_core::Vector64::from_angle(slope);
        let body = &solver.bodies()[0];
        let (way, off) = ((body.position - start).dot(axis), (body.position - start).perp_dot(axis));
        let speed = body.velocity.dot(axis);
        println!("{substeps:?}: slides {way:.4} m at {speed:.4} m/s, {off:.1e} m off the axis");
        assert!((speed / (-9.81 * 0.5 * 0.5) - 1.0).abs() < 1e-3 && off.abs() < 1e-6 && body.angle.abs() < 1e-9);
        step(&mut solver, 2.0);
        let body = &solver.bodies()[0];
        let way = (body.position - start).dot(axis);
        assert!((way + 2.0).abs() < 1e-3 && body.velocity.length() < 1e-6, "it rests at its limit: {way}");
    }
}

#[test]
fn a_slider_motor_lifts_at_its_speed_and_yields_at_its_force() {
    for substeps in ALL {
        let lifting = |force: f64| {
            let slider = JointDescription::new(JointRule::Slider, "box", [0.0, 0.0]);
            let slider =
                JointDescription { axis: Some([0.0, 1.0]), motor_speed: Some(0.5), motor_force: force, ..slider };
            let body = named("box", BodyDescription { mass: Some(10.0), ..BodyDescription::disc(0.2, [0.0, 0.0]) });
            run(&joined(free(substeps, vec![body]), slider), 1.0)
        };
        let (strong, weak) = (lifting(200.0), lifting(50.0));
        let (up, down) = (strong.bodies()[0].velocity.y, weak.bodies()[0].velocity.y);
        println!("{substeps:?}: {up:.4} m/s with 200 N, {down:.4} m/s with 50 N");
        assert!((up - 0.5).abs() < 1e-6 && (strong.joints()[0].force.y / 98.1 - 1.0).abs() < 1e-3);
        assert!((down - (50.0 / 10.0 - 9.81)).abs() < 1e-3);
    }
}

#[test]
fn a_spring_damper_comes_to_rest_where_it_should() {
    for substeps in [Substeps::Auto, Substeps::Fixed(4), Substeps::Fixed(16)] {
        // k = 1000 N/m, m = 10 kg: w = 10 /s; critical damping 2 m w = 200 N s/m, here a fifth.
        let spring = JointDescription::new(JointRule::Rod, "bob", [0.0, -1.0]);
        let spring = JointDescription { other_at: Some([0.0, 0.0]), compliance: 1e-3, damping: 40.0, ..spring };
        let bob = BodyDescription { mass: Some(10.0), ..BodyDescription::disc(0.1, [0.0, -1.0]) };
        let mut solver = build(&joined(free(substeps, vec![named("bob", bob)]), spring));
        let mut lowest = 0.0f64;
        for _ in 0..300 {
            step(&mut solver, 1.0 / 60.0);
            lowest = lowest.min(solver.bodies()[0].position.y);
        }
        let rest = -1.0 - 98.1e-3;
        let zeta = 0.2f64;
        let overshoot = (-std::f64::consts::PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        let exact = rest - 98.1e-3 * overshoot;
        let now = solver.bodies()[0].position.y;
        println!("{substeps:?}: rests at {now:.5} of {rest:.5} m, lowest {lowest:.5} of {exact:.5} m");
        assert!((now - rest).abs() < 1e-5);
        if substeps == Substeps::Fixed(16) {
            assert!(((lowest - rest) / (exact - rest) - 1.0).abs() < 0.1, "the overshoot of its damping");
        }
    }
}

#[test]
fn an_overloaded_joint_breaks_and_says_so() {
    for substeps in ALL {
        for (strength, breaks) in [(1500.0, true), (1700.0, false)] {
            let rod = JointDescription::new(JointRule::Rod, "box", [0.0, 0.2]);
            let rod = JointDescription {
                name: "hook".into(),
                other_at: Some([0.0, 1.0]),
                break_force: Some(strength),
                ..rod
            };
            let body = named("box", BodyDescription::rectangle([0.4, 0.4], [0.0, 0.0]));
            let mut solver = build(&joined(free(substeps, vec![body]), rod));
            step(&mut solver, 0.5);
            let events = solver.take_events();
            println!("{substeps:?}: 1570 N on {strength} N: broken {}, {events:?}", solver.joints()[0].broken);
            assert_eq!(solver.joints()[0].broken, breaks);
            assert_eq!(events.iter().any(|event| event.message.contains("\"hook\"")), breaks);
            assert_eq!(solver.bodies()[0].velocity.y < -4.0, breaks);
        }
    }
}

#[test]
fn damped_bodies_slow_down_and_fall_at_their_terminal_speed() {
    for substeps in ALL {
        let body = BodyDescription {
            linear_damping: 2.0,
            angular_damping: 3.0,
            velocity: [5.0, 0.0],
            spin_deg: 100.0,
            ..BodyDescription::disc(0.2, [0.0, 0.0])
        };
        let solver = run(&free(substeps, vec![body]), 1.0);
        let body = &solver.bodies()[0];
        let fell = -9.81 / 2.0 * (1.0 - (-2.0f64).exp());
        println!("{substeps:?}: {:.6} m/s, {:.6} rad/s", body.velocity, body.angular_velocity);
        assert!((body.velocity.x / (5.0 * (-2.0f64).exp()) - 1.0).abs() < 1e-6);
        assert!((body.velocity.y / fell - 1.0).abs() < 1e-6);
        assert!((body.angular_velocity / (100f64.to_radians() * (-3.0f64).exp()) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn groups_override_layers_and_sensors_push_nothing() {
    for substeps in ALL {
        let body = |group: i32, layer: u8, position: [f64; 2]| BodyDescription {
            collision_group: group,
            layers: vec![layer],
            collides_with: Some(vec![0, layer]),
            ..BodyDescription::rectangle([0.4, 0.4], position)
        };
        let pairs = vec![
            body(-1, 0, [0.0, 0.2]),
            body(-1, 0, [0.0, 0.7]),
            body(2, 3, [2.0, 0.2]),
            body(2, 4, [2.0, 0.7]),
            body(0, 3, [4.0, 0.2]),
            body(0, 4, [4.0, 0.7]),
        ];
        let mut scene = floored(substeps, pairs);
        let gate = BodyDescription {
            sensor: true,
            kind: BodyKind::Static,
            ..BodyDescription::rectangle([1.0, 0.4], [0.0, 0.3])
        };
        scene.body.push(gate);
        let solver = run(&scene, 2.0);
        let heights: Vec<f64> = solver.bodies().iter().map(|body| body.position.y).collect();
        println!("{substeps:?}: {heights:.3?}");
        assert!((heights[1] - 0.2).abs() < 0.01, "one group below 0: through each other, and through the sensor");
        assert!((heights[3] - 0.6).abs() < 0.01, "one group above 0: on each other");
        assert!((heights[5] - 0.2).abs() < 0.01, "no group: the layers decide");
    }
}
