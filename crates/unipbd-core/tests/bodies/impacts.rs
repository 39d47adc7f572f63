use super::world::{FRAME, GRAVITY, World, at, body, floor, unit_box};
use unipbd_core::Vector64;
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::{BodyKind, BodySpec, Motion, Surface, Twist};
use unipbd_core::shapes::Shape;

fn smooth() -> Surface {
    Surface::with_friction(0.0)
}

#[test]
fn disc_rebounds_to_the_square_of_restitution() {
    for restitution in [1.0, 0.8, 0.5] {
        let surface = Surface::default().with_restitution(restitution);
        let mut world = World::new(&[floor(surface)]);
        world.add(body(Shape::Disc { radius: 0.5 }, at(0.0, 1.5), surface));
        let (mut landed, mut top) = (false, 0.0f64);
        for _ in 0..90 {
            for _ in 0..8 {
                world.substep(FRAME / 8.0);
                landed |= world.velocity(0).linear.y > 0.0;
                if landed {
                    top = top.max(world.position(0).y - 0.5);
                }
            }
        }
        let exact = restitution * restitution;
        println!("e = {restitution}: height {top:.4}, exact {exact:.4}, ratio {:.4}", top / exact);
        assert!((top / exact - 1.0).abs() < 0.02);
    }
}

#[test]
fn elastic_discs_keep_energy_and_momentum() {
    let surface = smooth().with_restitution(1.0);
    let mut world = World::new(&[]);
    world.gravity = Vector64::ZERO;
    for row in 0..8 {
        for column in 0..8 {
            let velocity =
                at((f64::from(row * 7 + column * 3) * 0.7).sin(), (f64::from(row * 3 - column * 5) * 0.9).cos());
            let spec = body(Shape::Disc { radius: 0.25 }, at(f64::from(column), f64::from(row)), surface);
            world.add(BodySpec { velocity: Twist { linear: velocity, angular: 0.0 }, ..spec });
        }
    }
    let (energy, momentum) = (world.kinetic_energy(), world.momentum());
    let scale: f64 = world.bodies.views().iter().map(|b| b.mass * b.velocity.length()).sum();
    world.run(3.0);
    let kept = world.kinetic_energy() / energy;
    let drift = (world.momentum() - momentum).length() / scale;
    println!("64 elastic discs: energy {kept:.6}, momentum error {drift:.1e}");
    assert!((kept - 1.0).abs() < 2e-3 && drift < 1e-12);
}

#[test]
fn colliding_boxes_keep_linear_and_angular_momentum() {
    let mut world = World::new(&[]);
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
    let (linear, turning) = (world.momentum(), angular(&world));
    let energy = world.kinetic_energy();
    world.run(2.0);
    let linear_drift = (world.momentum() - linear).length() / scale;
    let angular_drift = (angular(&world) - turning).abs() / scale;
    let lost = world.kinetic_energy() / energy;
    println!("momentum error {linear_drift:.1e}, angular {angular_drift:.1e}, energy left {lost:.3}");
    assert!(linear_drift < 1e-12 && lost < 1.0);
    assert!(angular_drift < 0.02, "contacts have thickness only while they overlap or approach");
}

#[test]
fn nothing_tunnels_at_ten_times_the_speed_of_the_highest_fall() {
    let height: f64 = 4.0;
    let speed = 10.0 * (2.0 * GRAVITY * height).sqrt();
    let shapes = [Shape::rectangle(0.4, 0.4), Shape::Disc { radius: 0.2 }, Shape::regular(5, 0.25)];
    let tank = Wall::tank(at(0.0, 0.0), at(height, height), Surface::default());
    let thin = 0.2;
    let boxes = [
        Wall::rectangle(at(-thin, -thin), at(height + thin, 0.0), Surface::default()),
        Wall::rectangle(at(-thin, height), at(height + thin, height + thin), Surface::default()),
        Wall::rectangle(at(-thin, -thin), at(0.0, height + thin), Surface::default()),
        Wall::rectangle(at(height, -thin), at(height + thin, height + thin), Surface::default()),
    ];
    for walls in [&tank[..], &boxes[..]] {
        let mut world = World::new(walls);
        for k in 0..24u32 {
            let place = at(0.5 + 0.6 * f64::from(k % 6), 0.5 + 0.8 * f64::from(k / 6));
            let direction = Vector64::from_angle(2.4 * f64::from(k));
            let velocity = Twist { linear: direction * speed, angular: 5.0 };
            let surface = Surface::with_friction(0.3).with_restitution(0.5);
            world.add(BodySpec { velocity, ..body(shapes[k as usize % 3].clone(), place, surface) });
        }
        let mut farthest = f64::NEG_INFINITY;
        for _ in 0..240 {
            world.frame();
            for id in world.ids() {
                let place = world.position(id);
                let out = (-place).max(place - at(height, height)).max_element();
                farthest = farthest.max(out);
            }
        }
        println!("centres at most {farthest:.4} m outside, settled penetration {:.1e}", world.penetration());
        assert!(farthest < 0.0);
    }
}

