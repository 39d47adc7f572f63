//! Liquid and bodies thrown at ten times the speed of the highest fall, 10 sqrt(2 g H), stay inside: behind walls
//! of obstacles and of static bodies two samples thick, and behind half-planes, which have no thickness.

use std::f64::consts::TAU;

use unipbd_core::math::wide;
use unipbd_core::scene::{HalfPlane, Obstacle, Scene, Substeps};
use unipbd_core::{Phase, Vector64};
use unipbd_tests::{build, run, scene};

const SPACING: f64 = 0.1;
/// Side of the box that holds all \[m].
const HEIGHT: f64 = 4.0;

/// A drop of water and three bodies at 10 sqrt(2 g H).
fn thrown(substeps: Substeps, direction: Vector64) -> Scene {
    let mut thrown = scene(
        r#"
spacing = 0.1
[[liquid]]
name = "water"
[[block]]
material = "water"
min = [1.5, 1.5]
max = [2.5, 2.5]
[[body]]
name = "box"
size = [0.4, 0.4]
position = [0.7, 2.0]
restitution = 0.5
[[body]]
name = "disc"
radius = 0.2
position = [3.3, 2.0]
restitution = 0.5
[[body]]
name = "wedge"
outline = [[-0.3, -0.2], [0.3, -0.2], [0.0, 0.3]]
position = [2.0, 3.2]
density = 300.0
"#,
    );
    thrown.solver.substeps = substeps;
    let velocity = direction.normalize() * 10.0 * (2.0 * 9.81 * HEIGHT).sqrt();
    thrown.block[0].velocity = velocity.into();
    for (body, turn) in thrown.body.iter_mut().zip([1.0, 2.5, 4.0]) {
        body.velocity = Vector64::from_angle(turn).rotate(velocity).into();
        body.spin_deg = 300.0;
    }
    thrown
}

/// Lower left and upper right corners of four walls, two spacings thick. They overlap at the corners of the
/// box: walls that only touch leave a crack of no width.
fn sides() -> [[[f64; 2]; 2]; 4] {
    let (low, high) = (-2.0 * SPACING, HEIGHT + 2.0 * SPACING);
    [[[low, low], [high, 0.0]], [[low, HEIGHT], [high, high]], [[low, low], [0.0, high]], [[HEIGHT, low], [high, high]]]
}

fn obstacles(mut scene: Scene) -> Scene {
    let obstacle = |[min, max]: [[f64; 2]; 2]| Obstacle {
        name: String::new(),
        min,
        max,
        friction: None,
        slip: Default::default(),
    };
    scene.obstacle = sides().map(obstacle).to_vec();
    scene
}

/// A concave cup and a lid over it.
fn static_bodies(mut scene: Scene) -> Scene {
    let (low, high) = (-2.0 * SPACING, HEIGHT + 2.0 * SPACING);
    let cup =
        [[low, low], [high, low], [high, high], [HEIGHT, high], [HEIGHT, 0.0], [0.0, 0.0], [0.0, high], [low, high]];
    let lid = [[low, HEIGHT], [high, HEIGHT], [high, high], [low, high]];
    for outline in [&cup[..], &lid[..]] {
        let text = format!("[[body]]\nkind = 'static'\nposition = [0.0, 0.0]\noutline = {outline:?}");
        scene.body.extend(unipbd_tests::scene(&format!("{text}\n[[liquid]]\nname = 'none'\n")).body);
    }
    scene
}

/// A triangle around the middle of the box; its corners are sharp.
fn half_planes(mut scene: Scene) -> Scene {
    let center = Vector64::splat(0.5 * HEIGHT);
    for k in 0..3 {
        let inward = Vector64::from_angle(0.3 + TAU / 3.0 * f64::from(k));
        let point = center - inward * 0.5 * HEIGHT;
        scene.half_plane.push(HalfPlane { friction: Some(0.2), ..HalfPlane::new(point.into(), inward.into()) });
    }
    scene
}

/// How far a point is outside of what [`sides`] or [`half_planes`] enclose \[m].
fn outside(scene: &Scene, x: Vector64) -> f64 {
    let behind = |plane: &HalfPlane| (Vector64::from(plane.point) - x).dot(Vector64::from(plane.normal).normalize());
    if scene.half_plane.is_empty() {
        (-x).max(x - Vector64::splat(HEIGHT)).max_element()
    } else {
        scene.half_plane.iter().map(behind).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Runs two seconds; returns how far water, and the centre of a body, came out \[m].
fn farthest(scene: &Scene) -> (f64, f64) {
    let mut solver = build(scene, 2);
    let (mut water, mut bodies) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    run(&mut solver, 120, |solver| {
        for (x, phase) in solver.positions().iter().zip(solver.phases()) {
            if *phase == Phase::Liquid {
                water = water.max(outside(scene, wide(*x)));
            }
        }
        for body in &solver.bodies()[..3] {
            bodies = bodies.max(outside(scene, body.position));
        }
    });
    (water, bodies)
}

#[track_caller]
fn assert_nothing_passes(walls: fn(Scene) -> Scene, slack: f64) {
    for substeps in [Substeps::Auto, Substeps::Fixed(8)] {
        for direction in [Vector64::new(1.0, 0.0), Vector64::new(0.3, -1.0), Vector64::new(-1.0, -0.9)] {
            let (water, bodies) = farthest(&walls(thrown(substeps, direction)));
            println!("{substeps:?} towards {direction}: water {water:.2e} m outside, centres of bodies {bodies:.3} m");
            assert!(water <= slack && bodies < 0.0);
        }
    }
}

#[test]
fn nothing_passes_obstacles_two_samples_thick() {
    assert_nothing_passes(obstacles, 1e-4 * SPACING);
}

#[test]
fn nothing_passes_static_bodies_two_samples_thick() {
    assert_nothing_passes(static_bodies, 1e-4 * SPACING);
}

#[test]
fn nothing_passes_half_planes_of_no_thickness() {
    assert_nothing_passes(half_planes, 1e-4 * SPACING);
}
