//! Outlines of bodies as walls of the fluid: the part of a kernel inside them, its gradient, and who is inside.

mod fixed;
mod polygon;
mod round;
#[cfg(test)]
mod tests;
mod touching;

use super::EdgeTables;
use crate::kernel::{Kernel, WendlandC2};
use crate::math::{Real, Vector, Vector64, real, vector, wide};
use crate::periodic::Periodic;
use crate::shapes::Shape;
use polygon::{Polygon, Seen};
use round::Round;

/// Where an outline is: the place of its origin, and the direction of its x axis, of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Place of the origin \[m].
    pub position: Vector64,
    /// Direction of the x axis.
    pub axis: Vector64,
}

/// A moment of the running substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// Its start.
    Start,
    /// Its predicted end.
    End,
}

/// The outlines that the fluids of a run touch.
#[derive(Clone, Debug)]
pub struct Outlines {
    kernel: Kernel<WendlandC2>,
    tables: Option<EdgeTables>,
    upheld: Option<f64>,
    periodic: Periodic,
    spots: Vec<Spot>,
    /// Advances whenever outlines come, go or are put elsewhere by an edit.
    version: u64,
}

/// An outline to be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineSpec {
    /// Its body.
    pub body: u32,
    /// About the centre of mass.
    pub shape: Shape,
    /// Whether it never moves.
    pub still: bool,
    /// Whether it never moves and is thick enough to be a wall of a grid.
    pub fixed: bool,
}

/// One outline.
#[derive(Clone, Debug)]
struct Spot {
    of: OutlineSpec,
    form: Form,
    /// Corners about the centre of mass, with those where sides begin that lie against other bodies, and which sides
    /// these are; empty for a disc.
    corners: Vec<Vector64>,
    inner: Vec<bool>,
    /// At the start and at the end of the substep.
    places: [Place; 2],
    /// Points farther than this from the origin see nothing of it \[m].
    reach: Real,
}

#[derive(Clone, Debug)]
enum Form {
    Polygon(Polygon),
    Round(Round),
}

/// An outline near a point.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Number of the outline.
    pub outline: usize,
    /// Part of the kernel inside.
    pub part: Real,
    /// Its gradient [1/m].
    pub gradient: Vector,
}

/// How an outline drags a fluid that does not slip along it.
#[derive(Clone, Copy, Debug)]
pub struct OutlineShear {
    /// Number of the outline.
    pub outline: usize,
    /// Acceleration per viscosity and difference of velocities [1/m^2].
    pub rate: Real,
    /// From the origin of the outline to the point \[m].
    pub arm: Vector64,
}

impl Outlines {
    /// None yet, for this kernel and liquids of this spacing, if walls are to [uphold](super::Coverage::upholding) them
    /// \[m].
    pub fn new(kernel: Kernel<WendlandC2>, upheld: Option<f64>, periodic: Periodic) -> Self {
        Outlines { kernel, tables: None, upheld, periodic, spots: Vec::new(), version: 0 }
    }

    /// Whether there are no outlines.
    pub fn is_empty(&self) -> bool {
        self.spots.is_empty()
    }

    /// Number of outlines.
    pub fn len(&self) -> usize {
        self.spots.len()
    }

    /// Takes these outlines in place of the old ones: bodies in the order of their ids, and their shapes about their
    /// centres of mass.
    pub fn set(&mut self, outlines: impl Iterator<Item = OutlineSpec>) {
        self.version += 1;
        let mut known = std::mem::take(&mut self.spots).into_iter().peekable();
        let reach = f64::from(self.kernel.radius());
        for of in outlines {
            while known.next_if(|spot| spot.of.body < of.body).is_some() {}
            if let Some(spot) = known.next_if(|spot| spot.of == of) {
                self.spots.push(spot);
                continue;
            }
            let tables = self.tables.get_or_insert_with(|| EdgeTables::new(&self.kernel, self.upheld));
            let (form, corners) = match &of.shape {
                Shape::Disc { radius } => (Form::Round(Round::new(*radius, &self.kernel, tables)), Vec::new()),
                Shape::Polygon(corners) => (Form::Polygon(Polygon::new(corners, &[], reach)), corners.clone()),
            };
            let place = Place { position: Vector64::ZERO, axis: Vector64::X };
            let reach = real(of.shape.bounding_radius() + reach);
            self.spots.push(Spot { of, form, corners, inner: Vec::new(), places: [place; 2], reach });
        }
    }

