use super::world::{FRAME, GRAVITY, World, at, body, unit_box};
use unipbd_core::Vector64;
use unipbd_core::rigid::contact::{DistanceRule, Joint, JointKind, Motor};
use unipbd_core::rigid::{BodySpec, Rotation};
use unipbd_core::rigid::{MassSpec, Surface};
use unipbd_core::shapes::Shape;

fn hinge(motor: Option<Motor>) -> JointKind {
    JointKind::Hinge { motor, limits: None }
}

fn to_world(body: u32, anchor: Vector64, place: Vector64, kind: JointKind) -> Joint {
    Joint { body, other: None, anchor, other_anchor: place, kind }
}

#[test]
fn pendulum_keeps_its_period_and_energy() {
    let mut world = World::new(&[]);
    // A rod of 1 m on a hinge at its upper end: w^2 = (3/2) g / L for small swings.
    let angle = 0.05;
    let rod = Shape::rectangle(0.1, 1.0);
    let pivot = at(0.0, 0.0);
    let place = Vector64::from_angle(angle).rotate(at(0.0, -0.5));
    let mut spec = body(rod, place, Surface::default());
    spec.pose.angle = angle;
    world.add(spec);
    world.contacts.add_joint(to_world(0, at(0.0, 0.5), pivot, hinge(None)), false);
    let (mut crossings, mut last, mut largest) = (Vec::new(), angle, 0.0f64);
    for _ in 0..60 * 60 {
        world.frame();
        let now = world.bodies.pose(0).angle;
        if last > 0.0 && now <= 0.0 {
            crossings.push(world.time - FRAME * now / (now - last));
        }
        if world.time > 55.0 {
            largest = largest.max(now);
        }
        last = now;
    }
    let measured = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    let inertia = 1.0 / 12.0 + 0.01 / 12.0 + 0.25;
    let exact = std::f64::consts::TAU * (inertia / (0.5 * GRAVITY)).sqrt() * (1.0 + angle * angle / 16.0);
    let drift = (world.bodies.pose(0).apply(at(0.0, 0.5)) - pivot).length();
    println!(
        "period {measured:.5} s, exact {exact:.5}; swing after 60 s {:.4} of the first; drift {drift:.1e} m",
        largest / angle
    );
    assert!((measured / exact - 1.0).abs() < 1e-3 && (largest / angle - 1.0).abs() < 0.01 && drift < 1e-5);
}

#[test]
fn motor_turns_a_wheel_at_its_speed_and_stalls_at_its_torque() {
    let mut world = World::new(&[]);
    let place = at(0.0, 3.0);
    world.add(body(Shape::regular(8, 1.0), place, Surface::default()));
    let motor = |max_torque| hinge(Some(Motor { speed: 2.0, max_torque }));
    let joint = world.contacts.add_joint(to_world(0, at(0.0, 0.0), place, motor(500.0)), false);
    world.run(0.5);
    let inertia = world.bodies.views()[0].inertia;
    let spun = world.velocity(0).angular;
    println!("after 0.5 s {spun:.5} rad/s, at full torque {:.5}", 500.0 * 0.5 / inertia);
    assert!((spun - 500.0 * 0.5 / inertia).abs() < 1e-6);
    world.run(10.0);
    assert!((world.velocity(0).angular - 2.0).abs() < 1e-9 && (world.position(0) - place).length() < 1e-6);
    let (_, force, _) = world.contacts.joint_loads().next().expect("one joint");
    assert!((force.y / (world.bodies.views()[0].mass * GRAVITY) - 1.0).abs() < 1e-6, "the hinge carries the wheel");
    world.contacts.set_joint(joint, motor(0.0), &mut world.bodies);
    world.run(1.0);
    assert!((world.velocity(0).angular - 2.0).abs() < 1e-9, "without torque it coasts");
}

