//! The open fraction of each face and cell, outside walls.

use super::held_by;
use super::lattice::Lattice;
use crate::bytes::held;
use crate::math::{Real, Vector, larger, smaller};
use crate::parallel::Parallelism;
use crate::walls::{Outlines, Walls};

/// Sample points along each axis in the surroundings of a cell near a wall.
const SAMPLES: usize = 8;
/// Lower limit of the open fraction of a cell: it limits the weight of the particles in the cell.
const LEAST: Real = 0.25;
/// A corner nearer to a wall than this is on it [cells].
const ON_WALL: Real = 1e-2;
/// Pieces of a face beside walls, each with a distance of its own: a wall may end between the corners.
const PIECES: u8 = 8;

/// Open parts, by cell of the lattice they were measured on.
#[derive(Default)]
pub(super) struct Openings {
    of: Lattice,
    /// The outlines they were measured with.
    version: u64,
    /// Open part of the left face.
    pub left: Vec<Real>,
    /// Open part of the lower face.
    pub lower: Vec<Real>,
    /// Inverse of the open fraction of the surroundings of the cell, with the weights of particles; 0 inside walls.
    pub inverse: Vec<Real>,
    corners: Vec<Real>,
    /// Cells at the corners of which a little is open: less than [`LEAST`] of their surroundings.
    pub slivers: Vec<u32>,
    /// Whether there are no walls among the cells.
    pub boundless: bool,
}

impl Openings {
    /// Measures all openings if the lattice has changed; walls do not move. Returns whether it measured.
    pub fn measure(
        &mut self,
        lattice: &Lattice,
        (walls, outlines): (&Walls, &Outlines),
        parallelism: Parallelism,
    ) -> bool {
        if self.of == *lattice && self.version == outlines.version() && !self.left.is_empty() {
            return false;
        }
        (self.of, self.version) = (*lattice, outlines.version());
        let (cells, stride, cell) = (lattice.len(), lattice.stride(), lattice.cell);
        for column in [&mut self.left, &mut self.lower, &mut self.inverse, &mut self.corners] {
            column.resize(cells, 0.0);
        }
        let distance = |x: Vector, among: &[usize]| {
            let mut distance = [Real::INFINITY];
            walls.distances(&[x], &mut distance);
            match among.is_empty() {
                true => distance[0],
                false => smaller(outlines.distance_from(among, x, 2.0 * cell), distance[0]),
            }
        };
        let from_wall = |x: Vector, among: &[usize]| {
            let distance = distance(x, among);
            if distance.abs() < ON_WALL * cell { 0.0 } else { distance }
        };
        parallelism.chunks(&mut self.corners, |first, corners| {
            let end = first + corners.len() - 1;
            // A chunk of cells is some rows, or a part of one.
            let rows = end / stride > first / stride;
            let [left, right] = if rows { [0, stride - 1] } else { [first % stride, end % stride] };
            let box_of = [first / stride * stride + left, end / stride * stride + right].map(|k| lattice.corner(k));
            let among = outlines.fixed_within(box_of);
            for (k, corner) in corners.iter_mut().enumerate() {
                *corner = from_wall(lattice.corner(first + k), &among);
            }
        });
        let corner = |k: usize| self.corners.get(k).copied().unwrap_or(-cell);
        let part = |k: usize, other: usize, along: Vector| {
            let [near, far] = [corner(k), corner(other)];
            if larger(near.abs(), far.abs()) >= cell {
                return open_part(near, far);
            }
            let start = lattice.corner(k);
            let among = outlines.fixed_within([start, start + along]);
            let (mut before, mut sum) = (near, 0.0);
            for piece in 1..=PIECES {
                let place = start + along * (Real::from(piece) / Real::from(PIECES));
                let here = if piece == PIECES { far } else { from_wall(place, &among) };
                sum += open_part(before, here);
                before = here;
            }
            sum / Real::from(PIECES)
        };
        parallelism.fill(&mut self.left, |k| part(k, k + stride, Vector::new(0.0, cell)));
        parallelism.fill(&mut self.lower, |k| part(k, k + 1, Vector::new(cell, 0.0)));
        let open = |faces: &[Real], at: usize| faces.get(at).is_some_and(|part| *part > 0.0);
        let (left, lower) = (&self.left, &self.lower);
        parallelism.fill(&mut self.inverse, |k| {
            if !(open(left, k) || open(left, k + 1) || open(lower, k) || open(lower, k + stride)) {
                return 0.0;
            }
            let centre = lattice.corner(k) + Vector::splat(0.5 * cell);
            let around = Vector::splat(1.5 * cell);
            let among = outlines.fixed_within([centre - around, centre + around]);
            let distance = |x: Vector| distance(x, &among);
            let near = distance(centre) < 1.5 * cell;
            if near { 1.0 / larger(open_surroundings(centre, cell, distance), LEAST) } else { 1.0 }
        });
        for column in [&mut self.left, &mut self.lower, &mut self.inverse] {
            lattice.images.copy(column, stride);
        }
        let mut slivers = std::mem::take(&mut self.slivers);
        slivers.clear();
        slivers.extend(lattice.rows().flatten().filter(|&cell| self.is_sliver(cell)).map(|cell| cell as u32));
        self.slivers = slivers;
        let mut inverse = lattice.rows().flat_map(|row| &self.inverse[row]);
        self.boundless = lattice.images.periods.iter().all(|&period| period > 0) && inverse.all(|&k| k == 1.0);
        true
    }

    /// Whether less than [`LEAST`] of the surroundings of a cell is open.
    pub fn is_sliver(&self, cell: usize) -> bool {
        self.inverse[cell] >= 1.0 / LEAST
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held_by(&[&self.left, &self.lower, &self.inverse, &self.corners]) + held(&self.slivers)
    }
}

/// The fraction of a line segment outside walls, from the wall distances of its ends.
fn open_part(a: Real, b: Real) -> Real {
    match (a > 0.0, b > 0.0) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        (true, false) => a / (a - b),
        (false, true) => b / (b - a),
    }
}

/// The fraction of the kernel of a cell outside walls. The kernel is a hat function, two cells wide.
fn open_surroundings(centre: Vector, cell: Real, distance: impl Fn(Vector) -> Real) -> Real {
    let step = 2.0 / SAMPLES as Real;
    let place = |k: usize| (k as Real + 0.5) * step - 1.0;
    let (mut open, mut all) = (0.0, 0.0);
    for i in 0..SAMPLES {
        for j in 0..SAMPLES {
            let weight = (1.0 - place(i).abs()) * (1.0 - place(j).abs());
            all += weight;
            if distance(centre + Vector::new(place(i), place(j)) * cell) > 0.0 {
                open += weight;
            }
        }
    }
    open / all
}
