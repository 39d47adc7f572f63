//! The shapes of static walls.

use super::Coverage;
use crate::math::{Real, Vector, Vector64, real, vector};
use crate::observe::WallOutline;
use crate::scene::{HalfPlane, Obstacle, Scene, Side, Slip, Tank, body_friction};

mod behind;
mod rectangle;
mod surfaces;

/// Penetration of a point in a wall, and the direction out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Direction out of the wall, of length 1.
    pub normal: Vector,
    /// Distance to the surface, positive inside the wall \[m].
    pub depth: Real,
    /// Coulomb friction coefficient.
    pub friction: Real,
    /// Number of the wall among the measured ones.
    pub measured: Option<u16>,
}

/// Effect of a no-slip wall on a viscous fluid at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear {
    /// Twice the marginal of the kernel at the wall over the distance to it [1/m^2].
    pub rate: Real,
    /// Velocity of the wall [m/s].
    pub velocity: Vector,
    /// Number of the wall among the measured ones.
    pub measured: Option<u16>,
}

#[derive(Clone, Copy, Debug)]
struct Plane {
    point: Vector,
    normal: Vector,
    friction: Real,
    /// The same for bodies that are particles.
    body_friction: Real,
    slip: Slip,
    velocity: Vector,
    measured: Option<u16>,
}

/// Corner of two walls of a tank: the part behind both is counted once, not twice.
#[derive(Clone, Copy, Debug)]
struct Corner {
    point: Vector,
    /// Signs that map the outside of both walls to the quadrant x < a, y < b.
    outward: Vector,
    /// The measured indices of the vertical and of the horizontal wall.
    measured: [Option<u16>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Rectangle {
    min: Vector,
    max: Vector,
    friction: Real,
    /// The same for bodies that are particles.
    body_friction: Real,
    slip: Slip,
    measured: Option<u16>,
}

/// All static walls of a scene.
#[derive(Clone, Debug, Default)]
pub struct Walls {
    planes: Vec<Plane>,
    corners: Vec<Corner>,
    rectangles: Vec<Rectangle>,
    outlines: Vec<WallOutline>,
    /// Names of the walls whose forces are measured.
    measured: Vec<String>,
    crowded: bool,
}

impl Walls {
    /// The walls of a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut walls = Walls::default();
        scene.half_plane.iter().for_each(|wall| walls.add_half_plane(wall));
        scene.tank.iter().for_each(|tank| walls.add_tank(tank));
        scene.obstacle.iter().for_each(|obstacle| walls.add_obstacle(obstacle));
        walls.note_crowding();
        walls
    }

    /// Whether there are no walls.
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty() && self.rectangles.is_empty()
    }

    /// A wall coordinate along each axis, if there is one: grids are aligned with it \[m].
    pub(crate) fn anchor(&self) -> Vector {
        let along = |axis: usize| {
            let wall = self.planes.iter().find(|plane| plane.normal[axis].abs() == 1.0);
            wall.map_or(0.0, |plane| plane.point[axis])
        };
        Vector::new(along(0), along(1))
    }

    /// Names of the walls whose forces are measured.
    pub fn measured(&self) -> &[String] {
        &self.measured
    }

    /// The number under which a wall is measured, if it has a name.
    fn measure(&mut self, name: String) -> Option<u16> {
        let number = u16::try_from(self.measured.len()).ok()?;
        self.measured.push(name);
        Some(number)
    }

    /// Lines to draw.
    pub fn outlines(&self) -> &[WallOutline] {
        &self.outlines
    }

