//! The linear system of the grid: liquid cells, couplings between cells, and right sides.

use super::couplings::Couplings;
use super::flow::Flow;
use super::lattice::Lattice;
use super::mixture::Mixture;
use super::openings::Openings;
use super::solids::Solids;
use super::spans::Spans;
use super::surface::ghost;
use super::transfer::{Fields, mean};
use super::{held_by, renew};
use crate::bytes::held;
use crate::math::{Quad, Real, larger, smaller};
use crate::parallel::Parallelism;

/// Diagonal term that keeps cells without air neighbours regular: 1e-5 of their couplings.
const HELD: Real = 1e-5;
/// Cells whose faces are open to fluid by less than this in all are masked: they lie inside bodies.
const MASKED: Real = 1e-3;
/// Fluid beside a body counts as lighter where its particles fill less than this part of what is open...
const SPARSE: Real = 0.75;
/// ...down to one part in so many: else a body would be slowed by more fluid than there is.
const LIGHTEST: Real = 3.0;
/// Liquid cells with a lower fill fraction than this are contracted: flow around corners and merged spray leave pores.
/// At 0.9 a dam break comes to rest half a spacing too high, and water that sways through a gap gains energy...
const POROUS: Real = 0.98;
/// ...by this part of what is missing in each substep...
const POROUS_RELAXATION: Real = 0.1;
/// ...if the fill is uniform around the cell: near a free surface the fill of opposite neighbours differs by more...
const SLANTED: Real = 0.6;
/// ...and its particles are not compressed already: a liquid drawn out has a low fill without pores.
const COMPRESSED: Real = 0.005;
/// Beside bodies that the fluid outweighs by more than this, nothing is contracted: the gap below a float of a hundredth
/// of its density, closed again and again, pumps it, at 0.06 of sqrt(g b), for 0.009 without. Floats of a twentieth
/// would lie 0.4 dx too high without.
const FEATHER: Real = 50.0;

/// The system of one substep, by cell.
#[derive(Default)]
pub(super) struct System {
    /// Distance from the free surface, in cells: not negative within the liquid.
    pub depth: Vec<Real>,
    /// Velocity along x at left faces, and along y at lower ones [m/s].
    along_x: Vec<Real>,
    along_y: Vec<Real>,
    /// Part of each left and lower face that is open to fluid, between walls and bodies.
    pub open: [Vec<Real>; 2],
    /// Density of the heaviest fluid over that at each left and lower face.
    pub ease: [Vec<Real>; 2],
    /// 1 less the largest covered part of the faces of each cell.
    pub bare: Vec<Real>,
    /// Cells inside bodies; empty without bodies.
    masked: Vec<bool>,
    /// Cells at bodies that a contraction would pump; empty without any.
    pumping: Vec<bool>,
    /// Cells with changed openings since the last substep.
    pub touched: Vec<u32>,
    /// Negative divergence of the velocity in each cell: the inflow [m/s].
    pub divergence: Vec<Real>,
    /// Excess fill of each cell \[m].
    pub excess: Vec<Real>,
    /// Solutions of both systems: their differences are velocity changes [m/s] and displacements \[m].
    pub pressure: Vec<Real>,
    pub potential: Vec<Real>,
    /// At left and lower faces: change of velocity and move, times the open part, the open part, and 1 where
    /// there is liquid.
    pub faces: [Vec<Quad>; 2],
}

impl System {
    /// Makes all columns anew for a lattice with these openings.
    pub fn allocate(&mut self, openings: &Openings) {
        let cells = openings.left.len();
        for column in [
            &mut self.depth,
            &mut self.along_x,
            &mut self.along_y,
            &mut self.divergence,
            &mut self.excess,
            &mut self.pressure,
            &mut self.potential,
        ] {
            renew(column, cells);
        }
        self.faces.iter_mut().for_each(|faces| renew(faces, cells));
        self.open = [openings.left.clone(), openings.lower.clone()];
        let [ease_left, ease_lower] = &mut self.ease;
        for column in [ease_left, ease_lower, &mut self.bare] {
            column.clear();
            column.resize(cells, 1.0);
        }
        self.masked.clear();
        self.pumping.clear();
        self.touched.clear();
    }

    /// Forgets the last solution.
    pub fn clear(&mut self, spans: &Spans) {
        [&mut self.pressure, &mut self.potential].into_iter().for_each(|column| spans.clear(column));
        self.faces.iter_mut().for_each(|faces| spans.clear(faces));
    }

    /// Gives the images of periodic axes the depth of their cells, once the liquid was found.
    pub fn join_surface(&mut self, lattice: &Lattice) {
        lattice.images.copy(&mut self.depth, lattice.stride());
    }

