//! A polygon that a fluid touches: its edges, and which of them are near a point.

use super::super::edges::{EdgeTables, Turn, moved_corner};
use crate::math::{Real, Vector, Vector64, real, smaller, vector};
use crate::shapes::edges;

/// Most cells of an index.
const MOST_CELLS: f64 = 65_536.0;
/// Parts of a kernel smaller than this do not tell on which side of an outline its centre lies.
const UNCLEAR: Real = 0.02;

/// An edge in the coordinates of its body.
#[derive(Clone, Copy, Debug)]
struct Edge {
    from: Vector,
    /// Direction, of length 1, and the direction out.
    along: Vector,
    out: Vector,
    length: Real,
    /// Directions out of the edges before and after it, and the turns at both corners.
    before: Vector,
    after: Vector,
    first: Turn,
    last: Turn,
    /// Whether another body lies against it: it is no surface.
    inner: bool,
    /// Whether that holds for the edges before and after it.
    beside: [bool; 2],
}

/// The edges of a polygon, and those within the kernel radius of each cell around it.
#[derive(Clone, Debug)]
pub(super) struct Polygon {
    edges: Vec<Edge>,
    low: Vector,
    inverse_cell: Real,
    columns: usize,
    rows: usize,
    /// Edges near each cell: from its number to the next.
    starts: Vec<u32>,
    near: Vec<u32>,
    /// Whether a cell without edges near lies inside.
    inside: Vec<bool>,
}

/// The part of the kernel around a point that lies inside a polygon, with its gradient.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Part of the kernel inside, and its gradient [1/m].
    pub part: Real,
    pub gradient: Vector,
}

