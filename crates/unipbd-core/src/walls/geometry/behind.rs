//! The part of a kernel behind walls, and a fast test for it.

use super::{Rectangle, Walls};
use crate::math::{Real, Vector, larger, smaller};
use crate::walls::Coverage;

impl Walls {
    /// Part of a kernel at `x` that lies inside walls, and its gradient [1/m].
    pub fn coverage(&self, x: Vector, coverage: &Coverage) -> (Real, Vector) {
        let reach = coverage.radius();
        let (mut inside, mut gradient) = (0.0, Vector::ZERO);
        for plane in &self.planes {
            let distance = (x - plane.point).dot(plane.normal);
            if distance < reach {
                let (part, slope) = coverage.behind(distance);
                inside += part;
                gradient += plane.normal * slope;
            }
        }
        if inside > 0.0 {
            for corner in &self.corners {
                let a = (x - corner.point) * corner.outward;
                if a.min_element() > -reach {
                    let (part, slope) = coverage.quadrant(a.x, a.y);
                    inside -= part;
                    gradient -= slope * corner.outward;
                }
            }
        }
        for rectangle in &self.rectangles {
            let (part, slope) = rectangle.coverage(x, coverage);
            inside += part;
            gradient += slope;
        }
        (inside, gradient)
    }

    /// The distance of each point to the nearest wall, or a lower bound; negative inside. It is cheap if most points
    /// are far from all walls.
    pub fn distances(&self, points: &[Vector], distances: &mut [Real]) {
        distances.fill(Real::INFINITY);
        for plane in &self.planes {
            for (slot, &x) in distances.iter_mut().zip(points) {
                *slot = smaller((x - plane.point).dot(plane.normal), *slot);
            }
        }
        for rectangle in &self.rectangles {
            for (slot, &x) in distances.iter_mut().zip(points) {
                let (low, high) = (rectangle.min - x, x - rectangle.max);
                *slot = smaller(larger(larger(low.x, high.x), larger(low.y, high.y)), *slot);
            }
        }
    }

    /// The gradient of [`coverage`](Self::coverage), shared out to the measured walls.
    pub fn shares(&self, x: Vector, coverage: &Coverage, mut visit: impl FnMut(u16, Vector)) {
        let reach = coverage.radius();
        for plane in &self.planes {
            let distance = (x - plane.point).dot(plane.normal);
            if let Some(wall) = plane.measured.filter(|_| distance < reach) {
                visit(wall, plane.normal * coverage.behind(distance).1);
            }
        }
        for corner in &self.corners {
            let a = (x - corner.point) * corner.outward;
            if corner.measured != [None; 2] && a.min_element() > -reach {
                let twice = coverage.quadrant(a.x, a.y).1 * corner.outward;
                let parts = [Vector::new(-twice.x, 0.0), Vector::new(0.0, -twice.y)];
                for (wall, part) in corner.measured.into_iter().zip(parts) {
                    wall.into_iter().for_each(|wall| visit(wall, part));
                }
            }
        }
        for rectangle in &self.rectangles {
            if let Some(wall) = rectangle.measured {
                visit(wall, rectangle.coverage(x, coverage).1);
            }
        }
    }

    /// Visits the contribution of each wall near `x` to the gradient of the coverage there [1/m], and the vector from
    /// that wall to `x` \[m].
    pub(crate) fn pushes(&self, x: Vector, coverage: &Coverage, mut visit: impl FnMut(Vector, Vector)) {
        let reach = coverage.radius();
        for plane in &self.planes {
            let distance = (x - plane.point).dot(plane.normal);
            if distance < reach {
                visit(plane.normal * coverage.behind(distance).1, plane.normal * distance);
            }
        }
        for corner in &self.corners {
            let a = (x - corner.point) * corner.outward;
            if a.min_element() > -reach {
                let (twice, way) = (coverage.quadrant(a.x, a.y).1 * corner.outward, a * corner.outward);
                visit(Vector::new(-twice.x, 0.0), Vector::new(way.x, 0.0));
                visit(Vector::new(0.0, -twice.y), Vector::new(0.0, way.y));
            }
        }
        for rectangle in &self.rectangles {
            let gradient = rectangle.coverage(x, coverage).1;
            if gradient != Vector::ZERO {
                visit(gradient, x - x.clamp(rectangle.min, rectangle.max));
            }
        }
    }
}

