//! Where the fluid meets air: the depth of cells below the surface, and where fluid parts from walls and bodies.

use super::components::Components;
use super::lattice::Lattice;
use super::openings::Openings;
use super::spans::{BLOCK, Spans};
use super::surface::depth_of;
use super::system::System;
use super::transfer::Fields;
use crate::math::{Real, larger, smaller};
use crate::parallel::Parallelism;

/// Least depth of a cell in which fluids without a surface prevail, and the filled fraction from which on this holds:
/// its gaps are no air.
const LEAST_DEPTH: Real = 0.5;
const LEAST_FILL: Real = 0.1;
/// Liquids with a surface are so many cells deep before a sliver that counts as liquid: films run out too fast at their
/// ends. With one cell, layers slide down ramps up to 4 % too fast in the mean over places, with three 4 % too slowly.
const CELLS_BEFORE_SLIVERS: usize = 2;
/// Where bodies cover between these parts of a cell, and fluid fills less than this part of the rest, the cell is air:
/// drops at a wet body are no liquid around it. Were the cells at the ends of a float liquid now and then, they would push
/// the lightest aside.
const PARTLY_BODY: [Real; 2] = [0.05, 0.9];
const DRIPPING: Real = 0.5;

impl System {
    /// Reads the surface from the sums of the particles.
    pub fn read_surface(
        &mut self,
        lattice: &Lattice,
        openings: &Openings,
        (fields, fills): (&Fields, bool),
        parallelism: Parallelism,
    ) {
        parallelism.chunks(&mut self.depth, |first, depth| {
            let (centre, _) = fields.centre[first..][..depth.len()].as_chunks::<BLOCK>();
            let (inverse, _) = openings.inverse[first..][..depth.len()].as_chunks::<BLOCK>();
            for ((depth, centre), inverse) in depth.as_chunks_mut::<BLOCK>().0.iter_mut().zip(centre).zip(inverse) {
                // Most of the box may be empty.
                let filled = centre.iter().any(|[_, weight]| *weight > 0.0);
                let of = |k: usize| if filled { depth_of(centre[k][1] * inverse[k]) } else { -1.0 };
                *depth = std::array::from_fn(of);
            }
        });
        if fills {
            parallelism.update(&mut self.depth, |cell, depth| {
                let fill = fields.centre[cell][1] * openings.inverse[cell];
                if fields.filling[cell] > 0.0 && fill > LEAST_FILL {
                    *depth = larger(*depth, LEAST_DEPTH);
                }
            });
        }
        self.fill_slivers(openings, lattice, if fills { 0 } else { CELLS_BEFORE_SLIVERS });
        if !fills && !fields.filling.is_empty() {
            self.leave_out_drips(fields, openings);
        }
        // Cells around the box are empty, even if particle weights reach them.
        let (stride, cells) = (lattice.stride(), lattice.len());
        let sides = (0..cells).step_by(stride).flat_map(|row| [row, row + lattice.width + 1]);
        for rim in sides.chain(0..stride).chain(cells - stride..cells) {
            self.depth[rim] = -1.0;
        }
    }

    /// Makes cells liquid that lie within walls but for a corner, where they open into liquid and none of so many cells
    /// before them is air: no particle can lie in them. As air, they would draw the liquid in.
    fn fill_slivers(&mut self, openings: &Openings, lattice: &Lattice, cells_before: usize) {
        let (left, lower, stride) = (&openings.left, &openings.lower, lattice.stride());
        for cell in openings.slivers.iter().map(|&cell| cell as usize) {
            let (right, upper) = (cell + 1, cell + stride);
            let normal = [left[right] - left[cell], lower[upper] - lower[cell]];
            if self.air_within(openings, lattice, (cell, normal), cells_before) {
                continue;
            }
            let beside =
                [(left[cell], cell - 1), (left[right], right), (lower[cell], cell - stride), (lower[upper], upper)];
            let open = beside.into_iter().filter(|&(open, other)| open > 0.0 && openings.inverse[other] > 0.0);
            self.depth[cell] = open.map(|(_, other)| self.depth[other]).fold(self.depth[cell], larger);
        }
    }

    /// Whether one of so many cells from a cell along a direction is air; those that walls hold mostly are not.
    fn air_within(
        &self,
        openings: &Openings,
        lattice: &Lattice,
        (cell, direction): (usize, [Real; 2]),
        cells: usize,
    ) -> bool {
        let longest = larger(direction[0].abs(), direction[1].abs());
        let is_air =
            |other: usize| self.depth[other] < 0.0 && openings.inverse[other] > 0.0 && !openings.is_sliver(other);
        (1..=cells).any(|step| {
            let way =
                direction.map(|part| if longest > 0.0 { (part / longest * step as Real).round() as i32 } else { 0 });
            lattice.cell_beside(cell, way).is_none_or(is_air)
        })
    }

    /// Makes cells beside bodies air that hold a few drops only.
    fn leave_out_drips(&mut self, fields: &Fields, openings: &Openings) {
        for cell in self.touched.iter().map(|&cell| cell as usize) {
            let [all, free] =
                [fields.centre[cell][1], -fields.filling[cell]].map(|filled| filled * openings.inverse[cell]);
            let body = all - free;
            if body > PARTLY_BODY[0] && body < PARTLY_BODY[1] && free < DRIPPING * (1.0 - body) {
                self.depth[cell] = smaller(self.depth[cell], depth_of(free / (1.0 - body)));
            }
        }
    }

    /// Ends suction at bodies in fluid that meets air, and at walls where air is near: fluid parts from them. A jet would
    /// else fill the hole that it leaves by, and draw more through it: 0.75 of sqrt(2 g head), not 0.61. Elsewhere it
    /// clings to walls, since no air can come between.
    pub fn end_suction(
        &mut self,
        openings: &Openings,
        components: &Components,
        (spans, stride): (&Spans, usize),
        parallelism: Parallelism,
    ) {
        let faces = |cell: usize| {
            [openings.left[cell], openings.left[cell + 1], openings.lower[cell], openings.lower[cell + stride]]
        };
        let (bare, depth) = (&self.bare, &self.depth);
        let is_air = |cell: usize| depth[cell] < 0.0 && faces(cell).into_iter().any(|open| open > 0.0);
        let near_air = |cell: usize| {
            let mut around = [cell - stride, cell, cell + stride].into_iter().flat_map(|row| row - 1..row + 2);
            around.any(is_air)
        };
        let at_wall = |cell: usize| faces(cell).into_iter().any(|open| open < 1.0);
        spans.each(&mut self.pressure, parallelism, |first, pressure| {
            for (cell, pressure) in (first..).zip(pressure).filter(|(_, pressure)| **pressure < 0.0) {
                if (bare[cell] < 1.0 || at_wall(cell) && near_air(cell)) && components.meets_air(cell) {
                    *pressure = 0.0;
                }
            }
        });
    }
}