impl Polygon {
    /// A simple polygon of counter-clockwise corners; points farther than `reach` from it see nothing of it \[m]. `inner`
    /// tells the edges against which other bodies lie.
    pub fn new(corners: &[Vector64], inner: &[bool], reach: f64) -> Polygon {
        let (low, high) = corners.iter().fold((corners[0], corners[0]), |(low, high), c| (low.min(*c), high.max(*c)));
        let (low, high) = (low - reach, high + reach);
        let extent = high - low;
        let cell = reach.max((extent.x * extent.y / MOST_CELLS).sqrt());
        let count = |extent: f64| ((extent / cell).ceil() as usize).max(1);
        let mut polygon = Polygon {
            edges: list(corners, inner),
            low: vector(low),
            inverse_cell: real(1.0 / cell),
            columns: count(extent.x),
            rows: count(extent.y),
            starts: vec![0],
            near: Vec::new(),
            inside: Vec::new(),
        };
        let shape = crate::shapes::Shape::Polygon(corners.to_vec());
        for place in 0..polygon.columns * polygon.rows {
            let corner = low + Vector64::new((place % polygon.columns) as f64, (place / polygon.columns) as f64) * cell;
            let (middle, half) = (corner + 0.5 * cell, 0.5 * cell * std::f64::consts::SQRT_2);
            for (number, (from, to)) in edges(corners).enumerate() {
                let t = ((middle - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
                if (middle - from.lerp(to, t)).length() <= reach + half {
                    polygon.near.push(number as u32);
                }
            }
            polygon.starts.push(polygon.near.len() as u32);
            polygon.inside.push(shape.contains(middle));
        }
        polygon
    }

    /// The edges near a point, or whether it lies inside where there are none; `None` where it sees nothing.
    fn near(&self, x: Vector) -> Option<Result<&[u32], bool>> {
        let place = (x - self.low) * self.inverse_cell;
        if !(place.x >= 0.0 && place.y >= 0.0 && place.x < self.columns as Real && place.y < self.rows as Real) {
            return None;
        }
        let cell = place.y as usize * self.columns + place.x as usize;
        let near = &self.near[self.starts[cell] as usize..self.starts[cell + 1] as usize];
        match (near.is_empty(), self.inside[cell]) {
            (false, _) => Some(Ok(near)),
            (true, true) => Some(Err(true)),
            (true, false) => None,
        }
    }

    /// The part of the kernel about a point that lies inside, and its gradient.
    pub fn seen(&self, x: Vector, tables: &EdgeTables) -> Option<Seen> {
        let near = match self.near(x)? {
            Ok(near) => near,
            Err(_) => return Some(Seen { part: 1.0, gradient: Vector::ZERO }),
        };
        let (mut part, mut gradient) = (0.0, Vector::ZERO);
        self.each_flow(near, x, tables, |added, slope, edge, _| {
            part += added;
            // The gradients on both sides of a joint cancel, and would only be felt as a force between the bodies.
            if !edge.inner {
                gradient += edge.out * slope;
            }
        });
        // About a point inside the flows leave out the whole of the kernel.
        if part < -UNCLEAR || (part < UNCLEAR && self.signed(near, x) < 0.0) {
            part += 1.0;
        }
        Some(Seen { part, gradient })
    }

    /// Visits what each edge adds to the gradient at a point, and the way from its line to the point.
    pub fn pushes(&self, x: Vector, tables: &EdgeTables, mut visit: impl FnMut(Vector, Vector)) {
        if let Some(Ok(near)) = self.near(x) {
            self.each_flow(near, x, tables, |_, slope, edge, distance| {
                if slope != 0.0 && !edge.inner {
                    visit(edge.out * slope, edge.out * distance);
                }
            });
        }
    }

    /// The distance from the outline, negative inside; at most about the reach.
    pub fn distance(&self, x: Vector) -> Real {
        match self.near(x) {
            None => Real::INFINITY,
            Some(Err(_)) => Real::NEG_INFINITY,
            Some(Ok(near)) => self.signed(near, x),
        }
    }

    fn each_flow(&self, near: &[u32], x: Vector, tables: &EdgeTables, mut visit: impl FnMut(Real, Real, &Edge, Real)) {
        let stretch = |distance: Real| {
            let (seen, slope) = tables.stretch.at(f64::from(distance));
            (real(seen), real(slope))
        };
        let moved = |distance: Real, inner: bool| if inner { 0.0 } else { stretch(distance).0 - distance };
        for edge in near.iter().map(|&number| &self.edges[number as usize]) {
            let apart = x - edge.from;
            let distance = apart.dot(edge.out);
            let (seen, grown) = if edge.inner { (distance, 1.0) } else { stretch(distance) };
            if seen.abs() >= tables.radius() {
                continue;
            }
            let from = -apart.dot(edge.along);
            let to = from + edge.length;
            let own = seen - distance;
            let before = moved(apart.dot(edge.before), edge.beside[0]);
            let after = moved((apart - edge.along * edge.length).dot(edge.after), edge.beside[1]);
            let ends = [
                moved_corner(from, own, before, edge.first.back(), tables.radius()),
                moved_corner(to, own, after, edge.last, tables.radius()),
            ];
            let flow = tables.flow(seen, ends);
            visit(flow.part, flow.slope * grown, edge, distance);
        }
    }

    /// The distance from the nearest of some edges, negative inside.
    fn signed(&self, near: &[u32], x: Vector) -> Real {
        let (mut best, mut side) = (Real::INFINITY, 1.0);
        for edge in near.iter().map(|&number| &self.edges[number as usize]) {
            let apart = x - edge.from;
            let place = apart.dot(edge.along);
            let away = apart - edge.along * place.clamp(0.0, edge.length);
            if away.length_squared() < best {
                best = away.length_squared();
                // Beside a corner the mean of both directions out tells the side.
                let out = match place {
                    place if place < 0.0 => edge.out + edge.before,
                    place if place > edge.length => edge.out + edge.after,
                    _ => edge.out,
                };
                side = if away.dot(out) < 0.0 { -1.0 } else { 1.0 };
            }
        }
        smaller(best, Real::MAX).sqrt() * side
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        use crate::bytes::held;
        held(&self.edges) + held(&self.starts) + held(&self.near) + held(&self.inside)
    }
}

fn list(corners: &[Vector64], inner: &[bool]) -> Vec<Edge> {
    let count = corners.len();
    let direction = |k: usize| (corners[(k + 1) % count] - corners[k % count]).normalize();
    let is_inner = |k: usize| inner.get(k).copied().unwrap_or(false);
    let out = |along: Vector64| vector(Vector64::new(along.y, -along.x));
    let edge = |k: usize| {
        let (before, along, after) = (direction(k + count - 1), direction(k), direction(k + 1));
        Edge {
            from: vector(corners[k]),
            along: vector(along),
            out: out(along),
            length: real((corners[(k + 1) % count] - corners[k]).length()),
            before: out(before),
            after: out(after),
            first: Turn::new(vector(before), vector(along)),
            last: Turn::new(vector(along), vector(after)),
            inner: is_inner(k),
            beside: [is_inner((k + count - 1) % count), is_inner((k + 1) % count)],
        }
    };
    (0..count).map(edge).collect()
}
