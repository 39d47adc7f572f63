//! Rigid bodies in the pressure system: the parts of faces they cover, and how they answer to pressure.
//!
//! A body that covers a part of a face moves with the pressure difference across it, as fluid does, but as a whole
//! (Batty et al. 2007): its response belongs to the operator, so that light and heavy bodies are equally stable.

use super::chords::Outline;
use super::lattice::Lattice;
use crate::bytes::held;
use crate::math::{Real, Vector64, dot3};
use crate::rigid::{Bodies, Mobilities, Mobility, Pose, Twist};
use std::ops::Range;

/// A face covered to more than this part is covered wholly.
const WHOLE: f64 = 0.97;
/// Lines per cell at which an outline is cut.
const LINES: usize = 4;
/// Smaller covered parts are left out.
const LEAST: f64 = 1e-4;

/// A face that a body covers in part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covered {
    /// The cell ahead of the face.
    pub cell: u32,
    /// Whether the face is a left one (0) or a lower one (1).
    pub axis: u8,
    /// Covered part of the face.
    pub part: Real,
    /// The same times the part that is open between the walls.
    pub open: Real,
    /// Moment about the centre of mass of a unit force along the axis \[m].
    arm: f64,
}

/// A body on the grid.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub body: u32,
    /// Its faces.
    faces: Range<usize>,
    /// Its responses to loads.
    responses: Range<usize>,
    /// Predicted velocity [m/s], [rad/s].
    velocity: [f64; 3],
    /// Mass of a cell of the heaviest fluid over that of a cell of the body, along each axis; 0 where it cannot move.
    pub lightness: [Real; 2],
}

/// How a body answers to the load on one: that itself, or another one that joints hold to it.
#[derive(Clone, Copy, Debug)]
struct Response {
    /// The number of the solid that is loaded.
    to: u32,
    /// Change of velocity by a force and a torque, times the mass of a full cell.
    change: Mobility,
}

/// The bodies that a fluid meets.
pub(crate) struct Immersed<'a> {
    pub bodies: &'a mut Bodies,
    /// Whether a body is among the particles.
    pub counts: &'a dyn Fn(u32) -> bool,
    pub mobilities: &'a Mobilities,
}

/// All bodies on the grid.
#[derive(Default)]
pub(super) struct Solids {
    pub solids: Vec<Solid>,
    faces: Vec<Covered>,
    responses: Vec<Response>,
    /// The number of the solid of each body.
    numbers: Vec<Option<u32>>,
    intervals: Vec<[f64; 2]>,
    /// Covered parts of the faces of one row.
    parts: Vec<f64>,
    outline: Outline,
}

/// Unit of the responses: the mass of a full cell of the heaviest fluid \[kg], and the substep \[s].
#[derive(Clone, Copy)]
pub(super) struct Units {
    pub cell_mass: f64,
    pub dt: f64,
}

impl Solids {
    /// Whether any body covers a face.
    pub fn any(&self) -> bool {
        !self.faces.is_empty()
    }

    /// Finds the faces that these bodies cover, and their responses.
    pub fn find(&mut self, lattice: &Lattice, immersed: &Immersed<'_>, units: Units) {
        self.solids.clear();
        self.faces.clear();
        let Immersed { bodies, counts, mobilities } = immersed;
        let rigid = |&body: &u32| bodies.elasticity(body as usize).is_none();
        for body in (0..bodies.len() as u32).filter(rigid) {
            let first = self.faces.len();
            if counts(body) {
                self.cover(lattice, bodies, body);
            }
            // Bodies that joints hold to others move with them.
            if self.faces.len() > first || mobilities.companions(body).len() > 1 {
                let solid = Solid::new((bodies, body), first..self.faces.len(), (lattice, mobilities.of(body)), units);
                self.solids.push(solid);
            }
        }
        self.find_responses(bodies.len(), mobilities, units);
    }

