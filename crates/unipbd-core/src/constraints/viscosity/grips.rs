//! Bodies that a viscous fluid does not slip along. Their velocities are unknowns of its step, beside those of the
//! particles: a light body is as stable as a heavy one, and what the fluid loses a body gains.

use crate::bytes::held;
use crate::constraints::Substep;
use crate::math::{Real, Vector, Vector64, dot3, vector, wide};
use crate::parallel::CHUNK_ROWS;
use crate::rigid::{Mobility, Twist};

/// An impulse with its moment about the centre of mass of a body, or a velocity with its spin.
type Screw = [f64; 3];

/// A particle beside a body.
#[derive(Clone, Copy, Debug)]
struct Grip {
    row: usize,
    outline: usize,
    /// From the centre of mass of the body to the particle, where both are predicted to be: with the body's motion gone on
    /// to there, a fluid that turns with the body is not sheared, and the moment of both is kept.
    arm: Vector64,
    /// Shear force per difference of velocities [kg/s].
    strength: f64,
    /// Mass of the particle \[kg].
    mass: f64,
}

/// How a body answers to an impulse on one: that itself, or another one that joints hold to it.
#[derive(Clone, Copy, Debug)]
struct Response {
    outline: usize,
    to: usize,
    change: Mobility,
}

/// The particles that bodies grip in a substep, and the unknowns of the bodies, by outline. All but velocities are
/// impulses: those of a body that nothing moves are unknown too.
#[derive(Default)]
pub(super) struct Grips {
    grips: Vec<Grip>,
    responses: Vec<Response>,
    /// Predicted velocities [m/s], [rad/s].
    predicted: Vec<Screw>,
    /// Impulses on the bodies so far [kg m/s].
    pub impulse: Vec<Screw>,
    pub residual: Vec<Screw>,
    pub direction: Vec<Screw>,
    /// Impulses of the last [`Grips::pull`].
    pub sums: Vec<Screw>,
    /// Buffer for the velocities of all bodies.
    moved: Vec<Screw>,
    /// Number of the outline of each body.
    numbers: Vec<Option<usize>>,
}

impl Grips {
    /// Finds what bodies grip. `strength` tells of a row the shear force per difference of velocities and rate [kg m^2/s]
    /// and the mass \[kg], of rows that bodies may pull.
    pub fn find(&mut self, now: Substep<'_>, least: Real, strength: impl Fn(usize) -> Option<(f64, f64)>) {
        self.grips.clear();
        let (outlines, particles) = (now.without_slip.outlines, now.particles);
        if outlines.is_empty() {
            return;
        }
        self.find_bodies(now);
        let grips = &mut self.grips;
        for (number, points) in particles.positions()[..particles.listed()].chunks(CHUNK_ROWS).enumerate() {
            outlines.shears(points, least, |k, shear| {
                let row = number * CHUNK_ROWS + k;
                if let Some((per_rate, mass)) = strength(row) {
                    let strength = per_rate * f64::from(shear.rate);
                    grips.push(Grip { row, outline: shear.outline, arm: shear.arm, strength, mass });
                }
            });
        }
    }

    fn find_bodies(&mut self, now: Substep<'_>) {
        let (outlines, Some((bodies, mobilities))) = (now.without_slip.outlines, now.without_slip.bodies) else {
            return;
        };
        self.numbers.clear();
        self.numbers.resize(bodies.len(), None);
        (0..outlines.len()).for_each(|outline| self.numbers[outlines.body(outline) as usize] = Some(outline));
        self.responses.clear();
        self.predicted.clear();
        for outline in 0..outlines.len() {
            let body = outlines.body(outline);
            let moved = bodies.predicted_displacement(body).scaled(1.0 / f64::from(now.dt));
            self.predicted.push([moved.linear.x, moved.linear.y, moved.angular]);
            for &other in mobilities.companions(body) {
                let change = mobilities.between(body, other);
                if let Some(to) = self.numbers[other as usize].filter(|_| change != Mobility::default()) {
                    self.responses.push(Response { outline, to, change });
                }
            }
        }
        for column in [&mut self.impulse, &mut self.residual, &mut self.direction, &mut self.sums, &mut self.moved] {
            column.clear();
            column.resize(outlines.len(), Screw::default());
        }
    }

    /// Whether bodies grip anything.
    pub fn any(&self) -> bool {
        !self.grips.is_empty()
    }

