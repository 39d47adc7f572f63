use super::world::{GRAVITY, World, at, body, floor, mirrored, never_asleep, unit_box};
use unipbd_core::rigid::Wall;
use unipbd_core::rigid::contact::ContactSettings;
use unipbd_core::rigid::{BodySpec, MassSpec, Surface};
use unipbd_core::shapes::Shape;

/// Boxes on each other, sideways out of line by up to `offset` \[m], `gap` apart \[m].
fn stack(height: u32, offset: f64, gap: f64) -> World {
    let mut world = World::new(&[floor(Surface::with_friction(0.5))]);
    for k in 0..height {
        let k = f64::from(k);
        world.add(unit_box(at(offset * k.sin(), 0.5 + gap + (1.0 + gap) * k)));
    }
    world
}

fn drift(world: &World, start: &[f64]) -> f64 {
    world.ids().map(|id| (world.position(id).x - start[id as usize]).abs()).fold(0.0, f64::max)
}

/// Rows of boxes, each standing on two; mirrored about x = 0.
fn pyramid(rows: u32, settings: ContactSettings) -> World {
    let mut world = World::with_settings(&[floor(Surface::with_friction(0.5))], settings);
    for row in 0..rows {
        for k in 0..rows - row {
            let x = 1.05 * (f64::from(k) - 0.5 * f64::from(rows - row - 1));
            world.add(unit_box(at(x, 0.5 + f64::from(row))));
        }
    }
    world
}

fn mirror_error(world: &World, rows: u32) -> f64 {
    let (mut first, mut error) = (0, 0.0f64);
    for row in 0..rows {
        let count = rows - row;
        for k in 0..count {
            let (left, right) = (world.position(first + k), world.position(first + count - 1 - k));
            error = error.max((left.x + right.x).abs()).max((left.y - right.y).abs());
        }
        first += count;
    }
    error
}

#[test]
fn twenty_boxes_stand() {
    for offset in [0.0, 0.01] {
        let mut world = stack(20, offset, 0.0);
        let start: Vec<f64> = world.ids().map(|id| world.position(id).x).collect();
        world.run(19.0);
        let speed = world.fastest_in(1.0);
        let (drift, overlap) = (drift(&world, &start), world.penetration());
        println!("stack of 20, offset {offset}: speed {speed:.1e} m/s, drift {drift:.1e} m, overlap {overlap:.1e} m");
        assert!(drift <= 0.02 && overlap <= 1e-3 && speed < 0.02);
    }
}

#[test]
fn ten_boxes_dropped_out_of_line_come_to_rest() {
    let mut world = stack(10, 0.05, 0.02);
    world.run(9.0);
    let speed = world.fastest_in(1.0);
    println!("stack of 10, dropped out of line: speed {speed:.1e} m/s after 10 s");
    assert!(world.position(9).y > 9.49 && speed < 0.02);
}

#[test]
fn a_pyramid_of_1275_boxes_comes_to_rest_at_three_substeps() {
    let mut world = pyramid(50, never_asleep());
    world.substeps = 3;
    world.run(6.0);
    let (sunk, speed) = (49.5 - world.position(1274).y, world.fastest());
    println!("pyramid of 50 rows, 3 substeps: top {sunk:.3} m lower, speed {speed:.1e} m/s");
    assert!(sunk < 0.15 && speed < 0.02);
}

#[test]
fn pyramid_of_210_boxes_stands() {
    for (name, settings, most) in [("in turn", never_asleep(), 0.02), ("at once", mirrored(), 1e-9)] {
        let mut world = pyramid(20, settings);
        world.run(7.0);
        let speed = world.fastest_in(1.0);
        let (overlap, mirror) = (world.penetration(), mirror_error(&world, 20));
        println!(
            "pyramid of 210, {name}, 8 s: speed {speed:.1e} m/s, overlap {overlap:.1e} m, mirror error {mirror:.1e} m"
        );
        assert!(overlap <= 1e-3 && mirror <= most && speed <= 1e-5);
    }
}

