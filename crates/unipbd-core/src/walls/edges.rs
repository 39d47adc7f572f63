//! The part of a kernel inside an outline, as a sum over the edges of the outline.
//!
//! W is the divergence of the field M(r) r / (2 pi r^2), M(r) being the part of the kernel within r (divergence
//! theorem). So the part of the kernel inside a polygon is the sum over its edges of the flow of that field through
//! them. With the distance d of the line of an edge and the places s along it from the foot of the perpendicular, that
//! flow is a function of d and s alone; outside of the kernel the field is that of a point source, and the flow an
//! angle. The gradient is exact: a line that moves by dd covers dd times the integral of W along the edge less.
//!
//! Where walls uphold a liquid, distances are stretched as in [`Coverage::upholding`](super::Coverage::upholding): the
//! line of each edge is moved along its normal, and corners are where the moved lines meet.

use super::coverage::{Stretch, simpson};
use crate::kernel::{Kernel, Shape};
use crate::math::{Real, Vector, larger, real, smaller};
use std::f64::consts::PI;

const CELLS: usize = 64;
const NODES: usize = CELLS + 1;
/// Intervals of the radial table.
const RINGS: usize = 2048;

/// Tables of a kernel beside straight edges.
#[derive(Clone, Debug)]
pub struct EdgeTables {
    radius: Real,
    scale: Real,
    pub(super) stretch: Stretch,
    /// Flow through an edge from the foot of the perpendicular, and integral of W along it [1/m], at the nodes of
    /// [0, h]^2: row by distance, column by place along the edge.
    nodes: Vec<[Real; 2]>,
}

/// Contribution of an edge to the part of a kernel inside an outline.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Flow {
    /// Part of the kernel, but for the whole of a kernel whose centre lies inside.
    pub part: Real,
    /// Its derivative by the distance of the line [1/m].
    pub slope: Real,
}

impl EdgeTables {
    /// Tables for this kernel; for walls that uphold the lowest row of a liquid of this spacing, if there is one \[m].
    pub fn new<K: Shape>(kernel: &Kernel<K>, upheld: Option<f64>) -> Self {
        let radius = f64::from(kernel.radius());
        let within = within(kernel);
        let step = radius / CELLS as f64;
        let mut nodes = vec![[0.0; 2]; NODES * NODES];
        for row in 0..NODES {
            let distance = step * row as f64;
            let (mut flow, mut line) = (0.0, 0.0);
            for column in 1..NODES {
                let (from, to) = (step * (column - 1) as f64, step * column as f64);
                flow += simpson(from, to, |s| distance * field(&within, radius, libm::hypot(distance, s)));
                line += simpson(from, to, |s| f64::from(kernel.value(real(libm::hypot(distance, s)))));
                nodes[row * NODES + column] = [real(flow), real(line)];
            }
        }
        let stretch = Stretch::new(radius, upheld);
        EdgeTables { radius: real(radius), scale: real(1.0 / step), stretch, nodes }
    }

    /// Kernel radius \[m].
    pub fn radius(&self) -> Real {
        self.radius
    }

    /// Contribution of an edge whose line lies at this distance, positive outside, between two places along it.
    #[inline]
    pub(super) fn flow(&self, distance: Real, [from, to]: [Real; 2]) -> Flow {
        let square = self.radius * self.radius - distance * distance;
        if square <= 0.0 {
            return Flow::default();
        }
        let half = square.sqrt();
        let (from, to) = (from.clamp(-half, half), to.clamp(-half, half));
        let ([flow_to, line_to], [flow_from, line_from]) = (self.at(distance, to), self.at(distance, from));
        let angle = angle(distance * (to - from), distance * distance + from * to);
        let part = angle * real(0.5 / PI) - (flow_to - flow_from);
        Flow { part, slope: line_from - line_to }
    }