    /// The walls that hold the end `x` of a path from `start` inside them, planes first, and the boxes that
    /// the path passes through.
    pub fn hits(&self, start: Vector, x: Vector) -> impl Iterator<Item = Hit> + '_ {
        let planes = self.planes.iter().filter_map(move |plane| plane.hit(x));
        planes.chain(self.rectangles.iter().filter_map(move |rectangle| rectangle.hit_on_path(start, x)))
    }

    /// The walls that a disc about `x`, a sample of a body, overlaps: the overlap, and the direction out.
    pub fn touches(&self, x: Vector, radius: Real) -> impl Iterator<Item = Hit> + '_ {
        let planes = self.planes.iter().filter_map(move |plane| {
            let hit = plane.hit(x - plane.normal * radius)?;
            Some(Hit { friction: plane.body_friction, ..hit })
        });
        planes.chain(self.rectangles.iter().filter_map(move |rectangle| rectangle.touch(x, radius)))
    }

    /// Square of the largest speed of a wall along itself [m^2/s^2].
    pub fn fastest_squared(&self) -> Real {
        self.planes.iter().map(|plane| plane.velocity.length_squared()).fold(0.0, Real::max)
    }

    /// Whether any wall is a no-slip wall for viscous fluids.
    pub fn any_without_slip(&self) -> bool {
        let planes = self.planes.iter().map(|plane| plane.slip);
        planes.chain(self.rectangles.iter().map(|rectangle| rectangle.slip)).any(|slip| slip == Slip::None)
    }

    /// The no-slip walls within the kernel radius of `x`; distances are at least `least`.
    ///
    /// The velocity goes on linearly behind the wall, so that it is the wall's at the wall (Morris et
    /// al. 1997). Integrated over the half-plane, the Laplacian of Brookshaw 1985 then is
    /// 2 (v_wall - v) M(d)/d, with M the marginal of the kernel at the distance d.
    pub fn shears<'a>(&'a self, x: Vector, least: Real, coverage: &'a Coverage) -> impl Iterator<Item = Shear> + 'a {
        let planes = self.planes.iter().filter(|plane| plane.slip == Slip::None).filter_map(move |plane| {
            let distance = (x - plane.point).dot(plane.normal);
            let marginal = -coverage.behind(distance.max(0.0)).1;
            let near = distance < coverage.radius();
            let rate = 2.0 * marginal / distance.max(least);
            near.then_some(Shear { rate, velocity: plane.velocity, measured: plane.measured })
        });
        let rectangles = self.rectangles.iter().filter(|rectangle| rectangle.slip == Slip::None);
        let rectangles = rectangles.filter_map(move |rectangle| {
            let distance = (x - x.clamp(rectangle.min, rectangle.max)).length();
            let marginal = rectangle.coverage(x, coverage).1.length();
            let rate = 2.0 * marginal / distance.max(least);
            (marginal > 0.0).then_some(Shear { rate, velocity: Vector::ZERO, measured: rectangle.measured })
        });
        planes.chain(rectangles)
    }

    /// Moves the end `x` of a path from `start` out of all walls; where there is no path, both are the same.
    pub fn clamp(&self, start: Vector, mut x: Vector) -> Vector {
        for plane in &self.planes {
            if let Some(hit) = plane.hit(x) {
                x += hit.normal * hit.depth;
            }
        }
        for rectangle in &self.rectangles {
            if let Some(hit) = rectangle.hit_on_path(start, x) {
                x += hit.normal * hit.depth;
            }
        }
        if self.crowded {
            self.turn_out_again(start, x, |_, push| x += push);
        }
        x
    }

    /// Least extent of a box \[m]: a shorter path in a substep cannot pass through one. Infinite without boxes.
    pub(crate) fn thinnest(&self) -> Real {
        let extents = self.rectangles.iter().map(|rectangle| (rectangle.max - rectangle.min).min_element());
        extents.fold(Real::INFINITY, Real::min)
    }

    /// Whether a path turned out of one wall may enter another: at corners that are not square, and at boxes.
    pub(crate) fn are_crowded(&self) -> bool {
        self.crowded
    }

    /// Tells the pushes that turn a path from `start` to `x` out of the walls into which it was turned out of others.
    /// Where two walls meet at a sharp angle the path goes on along the first to where they meet.
    #[cold]
    pub(crate) fn turn_out_again(&self, start: Vector, mut x: Vector, mut feel: impl FnMut(&Hit, Vector)) {
        let mut last = Vector::ZERO;
        for _ in 0..4 {
            let deepest = self.hits(start, x).max_by(|a, b| a.depth.total_cmp(&b.depth));
            let Some(hit) = deepest else { return };
            let facing = hit.normal.dot(last).min(0.0);
            let apart = 1.0 - facing * facing;
            let along = if apart > 1e-3 { (hit.normal - last * facing) / apart } else { hit.normal };
            let push = along * hit.depth;
            x += push;
            feel(&hit, push);
            last = hit.normal;
        }
    }

    fn note_crowding(&mut self) {
        let skew = |a: &Plane, b: &Plane| (-0.999..-0.001).contains(&a.normal.dot(b.normal));
        let planes = || self.planes.iter();
        self.crowded = !self.rectangles.is_empty() || planes().any(|a| planes().any(|b| skew(a, b)));
    }

    fn add_half_plane(&mut self, wall: &HalfPlane) {
        let (point, normal) = (Vector64::from(wall.point), Vector64::from(wall.normal).normalize());
        let velocity = Vector64::from(wall.velocity);
        let along = velocity - normal * velocity.dot(normal);
        let measured = if wall.name.is_empty() { None } else { self.measure(wall.name.clone()) };
        self.planes.push(Plane {
            point: vector(point),
            normal: vector(normal),
            friction: real(wall.friction.unwrap_or(0.0)),
            body_friction: real(body_friction(wall.friction)),
            slip: wall.slip,
            velocity: vector(along),
            measured,
        });
        let along = normal.perp() * 1e3;
        self.outlines.push(WallOutline { points: vec![point + along, point - along], closed: false, endless: true });
    }

    fn add_tank(&mut self, tank: &Tank) {
        let (min, max) = (Vector64::from(tank.min), Vector64::from(tank.max));
        let sides = [
            (Side::Left, min, Vector64::X),
            (Side::Right, max, -Vector64::X),
            (Side::Bottom, min, Vector64::Y),
            (Side::Top, max, -Vector64::Y),
        ];
        let closed = |side: Side| !tank.open.contains(&side);
        let mut numbers = [None; 4];
        for (side, point, normal) in sides {
            if closed(side) {
                if !tank.name.is_empty() {
                    numbers[side as usize] = self.measure(format!("{} {}", tank.name, side.name()));
                }
                self.planes.push(Plane {
                    point: vector(point),
                    normal: vector(normal),
                    friction: real(tank.friction.unwrap_or(0.0)),
                    body_friction: real(body_friction(tank.friction)),
                    slip: if tank.without_slip.contains(&side) { Slip::None } else { tank.slip },
                    velocity: Vector::ZERO,
                    measured: numbers[side as usize],
                });
            }
        }
        for (horizontal, x, sign_x) in [(Side::Left, min.x, -1.0), (Side::Right, max.x, 1.0)] {
            for (vertical, y, sign_y) in [(Side::Bottom, min.y, -1.0), (Side::Top, max.y, 1.0)] {
                if closed(horizontal) && closed(vertical) {
                    let (point, outward) = (Vector64::new(x, y), Vector64::new(sign_x, sign_y));
                    let measured = [numbers[horizontal as usize], numbers[vertical as usize]];
                    self.corners.push(Corner { point: vector(point), outward: vector(outward), measured });
                }
            }
        }
        self.outlines.extend(tank_outlines(min, max, &tank.open));
    }

    fn add_obstacle(&mut self, obstacle: &Obstacle) {
        let (min, max) = (Vector64::from(obstacle.min), Vector64::from(obstacle.max));
        let measured = if obstacle.name.is_empty() { None } else { self.measure(obstacle.name.clone()) };
        self.rectangles.push(Rectangle {
            measured,
            min: vector(min),
            max: vector(max),
            friction: real(obstacle.friction.unwrap_or(0.0)),
            body_friction: real(body_friction(obstacle.friction)),
            slip: obstacle.slip,
        });
        let mut points = ring(min, max).to_vec();
        points.reverse();
        self.outlines.push(WallOutline { points, closed: true, endless: false });
    }
}