#[test]
fn overlapping_starts_settle_without_explosion() {
    let height: f64 = 4.0;
    let limit = 3.0 * (2.0 * GRAVITY * height).sqrt();
    let mut world = World::new(&Wall::tank(at(0.0, 0.0), at(6.0, 20.0), Surface::default()));
    for k in 0..40u32 {
        let place = at(2.0 + 0.31 * f64::from(k % 7), 0.6 + 0.27 * f64::from(k / 7));
        let shape = if k % 3 == 0 { Shape::Disc { radius: 0.3 } } else { Shape::rectangle(0.7, 0.5) };
        world.add(body(shape, place, Surface::default()));
    }
    world.frame();
    let start = world.penetration();
    let fastest = world.fastest_in(14.0);
    let settled = world.fastest_in(1.0);
    println!(
        "overlap {start:.3} m at first, fastest {fastest:.2} of {limit:.1} m/s, at the end {settled:.1e} m/s, overlap {:.1e} m",
        world.penetration()
    );
    // The lowest row is longer than the tank is wide: it stays wedged.
    assert!(start > 0.2 && fastest < limit && settled < 0.1 && world.penetration() < 0.02);
}

#[test]
fn two_bodies_at_the_same_place_part() {
    let mut world = World::new(&[floor(Surface::default())]);
    world.add(unit_box(at(0.0, 0.5)));
    world.add(unit_box(at(0.0, 0.5)));
    world.add(body(Shape::Disc { radius: 0.5 }, at(5.0, 0.5), Surface::default()));
    world.add(body(Shape::Disc { radius: 0.5 }, at(5.0, 0.5), Surface::default()));
    world.run(4.0);
    println!("overlap {:.1e} m, speed {:.1e} m/s", world.penetration(), world.fastest());
    assert!(world.penetration() < 2e-3);
}

#[test]
fn free_body_spins_on_for_ever() {
    let mut world = World::new(&[]);
    let velocity = Twist { linear: at(1.0, 5.0), angular: 7.0 };
    world.add(BodySpec { velocity, ..unit_box(at(0.0, 0.0)) });
    world.run(1.0);
    assert!((world.velocity(0).angular - 7.0).abs() < 1e-12);
    assert!((world.bodies.pose(0).angle - 7.0).abs() < 1e-12);
}

#[test]
fn spinning_disc_on_the_floor_drives_itself_until_it_rolls() {
    let mut world = World::new(&[floor(Surface::default())]);
    let spec = body(Shape::Disc { radius: 0.5 }, at(0.0, 0.5), Surface::with_friction(0.5));
    world.add(BodySpec { velocity: Twist { linear: Vector64::ZERO, angular: -30.0 }, ..spec });
    world.run(3.0);
    // Angular momentum about the contact: I w0 = (I + m r^2) w, so v = r w0 / 3.
    let speed = world.velocity(0).linear.x;
    println!("rolls off at {speed:.4} m/s, exact 5");
    assert!((speed - 5.0).abs() < 0.01);
}

#[test]
fn pushed_by_a_script_a_box_moves_with_it() {
    let mut world = World::new(&[floor(smooth())]);
    world.add(unit_box(at(1.5, 0.5)));
    let motion = Motion::Steady { velocity: at(0.7, 0.0), spin: 0.0 };
    world.add(BodySpec { kind: BodyKind::Kinematic, motion, ..unit_box(at(0.0, 0.5)) });
    world.run(3.0);
    let (pushed, pusher) = (world.position(0), world.position(1));
    println!("pusher {:.4}, pushed {:.4}", pusher.x, pushed.x);
    assert!((pusher.x - 2.1).abs() < 1e-9 && (pushed.x - 3.1).abs() < 0.02);
    assert!((world.velocity(0).linear - at(0.7, 0.0)).length() < 0.02);
}
