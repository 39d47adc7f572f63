use super::world::{World, at, body, floor};
use unipbd_core::Vector64;
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::{BodyKind, BodySpec, Motion, Pose, Repeat, Surface, Twist, Waypoint};
use unipbd_core::shapes::{Shape, ShapeError, convex_decomposition};

/// An L of three unit squares.
fn l_shape() -> Shape {
    Shape::Polygon(vec![at(0.0, 0.0), at(2.0, 0.0), at(2.0, 1.0), at(1.0, 1.0), at(1.0, 2.0), at(0.0, 2.0)])
}

/// A trough 3 m wide and 2 m high, 0.5 m thick.
fn u_shape() -> Shape {
    let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.5, 2.0), (2.5, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)];
    Shape::Polygon(points.iter().map(|&(x, y)| at(x, y)).collect())
}

fn star(points: usize) -> Shape {
    let corner = |k: usize| {
        let radius = if k.is_multiple_of(2) { 1.0 } else { 0.45 };
        Vector64::from_angle(std::f64::consts::PI * k as f64 / points as f64) * radius
    };
    Shape::Polygon((0..2 * points).map(corner).collect())
}

#[test]
fn moments_are_exact() {
    let rectangle = Shape::rectangle(3.0, 2.0).translated(at(5.0, -7.0)).moments();
    assert!((rectangle.area - 6.0).abs() < 1e-12 && (rectangle.centroid - at(5.0, -7.0)).length() < 1e-12);
    assert!((rectangle.second - 6.0 * (9.0 + 4.0) / 12.0).abs() < 1e-12);
    let l = l_shape().moments();
    assert!((l.area - 3.0).abs() < 1e-12 && (l.centroid - at(5.0 / 6.0, 5.0 / 6.0)).length() < 1e-12);
    let steiner = |x: f64, y: f64| 1.0 / 6.0 + (at(x, y) - at(5.0 / 6.0, 5.0 / 6.0)).length_squared();
    assert!((l.second - steiner(0.5, 0.5) - steiner(1.5, 0.5) - steiner(0.5, 1.5)).abs() < 1e-12);
}

#[test]
fn samples_keep_area_and_nearly_inertia() {
    for shape in [Shape::rectangle(2.0, 1.0), l_shape(), u_shape(), star(5), Shape::Disc { radius: 0.7 }] {
        let (moments, samples) = (shape.moments(), shape.samples(0.1));
        let count = samples.points.len() as f64;
        let mean = samples.points.iter().sum::<Vector64>() / count;
        let own = samples.area * samples.area / 6.0;
        let around = |p: &Vector64| samples.area * (*p - moments.centroid).length_squared() + own;
        let second: f64 = samples.points.iter().map(around).sum();
        println!("{count} samples, area {:.5} of dx^2, inertia {:.4}", samples.area / 0.01, second / moments.second);
        assert!((samples.area * count - moments.area).abs() < 1e-9 && (mean - moments.centroid).length() < 1e-9);
        assert!((samples.area / 0.01 - 1.0).abs() < 0.04 && (second / moments.second - 1.0).abs() < 0.04);
    }
}

#[test]
fn signed_distance_has_the_right_sign_and_gradient() {
    for shape in [l_shape(), u_shape(), star(7), Shape::Disc { radius: 0.8 }] {
        for k in 0..2000 {
            let k = f64::from(k);
            let point = at(0.5 + 2.5 * (k * 0.77).sin(), 0.5 + 2.5 * (k * 0.31).cos());
            let near = shape.nearest(point);
            assert_eq!(near.distance < 0.0, shape.contains(point));
            let on = point - near.normal * near.distance;
            assert!(shape.nearest(on).distance.abs() < 1e-9, "the nearest point lies on the boundary");
        }
    }
}

#[test]
fn decomposition_covers_the_polygon_with_convex_pieces() {
    for (shape, most) in [(l_shape(), 2), (u_shape(), 3), (star(5), 6), (star(9), 12)] {
        let Shape::Polygon(corners) = &shape else { unreachable!() };
        let pieces = convex_decomposition(corners);
        let area: f64 =
            pieces.iter().map(|p| Shape::Polygon(p.iter().map(|&k| corners[k]).collect()).moments().area).sum();
        println!("{} corners: {} pieces", corners.len(), pieces.len());
        assert!((area - shape.moments().area).abs() < 1e-9 && pieces.len() <= most);
    }
}

#[test]
fn faulty_shapes_are_refused() {
    let bow_tie = Shape::Polygon(vec![at(0.0, 0.0), at(2.0, 2.0), at(2.0, 0.0), at(0.0, 1.0)]);
    assert_eq!(bow_tie.check(), Err(ShapeError::SelfIntersecting));
    assert_eq!(Shape::Polygon(vec![at(0.0, 0.0), at(1.0, 0.0)]).check(), Err(ShapeError::TooFewCorners));
    assert_eq!(Shape::Disc { radius: 0.0 }.check(), Err(ShapeError::NoArea));
    assert_eq!(Shape::rectangle(f64::NAN, 1.0).check(), Err(ShapeError::NotFinite));
}

