//! Where the density and its gradients are taken.

use crate::bytes::held;
use crate::constraints::Substep;
use crate::math::{Real, Vector, larger, real};
use crate::particles::Particles;
use crate::scene::{COURANT, GradientPoint};
use std::borrow::Cow;
use std::ops::Range;

/// Farther than this many spacings from the origin f32 keeps too few digits of a position for kernels.
const FAR: Real = 4096.0;
/// The positions that a density iteration works with.
pub(super) struct Places {
    gradients: GradientPoint,
    /// [`FAR`] in metres.
    far: Real,
    /// How far behind the prediction the constraint is taken, as a part of the way of the substep.
    behind: Real,
    /// Longest way of a particle in a substep by the Courant condition \[m], and the most that the constraint is taken
    /// behind the prediction: one that is too fast for its substeps is stopped by walls and others, and was never
    /// that far back along its velocity.
    longest_way: Real,
    /// The positions there, if it is.
    earlier: Vec<Vector>,
    /// Far from the origin: positions from the middle of the domain, with the digits that rounding kept out
    /// of them, where the density is taken...
    value: Vec<Vector>,
    /// ...and where its gradient is, if elsewhere.
    gradient: Vec<Vector>,
}

impl Places {
    pub fn new(gradients: GradientPoint, spacing: f64) -> Places {
        let behind = real(gradients.behind());
        let (far, longest_way) = (FAR * real(spacing), real(COURANT) * real(spacing));
        Places { gradients, far, behind, longest_way, earlier: Vec::new(), value: Vec::new(), gradient: Vec::new() }
    }

    pub fn memory_bytes(&self) -> usize {
        held(&self.earlier) + held(&self.value) + held(&self.gradient)
    }

    /// Finds the places of an [`iteration`](Self::iteration).
    pub fn find(&mut self, now: Substep<'_>) {
        self.find_earlier(now);
        let fine = self.is_far(now.particles);
        let rows = if fine { now.particles.dense() } else { 0 };
        self.value.resize(rows, Vector::ZERO);
        self.gradient.resize(if self.gradients == GradientPoint::Start { rows } else { 0 }, Vector::ZERO);
        if fine && now.particles.listed() > 0 {
            self.find_fine(now);
        }
    }

    /// x - b dt v, where the constraint is taken behind the prediction: it lets a wave pass with 1 - b of the damping
    /// (the iteration is stable for omega lambda < 4/(3 - 2 b)).
    fn find_earlier(&mut self, now: Substep<'_>) {
        if self.behind == 0.0 {
            return;
        }
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let (behind, longest) = (self.behind, self.longest_way);
        self.earlier.resize(now.particles.dense(), Vector::ZERO);
        if now.particles.listed() == 0 {
            return; // All asleep: nobody asks.
        }
        now.parallelism
            .fill(&mut self.earlier, |row| positions[row] - at_most(velocities[row] * now.dt, longest) * behind);
    }

    /// Rows are in the order of cells: where all are far from the origin, the first and the last one are.
    fn is_far(&self, particles: &Particles) -> bool {
        let rows = &particles.positions()[..particles.dense()];
        let far = |row: Option<&Vector>| row.is_some_and(|x| x.abs().max_element() > self.far);
        cfg!(not(feature = "f64")) && (far(rows.first()) || far(rows.last()))
    }

    /// (x_n - origin) + (u + rem): the difference is exact near the origin chosen, and nothing is rounded away.
    fn find_fine(&mut self, now: Substep<'_>) {
        let particles = now.particles;
        let (starts, displacements) = (particles.starts(), &particles.displacement);
        let (remainders, velocities) = (&particles.remainder, particles.velocities());
        let origin = middle_of(now, starts);
        let (behind, longest) = (self.behind, self.longest_way);
        now.parallelism.fill(&mut self.value, |row| {
            let back = at_most(velocities[row] * now.dt, longest) * behind;
            (starts[row] - origin) + (displacements[row] + remainders[row]) - back
        });
        now.parallelism.fill(&mut self.gradient, |row| (starts[row] - origin) + remainders[row]);
    }

    /// The positions after a substep, for differences between particles alone.
    pub fn measured<'a>(&self, now: Substep<'a>) -> Cow<'a, [Vector]> {
        let (positions, remainders) = (now.particles.positions(), &now.particles.remainder);
        if !self.is_far(now.particles) {
            return Cow::Borrowed(&positions[..now.particles.dense()]);
        }
        let origin = middle_of(now, positions);
        Cow::Owned((0..now.particles.dense()).map(|row| (positions[row] - origin) + remainders[row]).collect())
    }

    /// The places of the iteration that were [found](Self::find).
    pub fn iteration<'a>(&'a self, now: Substep<'a>) -> Iteration<'a> {
        let rows = now.particles.dense();
        let split = self.gradients == GradientPoint::Start;
        let points = |value: &'a [Vector], start: &'a [Vector]| Points {
            value,
            gradient: &(if split { start } else { value })[..rows],
            split,
        };
        let value = if self.behind == 0.0 { now.particles.positions() } else { &self.earlier };
        let world = points(value, now.particles.starts());
        let pairs = if self.value.is_empty() { world } else { points(&self.value, &self.gradient) };
        Iteration { world, pairs }
    }
}

/// Where an iteration takes the density constraint.
pub(super) struct Iteration<'a> {
    /// Places in the world, for walls.
    pub world: Points<'a>,
    /// Places for differences between particles alone: far from the origin in digits that f32 has for them.
    pub pairs: Points<'a>,
}

/// Positions by row.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    /// Where the density is taken.
    pub value: &'a [Vector],
    /// Where its gradient is taken.
    pub gradient: &'a [Vector],
    /// Whether these are different places.
    split: bool,
}

impl<'a> Points<'a> {
    /// Where the gradient is taken, if not where the density is.
    pub fn other_gradient(&self) -> Option<&'a [Vector]> {
        self.split.then_some(self.gradient)
    }
}

/// A way, no longer than `longest`.
#[inline]
fn at_most(way: Vector, longest: Real) -> Vector {
    let square = longest * longest;
    way * (square / larger(way.length_squared(), square)).sqrt()
}

/// The middle of the box around all rows.
fn middle_of(now: Substep<'_>, positions: &[Vector]) -> Vector {
    let of_rows = |rows: Range<usize>| {
        let start = (Vector::INFINITY, Vector::NEG_INFINITY);
        rows.map(|row| positions[row]).fold(start, |(least, most), x| (least.min(x), most.max(x)))
    };
    let (least, most) = now.parallelism.reduce(now.particles.dense(), of_rows, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    (least + most) * 0.5
}
