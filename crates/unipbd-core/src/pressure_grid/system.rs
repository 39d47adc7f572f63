//! The linear system of the grid: liquid cells, couplings between cells, and right sides.

use super::lattice::Lattice;
use super::openings::Openings;
use super::spans::{BLOCK, Spans};
use super::transfer::{Fields, interpolate, mean};
use super::{held_by, renew};
use crate::bytes::held;
use crate::math::{Quad, Real, Vector, larger, smaller};
use crate::parallel::Parallelism;

/// Least distance of the free surface from a cell, as a part of the distance of two cells.
const NEAREST_SURFACE: Real = 0.1;
/// Diagonal term that keeps cells without air neighbours regular: 1e-5 of their couplings.
const HELD: Real = 1e-5;
/// Fraction of the compression by curved paths within a substep that the right side anticipates.
const CURVATURE: Real = 0.5;
/// Liquid cells with a lower fill fraction than this are contracted: the cell contains merged spray, not a continuous
/// liquid...
const POROUS: Real = 0.9;
/// ...if the fill is uniform around the cell: near a free surface the fill of opposite neighbours differs by more.
const SLANTED: Real = 0.3;
/// A point gets the full grid correction if at least this fraction of its nodes is next to liquid. It is half at
/// the free surface, less above it.
const WHOLLY_FELT: Real = 0.5;

/// Couplings by cell; all are zero where there is no liquid.
#[derive(Default)]
pub(super) struct Couplings {
    /// With the cell to the right.
    pub right: Vec<Real>,
    /// With the cell above.
    pub upper: Vec<Real>,
    /// With air.
    pub air: Vec<Real>,
}

/// The system of one substep, by cell.
#[derive(Default)]
pub(super) struct System {
    /// Distance from the free surface, in cells: not negative within the liquid.
    pub depth: Vec<Real>,
    /// Velocity along x at left faces, and along y at lower ones [m/s].
    along_x: Vec<Real>,
    along_y: Vec<Real>,
    /// Negative divergence of the velocity in each cell: the inflow [m/s].
    pub divergence: Vec<Real>,
    /// Excess fill of each cell [m].
    pub excess: Vec<Real>,
    /// Solutions of both systems: their differences are velocity changes [m/s] and displacements [m].
    pub pressure: Vec<Real>,
    pub potential: Vec<Real>,
    /// At left and lower faces: change of velocity, move, and 1 where there is liquid.
    faces: [Vec<Quad>; 2],
}

impl System {
    /// Makes all columns anew for a lattice of this many cells.
    pub fn allocate(&mut self, cells: usize) {
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
    }

    /// Forgets the last solution.
    pub fn clear(&mut self, spans: &Spans) {
        [&mut self.pressure, &mut self.potential].into_iter().for_each(|column| spans.clear(column));
        self.faces.iter_mut().for_each(|faces| spans.clear(faces));
    }

    /// Reads the surface from the sums of the particles.
    pub fn read_surface(&mut self, lattice: &Lattice, openings: &Openings, fields: &Fields, parallelism: Parallelism) {
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
        // Cells around the box are empty, even if particle weights reach them.
        let (stride, cells) = (lattice.stride(), lattice.len());
        let sides = (0..cells).step_by(stride).flat_map(|row| [row, row + lattice.width + 1]);
        for rim in sides.chain(0..stride).chain(cells - stride..cells) {
            self.depth[rim] = -1.0;
        }
    }

    /// Reads the velocities in and beside the liquid from the sums of the particles.
    pub fn read_flow(&mut self, fields: &Fields, spans: &Spans, parallelism: Parallelism) {
        spans.each2(&mut self.along_x, &mut self.along_y, parallelism, |first, along_x, along_y| {
            let (left, lower) = (&fields.left[first..][..along_x.len()], &fields.lower[first..][..along_x.len()]);
            for k in 0..along_x.len() {
                (along_x[k], along_y[k]) = (mean(left[k]), mean(lower[k]));
            }
        });
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
        let (left, lower) = (&openings.left, &openings.lower);
        spans.each3(&mut out.right, &mut out.upper, &mut out.air, parallelism, |first, right, upper, air| {
            for k in 0..right.len() {
                let cell = first + k;
                (right[k], upper[k], air[k]) = (0.0, 0.0, 0.0);
                if depth[cell] < 0.0 {
                    continue;
                }
                let mut to = |other: usize, open: Real| {
                    let liquid = depth[other] >= 0.0;
                    air[k] += if liquid { 0.0 } else { open * ghost(depth[cell], depth[other]) };
                    if liquid { open } else { 0.0 }
                };
                right[k] = to(cell + 1, left[cell + 1]);
                upper[k] = to(cell + stride, lower[cell + stride]);
                to(cell - 1, left[cell]);
                to(cell - stride, lower[cell]);
                air[k] += HELD;
            }
        });
    }