    /// Puts the outlines where their bodies are at the start and at the end of a substep.
    pub fn place(&mut self, places: impl Fn(u32) -> [Place; 2]) {
        self.spots.iter_mut().for_each(|spot| spot.places = places(spot.of.body));
    }

    /// The body of an outline.
    pub fn body(&self, outline: usize) -> u32 {
        self.spots[outline].of.body
    }

    /// The way from the origin of an outline to a point, the shortest where the domain repeats \[m].
    pub fn arm(&self, outline: usize, x: Vector, moment: Moment) -> Vector64 {
        let apart = wide(x) - self.spots[outline].places[moment as usize].position;
        if self.periodic.any() { wide(self.periodic.min_image(vector(apart))) } else { apart }
    }

    /// Part of the kernel at `x` that lies inside outlines, and its gradient [1/m].
    pub fn coverage(&self, x: Vector, moment: Moment) -> (Real, Vector) {
        let mut sum = (0.0, Vector::ZERO);
        self.each_near(x, moment, |near| sum = (sum.0 + near.part, sum.1 + near.gradient));
        sum
    }

    /// Visits what a point sees of each outline near it.
    pub fn each_near(&self, x: Vector, moment: Moment, mut visit: impl FnMut(Near)) {
        for outline in 0..self.spots.len() {
            self.see(outline, x, moment, &mut visit);
        }
    }

    /// Visits what each of some points sees of each outline: cheap where the points are together and far from most.
    pub fn each_seen(&self, points: &[Vector], moment: Moment, mut visit: impl FnMut(usize, Near)) {
        for outline in self.met(points, moment) {
            for (k, &x) in points.iter().enumerate() {
                self.see(outline, x, moment, &mut |near| visit(k, near));
            }
        }
    }

    /// Visits how outlines drag a fluid that does not slip along them, at each of some points at the end of the substep.
    /// Distances are at least `least`.
    ///
    /// As at [walls](super::Walls::shears) the velocity relative to the body goes on linearly behind the surface, by
    /// which the rate is 2 |grad part|/d.
    pub fn shears(&self, points: &[Vector], least: Real, mut visit: impl FnMut(usize, OutlineShear)) {
        let Some(tables) = &self.tables else { return };
        for outline in self.met(points, Moment::End) {
            let spot = &self.spots[outline];
            let axis = spot.places[Moment::End as usize].axis;
            for (k, &x) in points.iter().enumerate() {
                spot.each_image(x, Moment::End, self.periodic, |x| {
                    let Some(Seen { gradient, .. }) = spot.form.seen(x, tables) else { return };
                    let rate = 2.0 * gradient.length() / spot.form.distance(x).max(least);
                    if rate > 0.0 {
                        visit(k, OutlineShear { outline, rate, arm: axis.rotate(wide(x)) });
                    }
                });
            }
        }
    }

    /// Visits the points that lie inside outlines at the end of the substep, and the bodies.
    pub fn each_inside(&self, points: &[Vector], mut visit: impl FnMut(usize, u32)) {
        for outline in self.met(points, Moment::End) {
            let spot = &self.spots[outline];
            for (k, &x) in points.iter().enumerate() {
                let mut inside = false;
                spot.each_image(x, Moment::End, self.periodic, |x| inside |= spot.form.distance(x) < 0.0);
                if inside {
                    visit(k, spot.of.body);
                }
            }
        }
    }

