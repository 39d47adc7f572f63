//! Options of the contacts: iterations, and those of Macklin et al. 2014: averaged Jacobi with friction of positions,
//! and mass scaling.

use super::world::{FRAME, GRAVITY, World, at, body, floor, never_asleep, unit_box};
use unipbd_core::Vector64;
use unipbd_core::legacy;
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::contact::ContactSettings;
use unipbd_core::rigid::{BodySpec, Pose, Surface, Twist};
use unipbd_core::scene::LegacySettings;
use unipbd_core::shapes::Shape;

/// A world whose contacts are solved as the options for comparison say.
fn legacy_world(walls: &[Wall], options: &LegacySettings) -> World {
    World { contacts: legacy::contacts(walls, never_asleep(), options), ..World::new(walls) }
}

/// A floor under a stack.
fn ground() -> [Wall; 1] {
    [floor(Surface::with_friction(0.5))]
}

fn averaged(relaxation: f64) -> LegacySettings {
    LegacySettings { averaged_contacts: Some(relaxation), ..LegacySettings::default() }
}

fn scaled(mass_scaling: f64) -> LegacySettings {
    LegacySettings { mass_scaling, ..LegacySettings::default() }
}

/// Distance that a box goes down a slope in two seconds, after half a second, and its acceleration.
fn slide(tangent: f64, mu: f64, relaxation: f64) -> (f64, f64) {
    let angle = -tangent.atan();
    let normal = Vector64::from_angle(angle).perp();
    let surface = Surface::with_friction(mu);
    let plane = Wall::half_plane(Vector64::ZERO, normal, surface);
    let mut world = legacy_world(&[plane], &averaged(relaxation));
    let pose = Pose { position: normal * 0.5, angle };
    world.add(BodySpec { pose, ..body(Shape::rectangle(1.0, 1.0), Vector64::ZERO, surface) });
    world.run(0.5);
    let (place, speed) = (world.position(0), world.velocity(0).linear.length());
    world.run(2.0);
    ((world.position(0) - place).length(), (world.velocity(0).linear.length() - speed) / 2.0)
}

#[test]
fn averaged_contacts_let_a_box_slide_iff_the_slope_exceeds_the_friction_angle() {
    for relaxation in [1.0, 1.5, 2.0] {
        for mu in [0.2, 0.5, 0.7] {
            let (crept, _) = slide(0.98 * mu, mu, relaxation);
            let (slid, acceleration) = slide(1.1 * mu, mu, relaxation);
            let exact = GRAVITY * (1.1 * mu - mu) * (1.1 * mu).atan().cos();
            println!(
                "omega {relaxation}, mu {mu}: crept {crept:.1e} m, slid {slid:.3} m, {acceleration:.4} of {exact:.4} m/s^2"
            );
            // Friction of positions creeps by millimetres per second where it sticks.
            assert!(crept < 0.03 && slid > 0.1 && (acceleration / exact - 1.0).abs() < 0.01);
        }
    }
}

#[test]
fn averaged_contacts_keep_linear_and_angular_momentum() {
    let mut world = legacy_world(&[], &averaged(1.5));
    world.gravity = Vector64::ZERO;
    for k in 0..30 {
        let k = f64::from(k);
        let place = at((k * 2.4).cos(), (k * 2.4).sin()) * (1.0 + 0.5 * k.sqrt() * 1.6);
        let velocity = Twist { linear: -place, angular: (k * 1.3).sin() * 3.0 };
        world.add(BodySpec { velocity, ..body(Shape::rectangle(0.8, 0.5), place, Surface::with_friction(0.4)) });
    }
    let angular = |world: &World| -> f64 {
        let of =
            |b: &unipbd_core::rigid::Body| b.mass * b.position.perp_dot(b.velocity) + b.inertia * b.angular_velocity;
        world.bodies.views().iter().map(of).sum()
    };
    let scale: f64 = world.bodies.views().iter().map(|b| b.mass * b.velocity.length()).sum();
    let (linear, turning, energy) = (world.momentum(), angular(&world), world.kinetic_energy());
    world.run(2.0);
    let (drift, turned) = ((world.momentum() - linear).length() / scale, (angular(&world) - turning).abs() / scale);
    let kept = world.kinetic_energy() / energy;
    println!("momentum error {drift:.1e}, angular {turned:.1e}, energy left {kept:.3}");
    assert!(drift < 1e-12 && turned < 0.02 && kept < 1.0);
}

/// How far the top of a stack of boxes, each a little out of line, comes from where it was put in 10 s \[m].
fn lean(boxes: u32, substeps: u32, mut world: World) -> f64 {
    world.substeps = substeps;
    for k in 0..boxes {
        let k = f64::from(k);
        world.add(unit_box(at(0.02 * k.sin(), 0.5 + k)));
    }
    let start = world.position(boxes - 1);
    let mut lean = 0.0f64;
    for _ in 0..(10.0 / FRAME) as u32 {
        world.frame();
        lean = lean.max((world.position(boxes - 1) - start).length());
    }
    lean
}

#[test]
fn mass_scaling_lets_a_stack_stand_with_fewer_substeps() {
    for substeps in [1, 2, 4, 8] {
        let with = |k| lean(20, substeps, legacy_world(&ground(), &scaled(k)));
        println!("20 boxes, {substeps} substeps: without {:.2e} m, k = 1/m {:.2e} m", with(0.0), with(1.0));
    }
    let with = |k| lean(20, 2, legacy_world(&ground(), &scaled(k)));
    assert!(with(0.0) > 1.0 && with(1.0) < 0.1);
}

#[test]
fn more_iterations_let_a_stack_stand_with_fewer_substeps() {
    let settings = |iterations| ContactSettings { iterations, ..never_asleep() };
    let with = |iterations| lean(20, 2, World::with_settings(&ground(), settings(iterations)));
    let (one, four) = (with(1), with(4));
    println!("20 boxes, 2 substeps: {one:.2e} m with one iteration, {four:.2e} m with four");
    assert!(one > 1.0 && four < 0.5);
}

#[test]
fn mass_scaling_holds_averaged_stacks_up() {
    let options = |mass_scaling| LegacySettings { mass_scaling, ..averaged(1.0) };
    let with = |mass_scaling| lean(5, 8, legacy_world(&ground(), &options(mass_scaling)));
    let (plain, scaled) = (with(0.0), with(3.0));
    println!("5 boxes, averaged, 8 substeps: without {plain:.2e} m, k = 3/m {scaled:.2e} m");
    assert!(plain > 1.0 && scaled < 0.05);
}

#[test]
fn mass_scaling_does_not_depend_on_where_a_heap_stands() {
    let lowest = |ground: f64| {
        let plane = Wall::half_plane(at(0.0, ground), Vector64::Y, Surface::with_friction(0.5));
        let mut world = legacy_world(&[plane], &scaled(1.0));
        (0..5).for_each(|k| {
            world.add(unit_box(at(0.0, ground + 0.5 + f64::from(k))));
        });
        world.run(2.0);
        (world.position(4).y - ground, -world.contacts.wall_forces()[0].y)
    };
    let (here, there) = (lowest(0.0), lowest(256.0));
    // Each box weighs m exp(-k h) g on the one below.
    let expected: f64 = (0..5).map(|k| 1000.0 * GRAVITY * (-(0.5 + f64::from(k))).exp()).sum();
    println!(
        "top at {:.6} and {:.6} m, floor carries {:.1} and {:.1} of {expected:.1} N",
        here.0, there.0, here.1, there.1
    );
    assert!((here.0 - there.0).abs() < 1e-6 && (here.1 / expected - 1.0).abs() < 0.01);
}