    /// Reads the velocities in and beside the liquid from the sums of the particles.
    pub fn read_flow(
        &mut self,
        lattice: &Lattice,
        (fields, mixture): (&Fields, &Mixture),
        spans: &Spans,
        parallelism: Parallelism,
    ) {
        let (images, stride) = (lattice.images, lattice.stride());
        spans.each2(&mut self.along_x, &mut self.along_y, parallelism, |first, along_x, along_y| {
            let (left, lower) = (&fields.left[first..][..along_x.len()], &fields.lower[first..][..along_x.len()]);
            for k in 0..along_x.len() {
                (along_x[k], along_y[k]) = (mean(left[k]), mean(lower[k]));
            }
        });
        [&mut self.along_x, &mut self.along_y].into_iter().for_each(|column| images.copy(column, stride));
        if mixture.simple {
            return;
        }
        for ((ease, sums), number) in self.ease.iter_mut().zip([&fields.left, &fields.lower]).zip(&fields.number) {
            spans.each(ease, parallelism, |first, ease| {
                for (k, ease) in (first..).zip(ease) {
                    let mass = sums[k][1];
                    *ease = if mass > 0.0 { number[k] / mass } else { 1.0 };
                }
            });
            images.copy(ease, stride);
        }
    }

    /// Makes fluid light that is sparse beside bodies; `whole` particles fill a cell.
    pub fn lighten(&mut self, openings: &Openings, fields: &Fields, whole: Real) {
        let of_axes = [(&openings.left, &fields.left), (&openings.lower, &fields.lower)];
        for cell in self.touched.iter().map(|&cell| cell as usize) {
            for (axis, (of_walls, sums)) in of_axes.into_iter().enumerate() {
                let (open, number, mass) = (self.open[axis][cell], fields.number[axis][cell], sums[cell][1]);
                if open < of_walls[cell] && mass > 0.0 {
                    let sparse = smaller(SPARSE * whole * open / number, LIGHTEST);
                    self.ease[axis][cell] = number / mass * larger(sparse, 1.0);
                }
            }
        }
    }

    /// Takes the covered parts of faces from the open ones.
    pub fn cover(&mut self, openings: &Openings, solids: &mut Solids, stride: usize) {
        for cell in self.touched.drain(..).map(|cell| cell as usize) {
            (self.open[0][cell], self.open[1][cell]) = (openings.left[cell], openings.lower[cell]);
            self.bare[cell] = 1.0;
        }
        for face in solids.faces_mut() {
            let (here, back, axis) = (face.cell as usize, face.back(stride), usize::from(face.axis));
            let of_walls = if axis == 0 { openings.left[here] } else { openings.lower[here] };
            // Bodies that share a face do not cover more than the whole.
            face.open = smaller(of_walls * face.part, self.open[axis][here]);
            self.open[axis][here] -= face.open;
            for cell in [here, back] {
                self.bare[cell] = smaller(self.bare[cell], 1.0 - face.part);
                self.touched.push(cell as u32);
            }
        }
    }

    /// Finds the cells inside bodies from the couplings of the fluid, and those at bodies in the air, which no fluid
    /// reaches through an open face and whose pressure is zero, and those at the lightest bodies; couples the cells a
    /// body covers as if it were fluid of its density: for the preconditioner.
    pub fn mask(
        &mut self,
        (solids, fields): (&Solids, &Fields),
        stride: usize,
        fluid: &Couplings,
        out: &mut Couplings,
    ) {
        self.masked.clear();
        self.pumping.clear();
        if !solids.any() {
            return;
        }
        let feathers = || solids.solids.iter().filter(|solid| solid.lightness[1] > FEATHER);
        if feathers().next().is_some() {
            self.pumping.resize(self.depth.len(), false);
        }
        for face in feathers().flat_map(|solid| solids.faces_of(solid)) {
            [face.cell as usize, face.back(stride)].into_iter().for_each(|cell| self.pumping[cell] = true);
        }
        self.masked.resize(self.depth.len(), false);
        for &cell in &self.touched {
            let cell = cell as usize;
            // Bodies may reach to the end of the lattice.
            let wet = |axis: usize, sums: &[[Real; 2]], face: usize| match sums.get(face) {
                Some([_, weight]) if *weight > 0.0 => self.open[axis][face],
                _ => 0.0,
            };
            let of_axes = [(0, &fields.left, 1), (1, &fields.lower, stride)];
            let open = of_axes.map(|(axis, sums, next)| wet(axis, sums, cell) + wet(axis, sums, cell + next));
            let reached = smaller(open[0] + open[1], fluid.total[cell]);
            self.masked[cell] = self.depth[cell] >= 0.0 && reached < MASKED;
        }
        for solid in &solids.solids {
            for face in solids.faces_of(solid) {
                let (here, back) = (face.cell as usize, face.back(stride));
                let coupling = face.open * solid.lightness[usize::from(face.axis)];
                match (self.depth[back] >= 0.0, self.depth[here] >= 0.0) {
                    (true, true) if face.axis == 0 => out.right[back] += coupling,
                    (true, true) => out.upper[back] += coupling,
                    (true, false) => out.air[back] += coupling,
                    (false, true) => out.air[here] += coupling,
                    (false, false) => (),
                }
            }
        }
    }

    /// Sets a column to zero inside bodies.
    pub fn clear_masked(&self, column: &mut [Real]) {
        for &cell in &self.touched {
            if self.masked[cell as usize] {
                column[cell as usize] = 0.0;
            }
        }
    }

