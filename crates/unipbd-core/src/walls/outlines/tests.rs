use super::*;
use crate::math::direction;
use crate::walls::Coverage;

const RADIUS: f64 = 2.5;

fn outline(shape: Shape, angle: f64, upheld: Option<f64>) -> Outlines {
    let mut outlines = Outlines::new(Kernel::new(RADIUS), upheld, Periodic::NONE);
    outlines.set([OutlineSpec { body: 0, shape, still: true, fixed: true }].into_iter());
    let place = Place { position: Vector64::ZERO, axis: direction(angle) };
    outlines.place(|_| [place; 2]);
    outlines
}

fn polygon(corners: &[[f64; 2]]) -> Shape {
    Shape::Polygon(corners.iter().map(|&corner| Vector64::from(corner)).collect()).tidied()
}

/// A star with arms of one spacing and more, and notches between them.
fn star() -> Shape {
    let corner = |k: usize| {
        let size = if k.is_multiple_of(2) { 5.0 } else { 2.0 };
        (direction(std::f64::consts::TAU * k as f64 / 10.0) * size).to_array()
    };
    polygon(&(0..10).map(corner).collect::<Vec<_>>())
}

/// Kernel inside a shape by brute force.
fn brute_force(shape: &Shape, x: Vector) -> f64 {
    let (kernel, steps) = (Kernel::new(RADIUS), 300);
    let cell = 2.0 * RADIUS / f64::from(steps);
    let mut sum = 0.0;
    for row in 0..steps {
        for column in 0..steps {
            let offset = (Vector64::new(f64::from(column), f64::from(row)) + 0.5) * cell - RADIUS;
            if shape.contains(wide(x) + offset) {
                sum += f64::from(kernel.value(real(offset.length()))) * cell * cell;
            }
        }
    }
    sum
}

fn points() -> impl Iterator<Item = Vector> {
    (0..14).flat_map(|i| (0..14).map(move |j| Vector::new(i as Real * 0.97 - 6.3, j as Real * 0.93 - 6.1)))
}

#[test]
fn outlines_cover_what_lies_inside() {
    let vessel = polygon(&[
        [-4.0, -4.0],
        [4.0, -4.0],
        [4.0, 4.0],
        [2.5, 4.0],
        [2.5, -2.0],
        [-2.5, -2.0],
        [-2.5, 4.0],
        [-4.0, 4.0],
    ]);
    for shape in [star(), vessel, Shape::Disc { radius: 3.0 }, Shape::Disc { radius: 0.8 }, Shape::rectangle(7.0, 0.7)]
    {
        let outlines = outline(shape.clone(), 0.0, None);
        for x in points() {
            let (part, expected) = (f64::from(outlines.coverage(x, Moment::End).0), brute_force(&shape, x));
            assert!((part - expected).abs() < 4e-3, "{shape:?} at {x}: {part} {expected}");
        }
    }
}

#[test]
fn gradients_of_outlines_are_derivatives() {
    for shape in [star(), Shape::Disc { radius: 3.0 }, Shape::rectangle(6.0, 1.5)] {
        for upheld in [None, Some(1.0)] {
            let outlines = outline(shape.clone(), 0.4, upheld);
            let step = 0.02;
            for x in points() {
                let at = |x: Vector| outlines.coverage(x, Moment::End).0;
                let gradient = outlines.coverage(x, Moment::End).1;
                let along = |by: Vector| (at(x + by) - at(x - by)) / (2.0 * step);
                let expected = Vector::new(along(Vector::X * step), along(Vector::Y * step));
                // Tables are piecewise linear, and supporting walls have a kink at half a spacing.
                assert!((gradient - expected).length() < 2.5e-2, "{shape:?} at {x}: {gradient} {expected}");
            }
        }
    }
}

#[test]
fn a_long_edge_at_any_angle_is_a_wall() {
    for (upheld, coverage) in
        [(None, Coverage::new(&Kernel::new(RADIUS))), (Some(1.0), Coverage::upholding(&Kernel::new(RADIUS), 1.0))]
    {
        for angle in [0.0, 0.1, 0.7, 2.0, 4.0] {
            let outlines = outline(Shape::rectangle(40.0, 30.0), angle, upheld);
            let out = vector(direction(angle)).perp();
            for distance in [-1.7, 0.05, 0.5, 1.3, 2.4] {
                let (part, slope) = coverage.behind(distance);
                let (found, gradient) = outlines.coverage(out * (15.0 + distance), Moment::End);
                assert!((found - part).abs() < 5e-4, "{distance} {angle}: {found} {part}");
                assert!((gradient - out * slope).length() < 2e-3, "{distance} {angle}: {gradient} {}", out * slope);
            }
        }
    }
}

#[test]
fn an_outline_over_a_whole_period_has_no_ends() {
    let axis = crate::periodic::PeriodicAxis { from: 0.0, length: 20.0 };
    let mut outlines = Outlines::new(Kernel::new(RADIUS), None, Periodic { x: Some(axis), y: None });
    outlines.set([OutlineSpec { body: 0, shape: Shape::rectangle(20.0, 4.0), still: true, fixed: true }].into_iter());
    outlines.place(|_| [Place { position: Vector64::new(10.0, 0.0), axis: Vector64::X }; 2]);
    let expected = Coverage::new(&Kernel::new(RADIUS)).behind(0.7);
    for x in [0.0, 0.3, 7.0, 19.9] {
        let (part, gradient) = outlines.coverage(Vector::new(x, 2.7), Moment::End);
        let expected_part = expected.0 - Coverage::new(&Kernel::new(RADIUS)).behind(4.7).0;
        assert!((part - expected_part).abs() < 1e-3, "{x}: {part} {expected_part}");
        assert!((gradient - Vector::new(0.0, expected.1)).length() < 3e-3, "{x}: {gradient}");
    }
}

#[test]
fn points_inside_are_found() {
    let shape = star();
    let outlines = outline(shape.clone(), 0.0, None);
    let points: Vec<Vector> = points().collect();
    let mut found = vec![false; points.len()];
    outlines.each_inside(&points, |k, body| {
        assert_eq!(body, 0);
        found[k] = true;
    });
    assert!(points.iter().zip(found).all(|(x, found)| found == shape.contains(wide(*x))));
}

#[test]
fn sides_on_which_two_outlines_touch_are_not_seen() {
    let whole = outline(Shape::rectangle(12.0, 6.0), 0.0, Some(1.0));
    let mut halves = Outlines::new(Kernel::new(RADIUS), Some(1.0), Periodic::NONE);
    let half = |body| OutlineSpec { body, shape: Shape::rectangle(6.0, 6.0), still: true, fixed: true };
    halves.set([half(0), half(1)].into_iter());
    let place = |x: f64| [Place { position: Vector64::new(x, 0.0), axis: Vector64::X }; 2];
    halves.place(|body| place(if body == 0 { -3.0 } else { 3.0 }));
    halves.find_touching();
    for x in [-2.0, -0.3, -0.1, 0.1, 0.4, 1.7] {
        let at = Vector::new(x, 3.4);
        let ((part, gradient), (expected, along)) = (halves.coverage(at, Moment::End), whole.coverage(at, Moment::End));
        assert!((part - expected).abs() < 1e-4, "{x}: {part} {expected}");
        assert!((gradient - along).length() < 1e-4, "{x}: {gradient} {along}");
        halves.each_near(at, Moment::End, |near| assert!(near.gradient.x.abs() < 1e-5, "no side to a joint"));
    }
}