#[test]
fn spinning_wheel_on_a_hinge_beside_its_centre_keeps_its_energy() {
    let mut world = World::new(&[]);
    world.gravity = Vector64::ZERO;
    let spin = 12.0;
    let mut spec = unit_box(at(1.0, 0.0));
    spec.velocity = unipbd_core::rigid::Twist { linear: at(0.0, spin), angular: spin };
    world.add(spec);
    world.contacts.add_joint(to_world(0, at(-1.0, 0.0), at(0.0, 0.0), hinge(None)), false);
    world.run(10.0);
    let kept = world.velocity(0).angular / spin;
    let radius = world.position(0).length();
    println!("spin kept {kept:.6}, distance {radius:.6} m");
    assert!((kept - 1.0).abs() < 2e-3 && (radius - 1.0).abs() < 1e-3);
}

#[test]
fn chain_of_hinged_boxes_hangs_without_stretching() {
    let mut world = World::new(&[]);
    for k in 0..8u32 {
        let id = world.add(body(Shape::rectangle(1.0, 0.2), at(0.5 + f64::from(k), 0.0), Surface::default()));
        let (anchor, place) = (at(-0.5, 0.0), at(f64::from(k), 0.0));
        let joint = match id.checked_sub(1) {
            None => to_world(id, anchor, place, hinge(None)),
            Some(last) => Joint { body: id, other: Some(last), anchor, other_anchor: at(0.5, 0.0), kind: hinge(None) },
        };
        world.contacts.add_joint(joint, false);
    }
    let mut stretch = 0.0f64;
    for _ in 0..600 {
        world.frame();
        for id in 1..8 {
            let (here, there) =
                (world.bodies.pose(id).apply(at(-0.5, 0.0)), world.bodies.pose(id - 1).apply(at(0.5, 0.0)));
            stretch = stretch.max((here - there).length());
        }
    }
    println!("chain of 8 falling and swinging: joints open at most {stretch:.1e} m");
    assert!(stretch < 0.05);
}

#[test]
fn spring_stretches_by_its_compliance_and_swings_at_its_frequency() {
    let mut world = World::new(&[]);
    let (mass, compliance) = (100.0, 1e-4);
    let spec = BodySpec { mass: MassSpec::Mass(mass), rotation: Rotation::Locked, ..unit_box(at(0.0, -2.0)) };
    world.add(spec);
    let kind = JointKind::Distance { length: 2.0, compliance, damping: 0.0, rule: DistanceRule::Exact };
    world.contacts.add_joint(to_world(0, at(0.0, 0.0), at(0.0, 0.0), kind), false);
    let (mut sum, mut lowest) = (0.0, 0.0f64);
    for _ in 0..600 {
        world.frame();
        sum += world.position(0).y;
        lowest = lowest.min(world.position(0).y);
    }
    let stretch = -2.0 - sum / 600.0;
    println!("mean stretch {stretch:.5} m, exact {:.5}; lowest {lowest:.5}", mass * GRAVITY * compliance);
    assert!((stretch / (mass * GRAVITY * compliance) - 1.0).abs() < 0.02);
}

#[test]
fn rope_holds_at_its_length_and_is_slack_below() {
    let mut world = World::new(&[]);
    world.add(unit_box(at(0.0, -0.5)));
    let kind = JointKind::Distance { length: 2.0, compliance: 0.0, damping: 0.0, rule: DistanceRule::AtMost };
    world.contacts.add_joint(to_world(0, at(0.0, 0.0), at(0.0, 0.0), kind), false);
    world.run(0.25);
    let fallen = -0.5 - world.position(0).y;
    world.run(3.0);
    println!(
        "slack: fell {fallen:.4} m, free fall {:.4}; taut at {:.6} m",
        0.5 * GRAVITY * 0.0625,
        world.position(0).y
    );
    assert!((fallen / (0.5 * GRAVITY * 0.0625) - 1.0).abs() < 0.02 && (world.position(0).y + 2.0).abs() < 1e-3);
}
