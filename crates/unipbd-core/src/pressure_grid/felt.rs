//! The solution at the faces, and at the particles between them.

use super::lattice::Lattice;
use super::openings::Openings;
use super::spans::Spans;
use super::surface::ghost;
use super::system::System;
use super::transfer::{Fields, interpolate};
use crate::math::{Quad, Real, Vector, larger, smaller};
use crate::parallel::Parallelism;

/// A point gets the full grid correction if at least this fraction of its nodes is next to liquid. It is half at
/// the free surface, less above it.
const WHOLLY_FELT: Real = 0.5;
/// Keeps a quotient finite where no face counts.
const NOTHING: Real = 1e-6;
/// A face counts wholly for the particles beside it if at least this part of it is open between the bodies.
const WHOLLY_OPEN: Real = 0.2;

impl System {
    /// Computes the differences of both solutions at the faces.
    pub fn difference(&mut self, lattice: &Lattice, openings: &Openings, spans: &Spans, parallelism: Parallelism) {
        let (depth, pressure, potential) = (&self.depth, &self.pressure, &self.potential);
        let of_walls = [&openings.left, &openings.lower];
        let columns = of_walls.into_iter().zip(&self.open).zip(&self.ease);
        for ((faces, ((of_walls, open), ease)), back) in self.faces.iter_mut().zip(columns).zip([1, lattice.stride()]) {
            let difference = |k: usize| {
                let (before, here) = (depth[k - back], depth[k]);
                let covered = of_walls[k] - open[k];
                let gain = match (before >= 0.0, here >= 0.0) {
                    _ if of_walls[k] == 0.0 => return None,
                    (false, false) => return None,
                    (true, true) => 1.0,
                    (true, false) => ghost(before, here, covered),
                    (false, true) => ghost(here, before, covered),
                };
                // A face within a body has no fluid beside it to move.
                let valid = smaller(open[k] / (of_walls[k] * WHOLLY_OPEN), 1.0);
                let gain = gain * ease[k] * valid;
                let [of_pressure, of_potential] = [pressure, potential].map(|field| field[k - back] - field[k]);
                Some(Quad::new(gain * of_pressure, gain * of_potential, valid, 1.0))
            };
            let images = lattice.images.periods[usize::from(back > 1)] > 0;
            let inner = if images { back } else { 2 * back }..lattice.len() - back;
            // A wall face gets the value of the next face away from the wall.
            let felt = |k: usize| match inner.contains(&k) {
                false => None,
                true if of_walls[k] > 0.0 => difference(k),
                true if depth[k] >= 0.0 => difference(k + back),
                true if depth[k - back] >= 0.0 && k >= 2 * back => difference(k - back),
                true => None,
            };
            spans.each(faces, parallelism, |first, faces| {
                for (k, face) in faces.iter_mut().enumerate() {
                    *face = felt(first + k).unwrap_or_default();
                }
            });
            lattice.images.copy(faces, lattice.stride());
        }
    }

    /// Takes the mean out of the changes: without walls and surfaces, the pressure changes no momentum, and does not move
    /// the centre of mass.
    pub fn keep_momentum(&mut self, lattice: &Lattice, fields: &Fields) {
        for (faces, sums) in self.faces.iter_mut().zip([&fields.left, &fields.lower]) {
            let (mut moved, mut mass) = ([0.0, 0.0], 0.0);
            for (face, [_, weight]) in lattice.rows().flat_map(|cells| faces[cells.clone()].iter().zip(&sums[cells])) {
                let weight = f64::from(*weight);
                moved = [moved[0] + weight * f64::from(face.x), moved[1] + weight * f64::from(face.y)];
                mass += weight;
            }
            let mean = moved.map(|sum| (sum / f64::max(mass, f64::MIN_POSITIVE)) as Real);
            let mean = Quad::new(mean[0], mean[1], 0.0, 0.0);
            faces.iter_mut().for_each(|face| *face -= mean * face.w);
        }
    }

    /// The solution as interpolated to the particles.
    pub fn felt(&self, lattice: &Lattice) -> Felt<'_> {
        Felt { lattice: *lattice, faces: [&self.faces[0], &self.faces[1]] }
    }
}

/// The solution at the faces. It holds the lattice itself, so that loops keep it in registers.
pub(super) struct Felt<'a> {
    lattice: Lattice,
    faces: [&'a [Quad]; 2],
}

impl Felt<'_> {
    /// The velocity change [m/s] and the displacement \[m] at a point.
    #[inline(always)]
    pub fn at(&self, x: Vector) -> (Vector, Vector) {
        let place = self.lattice.place(x);
        if !self.lattice.holds(place) {
            return (Vector::ZERO, Vector::ZERO);
        }
        let (stride, around) = (self.lattice.stride(), self.lattice.around(place));
        let along_x = interpolate(self.faces[0], stride, around.left);
        let along_y = interpolate(self.faces[1], stride, around.lower);
        let part = |sums: Quad| smaller(sums.w * (1.0 / WHOLLY_FELT), 1.0) / larger(sums.z, NOTHING);
        let per = Vector::new(part(along_x), part(along_y));
        (Vector::new(along_x.x, along_y.x) * per, Vector::new(along_x.y, along_y.y) * per)
    }
}