    /// Whether the pressure of a cell is part of the system.
    #[inline(always)]
    pub fn counts(&self, cell: usize) -> bool {
        self.depth[cell] >= 0.0 && !self.masked.get(cell).is_some_and(|&masked| masked)
    }

    /// Whether there is fluid in all cells.
    pub fn is_full(&self, lattice: &Lattice) -> bool {
        lattice.rows().all(|row| self.depth[row].iter().all(|&depth| depth >= 0.0))
    }

    /// Sets the couplings of the liquid.
    pub fn couple(
        &self,
        lattice: &Lattice,
        openings: &Openings,
        (spans, out): (&Spans, &mut Couplings),
        parallelism: Parallelism,
    ) {
        let (stride, depth) = (lattice.stride(), &self.depth);
        let ([left, lower], [ease_left, ease_lower]) = (&self.open, &self.ease);
        spans.each3(&mut out.right, &mut out.upper, &mut out.air, parallelism, |first, right, upper, air| {
            for k in 0..right.len() {
                let cell = first + k;
                (right[k], upper[k], air[k]) = (0.0, 0.0, 0.0);
                if depth[cell] < 0.0 {
                    continue;
                }
                let mut to = |other: usize, (open, of_walls, ease): (Real, Real, Real)| {
                    let (liquid, covered) = (depth[other] >= 0.0, of_walls - open);
                    air[k] += if liquid { 0.0 } else { open * ease * ghost(depth[cell], depth[other], covered) };
                    if liquid { open * ease } else { 0.0 }
                };
                let of_left = |face: usize| (left[face], openings.left[face], ease_left[face]);
                let of_lower = |face: usize| (lower[face], openings.lower[face], ease_lower[face]);
                right[k] = to(cell + 1, of_left(cell + 1));
                upper[k] = to(cell + stride, of_lower(cell + stride));
                let behind = to(cell - 1, of_left(cell)) + to(cell - stride, of_lower(cell));
                air[k] += HELD * (right[k] + upper[k] + behind + 1.0);
            }
        });
        lattice.images.couple([&mut out.right, &mut out.upper, &mut out.air], stride);
    }

    /// Sets the divergence to be removed by the pressure within a substep of length `dt` \[s], and the fraction of the
    /// excess fill to be removed by displacements.
    pub fn assemble_right_side(
        &mut self,
        lattice: &Lattice,
        openings: &Openings,
        fields: &Fields,
        (dt, taken_back): (Real, Real),
        (solids, spans): (&Solids, &Spans),
        parallelism: Parallelism,
    ) {
        // Straight steps along curved paths compress the fluid: the velocities that end the substep at the density of its start
        // make the step one of second order, as in the method of Verlet.
        let (depth, curving) = (&self.depth, dt / lattice.cell);
        let (open, bare, masked, pumping) = (&self.open, &self.bare, &self.masked, &self.pumping);
        let flow = Flow { u: &self.along_x, v: &self.along_y, stride: lattice.stride() };
        spans.each2(&mut self.divergence, &mut self.excess, parallelism, |first, divergence, excess| {
            for k in 0..divergence.len() {
                let cell = first + k;
                (divergence[k], excess[k]) = (0.0, 0.0);
                if depth[cell] < 0.0 || masked.get(cell).is_some_and(|&masked| masked) {
                    continue;
                }
                divergence[k] = -flow.out_of(cell, open);
                let error = mean(fields.centre[cell]);
                excess[k] = taken_back * lattice.cell * error;
                if flow.neighbors(cell).into_iter().all(|other| depth[other] >= 0.0) {
                    divergence[k] += curving * bare[cell] * flow.squeeze(cell);
                    let fill = |cell: usize| fields.centre[cell][1] * openings.inverse[cell];
                    let [left, right, lower, upper] = flow.neighbors(cell).map(fill);
                    let uniform = (left - right).abs() + (lower - upper).abs() < SLANTED;
                    if uniform && error < COMPRESSED && !pumping.get(cell).is_some_and(|&pumps| pumps) {
                        excess[k] += POROUS_RELAXATION * lattice.cell * smaller(fill(cell) - POROUS, 0.0);
                    }
                }
            }
        });
        let mut divergence = std::mem::take(&mut self.divergence);
        solids.add_inflow(&mut divergence, lattice.stride(), |cell| self.counts(cell));
        self.divergence = divergence;
    }

    /// Gives the images of periodic axes the solutions of their cells.
    pub fn join_solutions(&mut self, lattice: &Lattice) {
        let (images, stride) = (lattice.images, lattice.stride());
        [&mut self.pressure, &mut self.potential].into_iter().for_each(|column| images.copy(column, stride));
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held_by(&[&self.depth, &self.along_x, &self.along_y, &self.divergence, &self.excess])
            + held_by(&[&self.pressure, &self.potential, &self.bare])
            + held_by(&[&self.open[0], &self.open[1], &self.ease[0], &self.ease[1]])
            + held(&self.masked)
            + held(&self.pumping)
            + held(&self.touched)
            + self.faces.iter().map(held).sum::<usize>()
    }
}