    /// Flow and line integral from the foot of the perpendicular to a place: odd in the place, the flow odd in the
    /// distance too.
    #[inline]
    fn at(&self, distance: Real, place: Real) -> [Real; 2] {
        let most = CELLS as Real;
        let (a, b) = (smaller(distance.abs() * self.scale, most), smaller(place.abs() * self.scale, most));
        let (row, column) = ((a as usize).min(CELLS - 1), (b as usize).min(CELLS - 1));
        let (ta, tb) = (a - row as Real, b - column as Real);
        let first = row * NODES + column;
        let [low, high] = [first, first + NODES].map(|at| {
            let [here, next] = [self.nodes[at], self.nodes[at + 1]];
            [here[0] + tb * (next[0] - here[0]), here[1] + tb * (next[1] - here[1])]
        });
        let [flow, line] = [0, 1].map(|k| low[k] + ta * (high[k] - low[k]));
        let along = if place < 0.0 { -1.0 } else { 1.0 };
        let side = if distance < 0.0 { -1.0 } else { 1.0 };
        [flow * along * side, line * along]
    }
}

/// M(r), the part of a kernel within r, at [`RINGS`] equal steps of the radius.
fn within<K: Shape>(kernel: &Kernel<K>) -> Vec<f64> {
    let step = f64::from(kernel.radius()) / RINGS as f64;
    let ring = |r: f64| 2.0 * PI * r * f64::from(kernel.value(real(r)));
    let mut sums = vec![0.0; RINGS + 1];
    for k in 0..RINGS {
        sums[k + 1] = sums[k] + simpson(step * k as f64, step * (k + 1) as f64, ring);
    }
    let whole = sums[RINGS];
    sums.iter().map(|sum| sum / whole).collect()
}

/// M(r)/(2 pi r^2) [1/m^2].
fn field(within: &[f64], radius: f64, r: f64) -> f64 {
    let place = (r / radius * RINGS as f64).max(1.0);
    let cell = (place as usize).min(RINGS - 1);
    let t = (place - cell as f64).min(1.0);
    let value = within[cell] + t * (within[cell + 1] - within[cell]);
    let r = r.max(radius / RINGS as f64);
    value / (2.0 * PI * r * r)
}

/// The angle of a vector with these components from the axis of the second one, to 1e-5: the same on every machine.
#[inline]
fn angle(y: Real, x: Real) -> Real {
    let (across, along) = (y.abs(), x.abs());
    let most = larger(across, along);
    if most == 0.0 {
        return 0.0;
    }
    let t = smaller(across, along) / most;
    let t2 = t * t;
    // Abramowitz & Stegun, 4.4.49.
    let series = 0.999_866 + t2 * (-0.330_299_5 + t2 * (0.180_141 + t2 * (-0.085_133 + t2 * 0.020_835_1)));
    let below = t * series;
    let quarter = if across > along { real(0.5 * PI) - below } else { below };
    let half = if x < 0.0 { real(PI) - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

/// Where a corner of two stretched lines lies along one of them: from its place without the stretch, by how far both
/// lines moved out. Corners of needles stay within `most` of where they were.
#[inline]
pub(super) fn moved_corner(place: Real, own: Real, other: Real, turn: Turn, most: Real) -> Real {
    place + ((own * turn.cosine - other) * turn.inverse_sine).clamp(-most, most)
}

/// The angle from one edge to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turn {
    pub cosine: Real,
    /// 0 where both edges are nearly on one line, or fold back.
    pub inverse_sine: Real,
}

impl Turn {
    /// The turn from an edge of this direction to the next one.
    pub fn new(from: Vector, to: Vector) -> Turn {
        let (cosine, sine) = (from.dot(to), from.perp_dot(to));
        let inverse_sine = if sine.abs() > 1e-3 { 1.0 / sine } else { 0.0 };
        Turn { cosine, inverse_sine }
    }

    /// The same turn seen from the second edge.
    pub fn back(self) -> Turn {
        Turn { inverse_sine: -self.inverse_sine, ..self }
    }
}