    /// Finds what moves each solid.
    fn find_responses(&mut self, bodies: usize, mobilities: &Mobilities, units: Units) {
        self.numbers.clear();
        self.numbers.resize(bodies, None);
        for (number, solid) in (0..).zip(&self.solids) {
            self.numbers[solid.body as usize] = Some(number);
        }
        self.responses.clear();
        for solid in &mut self.solids {
            let first = self.responses.len();
            for &other in mobilities.companions(solid.body) {
                let change = mobilities.between(solid.body, other).map(|row| row.map(|entry| entry * units.cell_mass));
                if let Some(to) = self.numbers[other as usize].filter(|_| change != [[0.0; 3]; 3]) {
                    self.responses.push(Response { to, change });
                }
            }
            solid.responses = first..self.responses.len();
        }
    }

    /// Lists the faces of one body. The part of a face is that of the cell-wide box around it, so that the force on a
    /// body changes continuously with its place: lines along the direction of the face cut the outline, where it is in the
    /// middle of the substep. Where it starts would do but for light floats, which the step then throws up again and again.
    fn cover(&mut self, lattice: &Lattice, bodies: &Bodies, body: u32) {
        let pose = halfway(bodies.pose(body), bodies.predicted_pose(body));
        let mut outline = std::mem::take(&mut self.outline);
        outline.take(&bodies.views()[body as usize], pose);
        let (cell, origin) = (f64::from(lattice.cell), lattice.lowest());
        let counts = [lattice.width, lattice.height];
        for axis in [0, 1] {
            let across = 1 - axis;
            let [low, high] = outline.bounds.map(|corner| (corner - origin) / cell);
            let rows = within(low[across].floor(), high[across].ceil(), counts[across]);
            let faces = within((low[axis] + 0.5).floor(), (high[axis] + 0.5).floor() + 1.0, counts[axis] + 1);
            for row in rows {
                self.parts.clear();
                self.parts.resize(faces.len(), 0.0);
                for line in 0..LINES {
                    let place = row as f64 + (line as f64 + 0.5) / LINES as f64;
                    outline.cut(across, origin[across] + place * cell, &mut self.intervals);
                    for [from, to] in &self.intervals {
                        let [from, to] = [from, to].map(|end| (end - origin[axis]) / cell + 0.5);
                        for (face, part) in faces.clone().zip(&mut self.parts) {
                            *part += (to.min(face as f64 + 1.0) - from.max(face as f64)).max(0.0) / LINES as f64;
                        }
                    }
                }
                let middle = origin[across] + (row as f64 + 0.5) * cell - pose.position[across];
                for (face, &part) in faces.clone().zip(&self.parts).filter(|(_, part)| **part > LEAST) {
                    let (i, j) = if axis == 0 { (face, row) } else { (row, face) };
                    self.faces.push(Covered {
                        cell: ((j + 1) * lattice.stride() + i + 1) as u32,
                        axis: axis as u8,
                        part: if part > WHOLE { 1.0 } else { part as Real },
                        open: 0.0,
                        arm: if axis == 0 { -middle } else { middle },
                    });
                }
            }
        }
        self.outline = outline;
    }

    /// The faces of all bodies.
    pub fn faces_mut(&mut self) -> &mut [Covered] {
        &mut self.faces
    }

    /// The faces of a body.
    pub fn faces_of(&self, solid: &Solid) -> &[Covered] {
        &self.faces[solid.faces.clone()]
    }

    /// Adds the inflow that the predicted motion of the bodies brings to each cell [m/s].
    pub fn add_inflow(&self, inflow: &mut [Real], stride: usize, counts: impl Fn(usize) -> bool) {
        for solid in &self.solids {
            self.push_through(solid, solid.velocity, -1.0, stride, (&counts, inflow));
        }
    }

    /// Adds the outflow of each cell by the response of the bodies to a pressure [m/s].
    pub fn respond(&self, pressure: &[Real], out: &mut [Real], stride: usize, counts: impl Fn(usize) -> bool) {
        for solid in self.solids.iter().filter(|solid| !solid.responses.is_empty()) {
            let change = self.change(solid, pressure, stride);
            self.push_through(solid, change, 1.0, stride, (&counts, out));
        }
    }