impl Rectangle {
    pub(super) fn coverage(&self, x: Vector, coverage: &Coverage) -> (Real, Vector) {
        let reach = Vector::splat(coverage.radius());
        let (low, high) = (x - self.min, self.max - x);
        if low.cmple(-reach).any() || high.cmple(-reach).any() {
            return (0.0, Vector::ZERO);
        }
        // The part between two sides is the sum of the parts behind each side, less the whole; along both axes at once.
        let (mut inside, mut gradient) = (1.0, Vector::ZERO);
        for (a, to_x) in [(low.x, 1.0), (high.x, -1.0)] {
            for (b, to_y) in [(low.y, 1.0), (high.y, -1.0)] {
                let (part, slope) = coverage.quadrant(a, b);
                inside += part;
                gradient += slope * Vector::new(to_x, to_y);
            }
        }
        for (a, axis) in [(low.x, Vector::X), (high.x, -Vector::X), (low.y, Vector::Y), (high.y, -Vector::Y)] {
            let (part, slope) = coverage.behind(-a);
            inside -= part;
            gradient += axis * slope;
        }
        (inside, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Kernel;
    use crate::math::real;
    use crate::scene::{Obstacle, Scene, Side, Tank};

    fn tank(open: Vec<Side>) -> Walls {
        let tank = Tank { open, ..Tank::new([0.0, 0.0], [10.0, 8.0]) };
        Walls::new(&Scene { tank: vec![tank], ..Scene::default() })
    }

    /// Kernel inside the walls by brute force.
    fn brute_force(kernel: &Kernel, x: Vector, solid: impl Fn(Vector) -> bool) -> Real {
        let steps = 400;
        let cell = 2.0 * kernel.radius() / steps as Real;
        let mut sum = 0.0;
        for row in 0..steps {
            for column in 0..steps {
                let offset = (Vector::new(column as Real, row as Real) + 0.5) * cell - kernel.radius();
                if solid(x + offset) {
                    sum += f64::from(kernel.value(offset.length()) * cell * cell);
                }
            }
        }
        real(sum)
    }

    #[test]
    fn corner_of_a_tank_counts_what_is_behind_both_walls_once() {
        let (walls, kernel) = (tank(vec![]), Kernel::new(2.5));
        let coverage = Coverage::new(&kernel);
        for x in [Vector::new(0.5, 0.5), Vector::new(1.7, 0.2), Vector::new(9.0, 7.5), Vector::new(5.0, 0.5)] {
            let solid = |p: Vector| p.x < 0.0 || p.y < 0.0 || p.x > 10.0 || p.y > 8.0;
            let expected = brute_force(&kernel, x, solid);
            let (part, gradient) = walls.coverage(x, &coverage);
            assert!((part - expected).abs() < 2e-3, "{x}: {part} {expected}");
            let step = Vector::new(0.05, 0.0);
            let difference = (walls.coverage(x + step, &coverage).0 - walls.coverage(x - step, &coverage).0) / 0.1;
            assert!((gradient.x - difference).abs() < 3e-3, "{x}: {} {difference}", gradient.x);
        }
    }

    #[test]
    fn obstacle_covers_its_rectangle() {
        let obstacle = Obstacle::new([1.0, 1.0], [2.0, 4.0]);
        let walls = Walls::new(&Scene { obstacle: vec![obstacle], ..Scene::default() });
        let kernel = Kernel::new(2.5);
        let coverage = Coverage::new(&kernel);
        for x in [Vector::new(0.5, 0.5), Vector::new(2.4, 2.0), Vector::new(1.5, 4.2)] {
            let expected = brute_force(&kernel, x, |p| p.x > 1.0 && p.x < 2.0 && p.y > 1.0 && p.y < 4.0);
            assert!((walls.coverage(x, &coverage).0 - expected).abs() < 2e-3);
        }
    }

    #[test]
    fn an_obstacle_that_upholds_a_liquid_does_so_on_all_sides() {
        let obstacle = Obstacle::new([-20.0, -15.0], [20.0, 15.0]);
        let walls = Walls::new(&Scene { obstacle: vec![obstacle], ..Scene::default() });
        let coverage = Coverage::upholding(&Kernel::new(2.5), 1.0);
        for distance in [0.1, 0.5, 1.3, 2.4] {
            let (part, slope) = coverage.behind(distance);
            for side in [Vector::X, -Vector::X, Vector::Y, -Vector::Y] {
                let x = side * (side.abs().dot(Vector::new(20.0, 15.0)) + distance);
                let (inside, gradient) = walls.coverage(x, &coverage);
                assert!((inside - part).abs() < 3e-4, "{x}: {inside} {part}");
                assert!((gradient - side * slope).length() < 1e-3, "{x}: {gradient} {slope}");
            }
        }
    }

    #[test]
    fn what_measured_walls_share_is_the_whole_gradient() {
        let tank = Tank { name: "tank".to_owned(), ..Tank::new([0.0, 0.0], [10.0, 8.0]) };
        let walls = Walls::new(&Scene { tank: vec![tank], ..Scene::default() });
        assert_eq!(walls.measured(), ["tank left", "tank right", "tank bottom"]);
        let coverage = Coverage::new(&Kernel::new(2.5));
        for x in [Vector::new(0.5, 0.5), Vector::new(1.7, 0.2), Vector::new(9.0, 0.7), Vector::new(5.0, 0.5)] {
            let mut shared = [Vector::ZERO; 3];
            walls.shares(x, &coverage, |wall, slope| shared[usize::from(wall)] += slope);
            let whole = walls.coverage(x, &coverage).1;
            assert!((shared.iter().sum::<Vector>() - whole).length() < 1e-6, "{x}");
            assert!(shared[0].x <= 0.0 && shared[0].y == 0.0, "the left wall takes what points to the left");
        }
    }

    #[test]
    fn no_point_with_a_wall_within_reach_is_passed_over() {
        let mut walls = tank(vec![Side::Top]);
        walls.add_obstacle(&Obstacle::new([3.0, 2.0], [5.0, 4.0]));
        let coverage = Coverage::new(&Kernel::new(1.5));
        let point = |k: usize| Vector::new((k % 37) as Real * 0.33 - 1.0, (k % 41) as Real * 0.27 - 1.0);
        let points: Vec<_> = (0..1000).map(point).collect();
        let mut distances = vec![0.0; points.len()];
        walls.distances(&points, &mut distances);
        let far = |k: usize| distances[k] >= coverage.radius();
        let inside = |k: usize| walls.coverage(points[k], &coverage).0;
        assert!((0..1000).all(|k| !far(k) || inside(k) == 0.0));
        assert!((0..1000).filter(|&k| far(k)).count() > 50);
        assert!((0..1000).all(|k| (distances[k] < 0.0) == walls.hits(points[k], points[k]).next().is_some()));
    }
}