#[test]
fn concave_bodies_rest_on_their_outline() {
    let mut world = World::new(&[floor(Surface::default())]);
    let trough = world.add(body(u_shape(), at(0.0, 0.1), Surface::default()));
    let inside = world.add(body(Shape::rectangle(1.0, 1.0), at(1.5, 1.3), Surface::default()));
    let ball = world.add(body(Shape::Disc { radius: 0.25 }, at(0.76, 1.0), Surface::default()));
    let l = world.add(body(l_shape(), at(5.0, 0.1), Surface::default()));
    let nook = world.add(body(Shape::rectangle(0.8, 0.8), at(6.45, 1.6), Surface::default()));
    // An arch: the trough upside down over a box.
    let arch = world.add(BodySpec {
        pose: Pose { position: at(13.0, 2.6), angle: std::f64::consts::PI },
        ..body(u_shape(), at(0.0, 0.0), Surface::default())
    });
    let pillar = world.add(body(Shape::rectangle(0.6, 1.2), at(11.5, 0.6), Surface::default()));
    world.run(6.0);
    for (id, expected) in [(inside, 1.0), (ball, 0.75), (nook, 1.4), (pillar, 0.6)] {
        println!("body {id} at height {:.4}, expected {expected}", world.position(id).y);
        assert!((world.position(id).y - expected).abs() < 2e-3);
    }
    let turned = |id: u32| world.bodies.pose(id).angle;
    assert!(turned(trough).abs() < 1e-3 && turned(l).abs() < 1e-3);
    assert!((turned(arch) - std::f64::consts::PI).abs() < 1e-3);
    println!("fastest {:.1e} m/s", world.fastest());
    assert!(world.fastest() < 1e-3);
}

#[test]
fn star_rests_on_two_points_in_a_concave_wall() {
    // A valley as one concave polygon.
    let valley = [
        (-6.0, 20.0),
        (-6.0, -1.0),
        (6.0, -1.0),
        (6.0, 20.0),
        (5.0, 20.0),
        (5.0, 4.0),
        (1.0, 0.0),
        (-1.0, 0.0),
        (-5.0, 4.0),
        (-5.0, 20.0),
    ];
    let wall = Wall::polygon(valley.iter().map(|&(x, y)| at(x, y)).collect(), Surface::default());
    let mut world = World::new(std::slice::from_ref(&wall));
    for k in 0..6 {
        world.add(body(star(5), at(-2.0 + 0.8 * f64::from(k), 4.0 + 2.2 * f64::from(k)), Surface::default()));
        world.add(body(
            Shape::Disc { radius: 0.3 },
            at(2.0 - 0.8 * f64::from(k), 4.0 + 2.2 * f64::from(k)),
            Surface::default(),
        ));
    }
    world.run(8.0);
    let deepest = world.ids().map(|id| wall.nearest(world.position(id)).distance).fold(f64::INFINITY, f64::min);
    println!(
        "nearest centre {deepest:.3} m from the valley, overlap {:.1e} m, speed {:.1e} m/s",
        world.penetration(),
        world.fastest()
    );
    assert!(deepest > 0.25 && world.penetration() < 0.01 && world.fastest() < 0.1);
}

#[test]
fn kinematic_bodies_follow_their_scripts() {
    let mut world = World::new(&[]);
    let script =
        |motion| BodySpec { kind: BodyKind::Kinematic, motion, ..body(l_shape(), at(1.0, 2.0), Surface::default()) };
    let spin = world.add(script(Motion::Steady { velocity: Vector64::ZERO, spin: 2.0 }));
    let swing = Motion::Oscillate { amplitude: at(0.5, 0.0), swing: 0.3, frequency: 0.7, phase: 0.4 };
    let swings = world.add(script(swing.clone()));
    let stations = [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (2.0, 2.0, 1.0), (3.0, 0.0, 0.0)];
    let waypoints = stations.iter().map(|&(time, x, turn)| Waypoint { time, offset: at(x, 0.0), turn }).collect();
    let path = world.add(script(Motion::Path { waypoints, repeat: Repeat::Loop }));
    world.run(4.25);
    // The script moves the origin of the outline, a corner of the L; the centre of mass turns about it.
    let origin = |id: u32| world.bodies.pose(id).apply(at(-5.0 / 6.0, -5.0 / 6.0));
    let time = world.time;
    assert!((origin(spin) - at(1.0, 2.0)).length() < 1e-9 && (world.bodies.pose(spin).angle - 2.0 * time).abs() < 1e-9);
    assert!((origin(swings) - at(1.0, 2.0) - swing.displacement(time).linear).length() < 1e-9);
    assert!((origin(path) - at(3.0, 2.0)).length() < 1e-6, "1.25 s into the second round");
    let rim = world.bodies.velocity_at(spin, at(3.0, 2.0));
    assert!((rim - at(0.0, 4.0)).length() < 0.01, "the matter at a point moves with the spin: {rim}");
    let rate = (swing.displacement(1.001).linear - swing.displacement(0.999).linear) / 0.002;
    assert!((rate - swing.velocity(1.0).linear).length() < 1e-4);
    assert_eq!(Motion::Still.velocity(1.0), Twist::ZERO);
}

#[test]
fn a_kinematic_body_without_a_script_keeps_its_velocity() {
    let mut world = World::new(&[]);
    let velocity = Twist { linear: at(0.5, -0.25), angular: 2.0 };
    let steady = BodySpec { kind: BodyKind::Kinematic, velocity, ..body(l_shape(), at(1.0, 2.0), Surface::default()) };
    let id = world.add(steady);
    let start = world.position(id);
    world.run(1.0);
    // The centre of mass goes straight on, wherever the origin of the outline is.
    let off = (world.position(id) - start - velocity.linear * world.time).length();
    let turned = world.bodies.pose(id).angle;
    println!("off a straight way by {off:e} m");
    assert!(off < 1e-9 && (turned - velocity.angular * world.time).abs() < 1e-9);
    assert_eq!(world.velocity(id), velocity);
}