#[test]
#[ignore = "20 s of simulated time; the 8 s above are the quick version"]
fn pyramid_of_210_boxes_stands_20_seconds() {
    let mut world = pyramid(20, mirrored());
    let started = std::time::Instant::now();
    world.run(19.0);
    let speed = world.fastest_in(1.0);
    let (overlap, mirror) = (world.penetration(), mirror_error(&world, 20));
    println!("pyramid of 210, 20 s: speed {speed:.1e} m/s, overlap {overlap:.1e} m, mirror error {mirror:.1e} m");
    println!("{:.2} ms per frame", started.elapsed().as_secs_f64() * 1e3 / 1200.0);
    assert!(overlap <= 1e-3 && mirror <= 1e-9 && speed <= 1e-6);
}

#[test]
fn heavy_box_stands_on_a_light_one() {
    for ratio in [10.0, 100.0] {
        let mut world = World::new(&[floor(Surface::with_friction(0.5))]);
        world.add(unit_box(at(0.0, 0.5)));
        world.add(BodySpec { mass: MassSpec::Density(1000.0 * ratio), ..unit_box(at(0.0, 1.5)) });
        world.run(10.0);
        let (light, heavy) = (world.position(0), world.position(1));
        println!("1:{ratio}: heights {:.5} {:.5}, speed {:.1e}", light.y, heavy.y, world.fastest());
        assert!((light.y - 0.5).abs() < 2e-3 && (heavy.y - 1.5).abs() < 4e-3 && heavy.x.abs() < 0.02);
    }
}

#[test]
fn settled_discs_hardly_overlap() {
    let mut world = World::new(&Wall::tank(at(0.0, 0.0), at(10.0, 60.0), Surface::default()));
    for k in 0..400u32 {
        let jitter = 0.1 * (f64::from(k) * 12.9898).sin();
        let place = at(0.5 + 0.6 * f64::from(k % 15) + jitter, 0.3 + 0.6 * f64::from(k / 15));
        world.add(body(Shape::Disc { radius: 0.25 }, place, Surface::with_friction(0.3)));
    }
    world.run(10.0);
    let weight: f64 = world.bodies.views().iter().map(|b| b.mass * GRAVITY).sum();
    let carried = -world.contacts.wall_forces()[2].y;
    println!(
        "400 discs: overlap {:.1e} of 0.5 m, speed {:.1e} m/s, weight {weight:.0} on the floor {carried:.0} N",
        world.penetration(),
        world.fastest()
    );
    assert!(world.penetration() < 5e-3 && world.ids().all(|id| world.position(id).y > 0.24));
}

/// 5000 bodies falling into a tank; times are printed, for a look and not for a bar.
fn settle_5000(shape: impl Fn(u32) -> Shape) {
    let mut world = World::new(&Wall::tank(at(0.0, 0.0), at(50.0, 200.0), Surface::default()));
    world.substeps = 16;
    for k in 0..5000u32 {
        let jitter = 0.05 * (f64::from(k) * 12.9898).sin();
        let place = at(0.4 + 0.6 * f64::from(k % 82) + jitter, 0.3 + 0.6 * f64::from(k / 82));
        world.add(body(shape(k), place, Surface::default()));
    }
    for part in 0..4 {
        let started = std::time::Instant::now();
        world.run(2.0);
        let per_frame = started.elapsed().as_secs_f64() * 1e3 / 120.0;
        let (points, overlap, fastest) = (world.contacts.points().count(), world.penetration(), world.fastest());
        let mean = world.contacts.points().map(|p| (-p.gap).max(0.0)).sum::<f64>() / points as f64;
        println!("from {} s: {per_frame:.2} ms per frame, {points} points, speed {fastest:.1e} m/s", 2 * part);
        println!("overlap {overlap:.1e} m, mean {mean:.1e} m");
    }
    assert!(world.penetration() < 0.05);
}

#[test]
#[ignore = "a minute of work"]
fn five_thousand_discs_settle() {
    settle_5000(|_| Shape::Disc { radius: 0.25 });
}

#[test]
#[ignore = "a minute of work"]
fn five_thousand_boxes_settle() {
    settle_5000(|_| Shape::rectangle(0.5, 0.5));
}