    /// Sum over the faces of a body of pressure differences times covered parts: a force and a torque.
    pub fn load(&self, solid: &Solid, pressure: &[Real], stride: usize) -> [f64; 3] {
        let mut load = [0.0; 3];
        for face in self.faces_of(solid) {
            let (here, back) = (face.cell as usize, face.back(stride));
            let push = f64::from(face.open) * (f64::from(pressure[back]) - f64::from(pressure[here]));
            load[usize::from(face.axis)] += push;
            load[2] += push * face.arm;
        }
        load
    }

    /// Change of the velocity of a body by a pressure [m/s], [rad/s].
    pub fn change(&self, solid: &Solid, pressure: &[Real], stride: usize) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for response in &self.responses[solid.responses.clone()] {
            let load = self.load(&self.solids[response.to as usize], pressure, stride);
            let change = response.change.map(|row| dot3(row, load));
            sum = std::array::from_fn(|k| sum[k] + change[k]);
        }
        sum
    }

    /// Adds the flow through the faces of a body that moves at this velocity, times a factor: out of the cell behind a
    /// face and into the cell ahead.
    fn push_through(
        &self,
        solid: &Solid,
        velocity: [f64; 3],
        factor: f64,
        stride: usize,
        (counts, out): (&impl Fn(usize) -> bool, &mut [Real]),
    ) {
        for face in self.faces_of(solid) {
            let normal = velocity[usize::from(face.axis)] + velocity[2] * face.arm;
            let flow = (factor * normal * f64::from(face.open)) as Real;
            let (here, back) = (face.cell as usize, face.back(stride));
            if counts(back) {
                out[back] += flow;
            }
            if counts(here) {
                out[here] -= flow;
            }
        }
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        let of_bodies = held(&self.solids) + held(&self.faces) + held(&self.responses) + held(&self.numbers);
        of_bodies + held(&self.intervals) + held(&self.parts) + self.outline.memory_bytes()
    }
}

impl Solid {
    /// A body, with its faces and its mobility.
    fn new(
        (bodies, body): (&Bodies, u32),
        faces: Range<usize>,
        (lattice, mobility): (&Lattice, Mobility),
        units: Units,
    ) -> Self {
        let view = &bodies.views()[body as usize];
        let moved = bodies.displacement_at(body, Vector64::ZERO);
        let turned = bodies.displacement_at(body, Vector64::X).y - moved.y;
        let area = view.sample_area * view.samples.len() as f64;
        let lightness = units.cell_mass * area / (view.mass * f64::from(lattice.cell * lattice.cell));
        Solid {
            body,
            faces,
            responses: 0..0,
            velocity: [moved.x, moved.y, turned].map(|moved| moved / units.dt),
            lightness: [0, 1].map(|axis| (lightness * view.mass * mobility[axis][axis]) as Real),
        }
    }

    /// Whether it covers a face.
    pub fn covers(&self) -> bool {
        !self.faces.is_empty()
    }
}

impl Covered {
    /// The cell behind the face.
    pub fn back(&self, stride: usize) -> usize {
        self.cell as usize - if self.axis == 0 { 1 } else { stride }
    }
}

/// The pose between two.
fn halfway(from: Pose, to: Pose) -> Pose {
    Pose { position: from.position.lerp(to.position, 0.5), angle: 0.5 * (from.angle + to.angle) }
}

/// The whole numbers from `low` up to `high`, between 0 and `most`.
fn within(low: f64, high: f64, most: usize) -> Range<usize> {
    let number = |at: f64| at.clamp(0.0, most as f64) as usize;
    number(low)..number(high)
}

/// A force and a torque, or a displacement, as a twist.
pub(super) fn twist(parts: [f64; 3]) -> Twist {
    Twist { linear: Vector64::new(parts[0], parts[1]), angular: parts[2] }
}