impl Plane {
    #[inline]
    fn hit(&self, x: Vector) -> Option<Hit> {
        let depth = -(x - self.point).dot(self.normal);
        (depth > 0.0).then_some(Hit { normal: self.normal, depth, friction: self.friction, measured: self.measured })
    }
}

/// Corners of a rectangle, counter-clockwise from the lower left one.
fn ring(min: Vector64, max: Vector64) -> [Vector64; 4] {
    [min, Vector64::new(max.x, min.y), max, Vector64::new(min.x, max.y)]
}

/// The closed sides of a tank, joined into the smallest number of lines.
fn tank_outlines(min: Vector64, max: Vector64, open: &[Side]) -> Vec<WallOutline> {
    let corners = ring(min, max);
    let sides = [Side::Bottom, Side::Right, Side::Top, Side::Left];
    let closed = sides.map(|side| !open.contains(&side));
    let Some(gap) = closed.iter().position(|side| !side) else {
        return vec![WallOutline { points: corners.to_vec(), closed: true, endless: false }];
    };
    let mut outlines: Vec<WallOutline> = Vec::new();
    let mut joined = false;
    for side in (1..=4).map(|step| (gap + step) % 4) {
        if !closed[side] {
            joined = false;
            continue;
        }
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        match outlines.last_mut() {
            Some(line) if joined => line.points.push(to),
            _ => outlines.push(WallOutline { points: vec![from, to], closed: false, endless: false }),
        }
        joined = true;
    }
    outlines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tank(open: Vec<Side>) -> Walls {
        let tank = Tank { open, ..Tank::new([0.0, 0.0], [10.0, 8.0]) };
        Walls::new(&Scene { tank: vec![tank], ..Scene::default() })
    }

    #[test]
    fn open_side_lets_particles_through() {
        let walls = tank(vec![Side::Top]);
        let clamp = |x: Vector| walls.clamp(x, x);
        assert_eq!(clamp(Vector::new(5.0, 20.0)), Vector::new(5.0, 20.0));
        assert_eq!(clamp(Vector::new(-1.0, -2.0)), Vector::ZERO);
        assert_eq!(walls.outlines().len(), 1);
        assert_eq!(walls.outlines()[0].points.len(), 4);
    }

    #[test]
    fn shortest_way_leads_out_of_an_obstacle() {
        let obstacle = Obstacle::new([1.0, 1.0], [2.0, 4.0]);
        let walls = Walls::new(&Scene { obstacle: vec![obstacle], ..Scene::default() });
        let inside = Vector::new(1.1, 2.0);
        assert_eq!(walls.clamp(inside, inside), Vector::new(1.0, 2.0));
        for beyond in [1.9, 2.0, 7.0] {
            let thrown = walls.clamp(Vector::new(0.9, 2.0), Vector::new(beyond, 2.5));
            assert_eq!(thrown, Vector::new(1.0, 2.5), "out by the side it came in");
        }
    }
}