    /// Visits the contribution of each edge near `x` to the gradient of the coverage there [1/m], and the vector from
    /// its line to `x` \[m].
    pub(crate) fn pushes(&self, x: Vector, mut visit: impl FnMut(Vector, Vector)) {
        let Some(tables) = &self.tables else { return };
        for spot in &self.spots {
            let axis = vector(spot.places[1].axis);
            spot.each_image(x, Moment::End, self.periodic, |x| match &spot.form {
                Form::Polygon(polygon) => {
                    polygon.pushes(x, tables, |gradient, way| visit(axis.rotate(gradient), axis.rotate(way)));
                }
                Form::Round(round) => {
                    if let Some(seen) = round.seen(x) {
                        let way = x.normalize_or_zero() * round.distance(x);
                        visit(axis.rotate(seen.gradient), axis.rotate(way));
                    }
                }
            });
        }
    }

    /// The outlines whose surroundings meet the box about some points.
    fn met(&self, points: &[Vector], moment: Moment) -> impl Iterator<Item = usize> + '_ {
        let start = (Vector::INFINITY, Vector::NEG_INFINITY);
        let (low, high) = points.iter().fold(start, |(low, high), x| (low.min(*x), high.max(*x)));
        let everywhere = self.periodic.any();
        (0..self.spots.len()).filter(move |&outline| {
            let spot = &self.spots[outline];
            let (origin, reach) = (spot.places[moment as usize].position, f64::from(spot.reach));
            let nearest = origin.clamp(wide(low), wide(high).max(wide(low)));
            everywhere || (nearest - origin).length_squared() < reach * reach
        })
    }

    fn see(&self, outline: usize, x: Vector, moment: Moment, visit: &mut impl FnMut(Near)) {
        let (Some(tables), spot) = (&self.tables, &self.spots[outline]) else { return };
        let axis = vector(spot.places[moment as usize].axis);
        spot.each_image(x, moment, self.periodic, |x| {
            if let Some(Seen { part, gradient }) = spot.form.seen(x, tables) {
                visit(Near { outline, part, gradient: axis.rotate(gradient) });
            }
        });
    }

    /// Memory held \[bytes].
    pub(crate) fn memory_bytes(&self) -> usize {
        self.spots.iter().map(|spot| size_of::<Spot>() + spot.form.memory_bytes()).sum()
    }
}

impl Spot {
    /// Visits a point in the coordinates of the body, and the images of it that are near.
    #[inline]
    fn each_image(&self, x: Vector, moment: Moment, periodic: Periodic, mut visit: impl FnMut(Vector)) {
        let place = &self.places[moment as usize];
        let apart = wide(x) - place.position;
        let mut near = |apart: Vector64| {
            if apart.length_squared() < f64::from(self.reach) * f64::from(self.reach) {
                visit(vector(place.axis.conjugated().rotate(apart)));
            }
        };
        if !periodic.any() {
            return near(apart);
        }
        let shifts = |axis: Option<crate::periodic::PeriodicAxis>| {
            let length = axis.map_or(0.0, |axis| f64::from(axis.length));
            let count = if axis.is_some() { 1 } else { 0 };
            (-count..=count).map(move |k| f64::from(k) * length)
        };
        for right in shifts(periodic.x) {
            for up in shifts(periodic.y) {
                near(apart + Vector64::new(right, up));
            }
        }
    }
}

/// The inverse of a rotation that is written as a direction.
trait Conjugate {
    fn conjugated(self) -> Self;
}

impl Conjugate for Vector64 {
    fn conjugated(self) -> Vector64 {
        Vector64::new(self.x, -self.y)
    }
}

impl Form {
    fn seen(&self, x: Vector, tables: &EdgeTables) -> Option<Seen> {
        match self {
            Form::Polygon(polygon) => polygon.seen(x, tables),
            Form::Round(round) => round.seen(x),
        }
    }

    fn memory_bytes(&self) -> usize {
        match self {
            Form::Polygon(polygon) => polygon.memory_bytes(),
            Form::Round(round) => round.memory_bytes(),
        }
    }
}