    /// Sets the divergence to be removed by the pressure within a substep of length `dt` [s], and the fraction of the
    /// excess fill to be removed by displacements.
    pub fn assemble_right_side(
        &mut self,
        lattice: &Lattice,
        openings: &Openings,
        fields: &Fields,
        (dt, taken_back): (Real, Real),
        spans: &Spans,
        parallelism: Parallelism,
    ) {
        let (depth, curving) = (&self.depth, CURVATURE * 0.5 * dt / lattice.cell);
        let flow = Flow { u: &self.along_x, v: &self.along_y, stride: lattice.stride() };
        spans.each2(&mut self.divergence, &mut self.excess, parallelism, |first, divergence, excess| {
            for k in 0..divergence.len() {
                let cell = first + k;
                (divergence[k], excess[k]) = (0.0, 0.0);
                if depth[cell] < 0.0 {
                    continue;
                }
                divergence[k] = -flow.out_of(cell, openings);
                let mut too_much = mean(fields.centre[cell]);
                if flow.neighbors(cell).into_iter().all(|other| depth[other] >= 0.0) {
                    divergence[k] += curving * flow.squeeze(cell);
                    let fill = |cell: usize| fields.centre[cell][1] * openings.inverse[cell];
                    let [left, right, lower, upper] = flow.neighbors(cell).map(fill);
                    if (left - right).abs() + (lower - upper).abs() < SLANTED {
                        too_much += smaller(fill(cell) - POROUS, 0.0);
                    }
                }
                excess[k] = taken_back * lattice.cell * too_much;
            }
        });
    }

    /// Computes the differences of both solutions at the faces.
    pub fn difference(&mut self, lattice: &Lattice, openings: &Openings, spans: &Spans, parallelism: Parallelism) {
        let (depth, pressure, potential) = (&self.depth, &self.pressure, &self.potential);
        let open = [&openings.left, &openings.lower];
        for ((faces, open), back) in self.faces.iter_mut().zip(open).zip([1, lattice.stride()]) {
            let difference = |k: usize| {
                let (before, here) = (depth[k - back], depth[k]);
                let gain = match (before >= 0.0, here >= 0.0) {
                    _ if open[k] == 0.0 => return None,
                    (false, false) => return None,
                    (true, true) => 1.0,
                    (true, false) => ghost(before, here),
                    (false, true) => ghost(here, before),
                };
                let [of_pressure, of_potential] = [pressure, potential].map(|field| field[k - back] - field[k]);
                Some(Quad::new(gain * of_pressure, gain * of_potential, 1.0, 0.0))
            };
            let inner = 2 * back..lattice.len() - back;
            // A wall face gets the value of the next face away from the wall.
            let felt = |k: usize| match inner.contains(&k) {
                false => None,
                true if open[k] > 0.0 => difference(k),
                true if depth[k] >= 0.0 => difference(k + back),
                true if depth[k - back] >= 0.0 => difference(k - back),
                true => None,
            };
            spans.each(faces, parallelism, |first, faces| {
                for (k, face) in faces.iter_mut().enumerate() {
                    *face = felt(first + k).unwrap_or_default();
                }
            });
        }
    }