    /// A bound of the rate at which the velocity of a body decays to that of the fluid [1/s].
    pub fn fastest_decay(&self) -> f64 {
        let own = |outline: usize| self.responses.iter().find(move |of| of.outline == outline && of.to == outline);
        let of_body = |outline: usize| {
            let Some(Response { change, .. }) = own(outline) else { return 0.0 };
            let grips = self.grips.iter().filter(|grip| grip.outline == outline);
            let across = |arm: Vector64| [[1.0, 0.0, -arm.y], [0.0, 1.0, arm.x]];
            grips.map(|grip| grip.strength * across(grip.arm).iter().map(|way| along(change, way)).sum::<f64>()).sum()
        };
        (0..self.predicted.len()).map(of_body).fold(0.0, f64::max)
    }

    /// Square of the largest velocity of a body at a particle [m^2/s^2].
    pub fn fastest_squared(&self) -> f64 {
        let squares = self.grips.iter().map(|grip| at(self.predicted[grip.outline], grip.arm).length_squared());
        squares.fold(0.0, f64::max)
    }

    /// Adds the pull of the bodies, which have their predicted velocities and those of the impulses so far, over a step:
    /// to the velocities of the rows, and the opposite to the sums of the bodies.
    pub fn pull_at_start(&mut self, field: &[Vector], out: &mut [Vector], dt: f64) {
        self.moved.copy_from_slice(&self.predicted);
        self.pull(field, out, dt);
    }

    /// The same of the directions.
    pub fn pull_along(&mut self, field: &[Vector], out: &mut [Vector], dt: f64) {
        let mut moved = std::mem::take(&mut self.moved);
        self.respond(&self.direction, &mut moved);
        self.moved = moved;
        self.pull(field, out, dt);
    }

    fn pull(&mut self, field: &[Vector], out: &mut [Vector], dt: f64) {
        self.sums.fill(Screw::default());
        for grip in &self.grips {
            let pull = (at(self.moved[grip.outline], grip.arm) - wide(field[grip.row])) * (grip.strength * dt);
            out[grip.row] += vector(pull / grip.mass);
            let sum = &mut self.sums[grip.outline];
            *sum = [sum[0] - pull.x, sum[1] - pull.y, sum[2] - grip.arm.perp_dot(pull)];
        }
    }

    /// Velocities by impulses.
    fn respond(&self, impulses: &[Screw], moved: &mut [Screw]) {
        moved.fill(Screw::default());
        for Response { outline, to, change } in &self.responses {
            let of = impulses[*to];
            moved[*outline] = std::array::from_fn(|k| moved[*outline][k] + dot3(change[k], of));
        }
    }

    /// Twice the energy of two sets of impulses.
    pub fn product(&self, a: &[Screw], b: &[Screw]) -> f64 {
        let of = |response: &Response| {
            let moved: Screw = std::array::from_fn(|k| dot3(response.change[k], b[response.to]));
            dot3(a[response.outline], moved)
        };
        self.responses.iter().map(of).sum()
    }

    /// The product of system and direction: the direction less its pull.
    pub fn take_from_direction(&mut self) {
        self.sums.iter_mut().zip(&self.direction).for_each(|(sum, p)| *sum = std::array::from_fn(|k| p[k] - sum[k]));
    }

    /// Goes a step along the direction.
    pub fn go(&mut self, step: f64) {
        add_scaled(&mut self.impulse, &self.direction, step);
        add_scaled(&mut self.residual, &self.sums, -step);
    }

    /// The next direction: the residual, and this part of the last direction.
    pub fn turn(&mut self, kept: f64) {
        for (p, residual) in self.direction.iter_mut().zip(&self.residual) {
            *p = std::array::from_fn(|k| residual[k] + p[k] * kept);
        }
    }

    /// The impulses on the bodies, by outline [kg m/s], [kg m^2/s].
    pub fn impulses(&self) -> impl Iterator<Item = Twist> + '_ {
        let twist = |[x, y, turn]: Screw| Twist { linear: Vector64::new(x, y), angular: turn };
        self.impulse.iter().filter(|_| self.any()).map(move |&impulse| twist(impulse))
    }

    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        let columns = [&self.predicted, &self.impulse, &self.residual, &self.direction, &self.sums, &self.moved];
        columns.map(held).iter().sum::<usize>() + held(&self.grips) + held(&self.responses) + held(&self.numbers)
    }
}

/// a += b s.
fn add_scaled(a: &mut [Screw], b: &[Screw], s: f64) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a = std::array::from_fn(|k| a[k] + b[k] * s));
}

/// The velocity at an arm.
fn at([x, y, turn]: Screw, arm: Vector64) -> Vector64 {
    Vector64::new(x, y) + arm.perp() * turn
}

fn along(change: &Mobility, way: &Screw) -> f64 {
    dot3(change.map(|row| dot3(row, *way)), *way)
}
