//! Pressures read from the solution.

use super::components::Components;
use super::lattice::Lattice;
use super::openings::Openings;
use super::system::System;
use crate::math::{Real, Vector, smaller};

impl System {
    /// The pressure at a place, in the unit of the solution [m/s]: air has none, walls and the inside of bodies that beside
    /// them.
    pub fn pressure_at(&self, lattice: &Lattice, openings: &Openings, x: Vector) -> Real {
        let place = lattice.place(x);
        if !lattice.holds(place) {
            return 0.0;
        }
        let (nodes, stride) = (lattice.around(place).centre, lattice.stride());
        let cells = [nodes.first, nodes.first + 1, nodes.first + stride, nodes.first + stride + 1];
        let (mut sum, mut weights) = (0.0, 0.0);
        for (cell, weight) in
            cells.into_iter().zip(nodes.weights()).filter(|(cell, _)| self.is_outside(openings, *cell))
        {
            sum += weight * self.pressure[cell];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    }

    /// Whether a cell has a part outside walls and bodies.
    fn is_outside(&self, openings: &Openings, cell: usize) -> bool {
        openings.inverse[cell] > 0.0 && (self.depth[cell] < 0.0 || self.counts(cell))
    }

    /// The pressure at a wall [m/s], from two places before it: linear across a cell and a half. `None` without fluid.
    pub fn pressure_at_wall(
        &self,
        lattice: &Lattice,
        openings: &Openings,
        (surface, normal): (Vector, Vector),
    ) -> Option<Real> {
        let at = |cells: Real| {
            let x = surface + normal * (cells * lattice.cell);
            let place = lattice.place(x);
            let cell = lattice.cell_at(place)?;
            (openings.inverse[cell] > 0.0 && self.counts(cell)).then(|| self.pressure_at(lattice, openings, x))
        };
        let (near, far) = (at(0.5)?, at(1.5));
        Some(near + 0.5 * far.map_or(0.0, |far| near - far))
    }

    /// The lowest pressure at the closed faces of a cell [m/s]; infinite without such a face.
    fn lowest_at_walls(&self, lattice: &Lattice, openings: &Openings, cell: usize) -> Real {
        let stride = lattice.stride();
        let faces = [
            (openings.left[cell], cell + 1),
            (openings.left[cell + 1], cell - 1),
            (openings.lower[cell], cell + stride),
            (openings.lower[cell + stride], cell - stride),
        ];
        let closed =
            faces.into_iter().filter(|&(open, behind)| open == 0.0 && self.counts(cell) && self.counts(behind));
        let at = |(_, behind): (Real, usize)| self.pressure[cell] + 0.5 * (self.pressure[cell] - self.pressure[behind]);
        closed.map(at).fold(Real::INFINITY, smaller)
    }

    /// Sets the constant of the pressure in each part without air: it is zero where it is lowest at a wall, as at the
    /// lid of a tank that is just full.
    pub fn set_constants(&mut self, lattice: &Lattice, openings: &Openings, components: &Components) {
        for part in components.closed() {
            let at_walls = part.cells().map(|cell| self.lowest_at_walls(lattice, openings, cell));
            let lowest = at_walls.fold(Real::INFINITY, smaller);
            for cell in part.cells().filter(|_| lowest.is_finite()) {
                self.pressure[cell] -= if self.counts(cell) { lowest } else { 0.0 };
            }
        }
    }
}