    /// The solution as interpolated to the particles.
    pub fn felt(&self, lattice: &Lattice) -> Felt<'_> {
        Felt { lattice: *lattice, faces: [&self.faces[0], &self.faces[1]] }
    }

    /// The pressure at a place, in the unit of the solution [m/s]: air has none, walls that beside them.
    pub fn pressure_at(&self, lattice: &Lattice, openings: &Openings, x: Vector) -> Real {
        let place = lattice.place(x);
        if !lattice.holds(place) {
            return 0.0;
        }
        let (nodes, stride) = (lattice.around(place).centre, lattice.stride());
        let cells = [nodes.first, nodes.first + 1, nodes.first + stride, nodes.first + stride + 1];
        let (mut sum, mut weights) = (0.0, 0.0);
        for (cell, weight) in cells.into_iter().zip(nodes.weights()).filter(|(cell, _)| openings.inverse[*cell] > 0.0) {
            sum += weight * self.pressure[cell];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    }

    /// The closed parts of all faces of the liquid: the middle of the face, the way out of the liquid, and the
    /// pressure at it, half a cell on from the centre, times the closed part [m/s].
    pub fn closed_faces(&self, lattice: &Lattice, openings: &Openings, mut visit: impl FnMut(Vector, Vector, Real)) {
        let (stride, half) = (lattice.stride(), 0.5 * lattice.cell);
        for cell in (0..lattice.len()).filter(|&cell| self.depth[cell] >= 0.0) {
            let centre = lattice.corner(cell) + Vector::splat(half);
            let faces = [
                (openings.left[cell], cell + 1, Vector::NEG_X),
                (openings.left[cell + 1], cell - 1, Vector::X),
                (openings.lower[cell], cell + stride, Vector::NEG_Y),
                (openings.lower[cell + stride], cell - stride, Vector::Y),
            ];
            for (open, behind, outward) in faces.into_iter().filter(|(open, ..)| *open < 1.0) {
                let liquid = self.depth[behind] >= 0.0;
                let gain = if liquid { 1.0 } else { ghost(self.depth[cell], self.depth[behind]) };
                let at_face = self.pressure[cell] + 0.5 * gain * (self.pressure[cell] - self.pressure[behind]);
                visit(centre + outward * half, outward, (1.0 - open) * at_face);
            }
        }
    }

    /// Memory held [bytes].
    pub fn memory_bytes(&self) -> usize {
        held_by(&[&self.depth, &self.along_x, &self.along_y, &self.divergence, &self.excess])
            + held_by(&[&self.pressure, &self.potential])
            + self.faces.iter().map(held).sum::<usize>()
    }
}

/// The solution at the faces. It holds the lattice itself, so that loops keep it in registers.
pub(super) struct Felt<'a> {
    lattice: Lattice,
    faces: [&'a [Quad]; 2],
}

impl Felt<'_> {
    /// The velocity change [m/s] and the displacement [m] at a point.
    #[inline(always)]
    pub fn at(&self, x: Vector) -> (Vector, Vector) {
        let place = self.lattice.place(x);
        if !self.lattice.holds(place) {
            return (Vector::ZERO, Vector::ZERO);
        }
        let (stride, around) = (self.lattice.stride(), self.lattice.around(place));
        let along_x = interpolate(self.faces[0], stride, around.left);
        let along_y = interpolate(self.faces[1], stride, around.lower);
        let per = Vector::new(1.0 / larger(along_x.z, WHOLLY_FELT), 1.0 / larger(along_y.z, WHOLLY_FELT));
        (Vector::new(along_x.x, along_y.x) * per, Vector::new(along_x.y, along_y.y) * per)
    }
}

/// Velocities at the faces of cells.
struct Flow<'a> {
    u: &'a [Real],
    v: &'a [Real],
    stride: usize,
}

impl Flow<'_> {
    fn neighbors(&self, cell: usize) -> [usize; 4] {
        [cell - 1, cell + 1, cell - self.stride, cell + self.stride]
    }

    /// Outflow of a cell.
    fn out_of(&self, cell: usize, open: &Openings) -> Real {
        let (right, upper) = (cell + 1, cell + self.stride);
        (self.u[right] * open.left[right] - self.u[cell] * open.left[cell])
            + (self.v[upper] * open.lower[upper] - self.v[cell] * open.lower[cell])
    }

    /// The trace of the squared velocity gradient, in cell units: the compression by curved paths.
    fn squeeze(&self, cell: usize) -> Real {
        let middle =
            |cell: usize| Vector::new(self.u[cell] + self.u[cell + 1], self.v[cell] + self.v[cell + self.stride]) * 0.5;
        let [left, right, lower, upper] = self.neighbors(cell).map(middle);
        let (along_x, along_y) = (right - left, upper - lower);
        let (ux, vy) = (self.u[cell + 1] - self.u[cell], self.v[cell + self.stride] - self.v[cell]);
        ux * ux + vy * vy + 0.5 * along_x.y * along_y.x
    }
}

/// Distance from a flat free surface, in cells, of a cell with this fill fraction; exact along an axis.
#[inline(always)]
fn depth_of(fill: Real) -> Real {
    let missing = 1.0 - fill;
    if missing <= 0.0 {
        1.0
    } else if fill < 0.5 {
        (2.0 * fill).sqrt() - 1.0
    } else {
        1.0 - (2.0 * missing).sqrt()
    }
}

/// Ghost-pressure factor next to air: the pressure is zero at the free surface, not at the centre of the next cell.
fn ghost(liquid: Real, air: Real) -> Real {
    1.0 / (liquid / (liquid - air)).clamp(NEAREST_SURFACE, 1.0)
}
