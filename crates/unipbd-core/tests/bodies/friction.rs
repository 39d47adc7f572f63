use super::world::{FRAME, GRAVITY, World, at, body, unit_box};
use unipbd_core::Vector64;
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::{BodySpec, Pose, Surface};
use unipbd_core::shapes::Shape;

/// A slope that falls towards +x, with one body resting on it.
fn on_slope(tangent: f64, shape: Shape, height: f64, surface: Surface) -> (World, f64) {
    let angle = -tangent.atan();
    let normal = Vector64::from_angle(angle).perp();
    let mut world = World::new(&[Wall::half_plane(Vector64::ZERO, normal, surface)]);
    let pose = Pose { position: normal * height, angle };
    world.add(BodySpec { pose, ..body(shape, Vector64::ZERO, surface) });
    (world, angle)
}

fn box_on_slope(tangent: f64, surface: Surface) -> (World, f64) {
    on_slope(tangent, Shape::rectangle(1.0, 1.0), 0.5, surface)
}

/// Distance gone down the slope.
fn gone(world: &World, angle: f64) -> f64 {
    world.position(0).dot(Vector64::from_angle(angle))
}

#[test]
fn block_slides_iff_slope_exceeds_friction_angle() {
    for mu in [0.2, 0.5, 0.7] {
        let (mut sticking, angle) = box_on_slope(0.98 * mu, Surface::with_friction(mu));
        sticking.run(2.0);
        let start = gone(&sticking, angle);
        sticking.run(2.0);
        let creep = (gone(&sticking, angle) - start).abs() / 2.0;
        let (mut sliding, angle) = box_on_slope(1.02 * mu, Surface::with_friction(mu));
        sliding.run(2.0);
        let slid = gone(&sliding, angle);
        println!("mu {mu}: creep {creep:.1e} m/s at 0.98 mu, slid {slid:.4} m at 1.02 mu");
        assert!(creep <= 1e-9 && slid > 0.05);
    }
}

#[test]
fn sliding_block_accelerates_as_coulomb_says() {
    for tangent in [0.51, 0.6, 1.0] {
        let (mut world, angle) = box_on_slope(tangent, Surface::with_friction(0.5));
        world.run(0.5);
        let before = world.velocity(0).linear.length();
        world.run(1.0);
        let measured = world.velocity(0).linear.length() - before;
        let exact = GRAVITY * (angle.sin().abs() - 0.5 * angle.cos());
        println!("tan {tangent}: acceleration {measured:.6}, exact {exact:.6}, error {:.1e}", measured / exact - 1.0);
        assert!((measured / exact - 1.0).abs() < 1e-3);
    }
}

#[test]
fn sticking_and_sliding_coefficients_differ() {
    let surface = Surface { static_friction: 0.6, kinetic_friction: 0.4, ..Surface::default() };
    let (mut resting, angle) = box_on_slope(0.5, surface);
    resting.run(1.0);
    assert!(gone(&resting, angle).abs() < 1e-3, "between the two a block at rest stays");
    let (mut moving, angle) = box_on_slope(0.5, surface);
    let down = Vector64::from_angle(angle);
    moving.bodies.set_velocity(0, unipbd_core::rigid::Twist { linear: down, angular: 0.0 });
    moving.run(1.0);
    let gained = moving.velocity(0).linear.dot(down) - 1.0;
    let exact = GRAVITY * (angle.sin().abs() - 0.4 * angle.cos());
    println!("moving block gains {gained:.5} m/s, exact {exact:.5}");
    assert!((gained / exact - 1.0).abs() < 1e-3);
}

#[test]
fn disc_rolls_at_two_thirds_of_the_slope_pull() {
    let (mut world, angle) = on_slope(0.3, Shape::Disc { radius: 0.5 }, 0.5, Surface::with_friction(0.5));
    world.run(0.5);
    let before = world.velocity(0).linear.length();
    world.run(1.0);
    let measured = world.velocity(0).linear.length() - before;
    let exact = 2.0 / 3.0 * GRAVITY * angle.sin().abs();
    let slip = world.velocity(0).linear.length() + world.velocity(0).angular * 0.5;
    println!("rolls at {measured:.6}, exact {exact:.6}, error {:.1e}, slip {slip:.1e} m/s", measured / exact - 1.0);
    assert!((measured / exact - 1.0).abs() < 1e-4 && slip.abs() < 1e-4);
}

#[test]
fn rolling_friction_holds_a_disc_on_a_slope_below_its_coefficient() {
    let surface = Surface { rolling_friction: 0.1, ..Surface::default() };
    let (mut held, angle) = on_slope(0.09, Shape::Disc { radius: 0.5 }, 0.5, surface);
    held.run(2.0);
    let (mut free, steep) = on_slope(0.11, Shape::Disc { radius: 0.5 }, 0.5, surface);
    free.run(2.0);
    println!("below: {:.1e} m, above: {:.3} m", gone(&held, angle), gone(&free, steep));
    assert!(gone(&held, angle).abs() < 1e-4 && gone(&free, steep) > 0.05);
}

#[test]
fn resting_block_does_not_creep() {
    let (mut world, _) = box_on_slope(0.3, Surface::with_friction(0.5));
    world.run(5.0);
    let start = world.position(0);
    world.run(5.0);
    let creep = (world.position(0) - start).length() / 5.0;
    println!("creep {creep:.1e} m/s");
    assert!(creep <= 1e-9);
}

#[test]
fn wall_feels_the_weight_and_the_friction_of_what_rests_on_it() {
    let (mut world, _) = box_on_slope(0.3, Surface::with_friction(0.5));
    world.run(2.0);
    let force = world.contacts.wall_forces()[0];
    println!("force on the slope {force:.3} N");
    assert!((force - at(0.0, -1000.0 * GRAVITY)).length() < 1.0);
}

#[test]
fn fluid_load_moves_a_body_and_is_reported() {
    let mut world = World::new(&[]);
    world.gravity = Vector64::ZERO;
    let id = world.add(unit_box(at(0.0, 0.0)));
    for _ in 0..60 {
        for _ in 0..8 {
            let dt = FRAME / 8.0;
            world.contacts.begin_substep(&mut world.bodies, dt, Vector64::ZERO);
            world.bodies.predict(dt, world.time, Vector64::ZERO);
            world.contacts.warm_start(&mut world.bodies);
            world.bodies.load(id, at(500.0, 0.0), 100.0, dt);
            world.bodies.integrate(dt);
        }
        world.bodies.finish_frame(FRAME);
    }
    let view = &world.bodies.views()[0];
    assert!((view.fluid_force - at(500.0, 0.0)).length() < 1e-9 && (view.fluid_torque - 100.0).abs() < 1e-9);
    assert!((view.velocity.x - 0.5).abs() < 1e-9 && (view.angular_velocity - 0.6).abs() < 1e-9);
}
