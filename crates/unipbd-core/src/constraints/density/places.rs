//! Where the density and its gradients are taken.

use crate::bytes::held;
use crate::constraints::Substep;
use crate::math::{Real, Vector, larger, real};
use crate::particles::Particles;
use crate::scene::GradientPoint;
use std::ops::Range;

/// Farther than this many spacings from the origin f32 keeps too few digits of a position for kernels.
const FAR: Real = 4096.0;
/// Half way is at most this many spacings behind the prediction: half of what the Courant condition lets a particle go.
/// One that is too fast for its substeps is stopped by walls and others, and was never half way back along its velocity.
const FARTHEST_BACK: Real = 0.2;

/// The positions that a density iteration works with.
pub(super) struct Places {
    gradients: GradientPoint,
    /// [`FAR`] in metres.
    far: Real,
    /// [`FARTHEST_BACK`] in metres.
    farthest_back: Real,
    /// Half way between start and prediction, where the constraint is taken there.
    middle: Vec<Vector>,
    /// Far from the origin: positions from the middle of the domain, with the digits that rounding kept out
    /// of them, where the density is taken...
    value: Vec<Vector>,
    /// ...and where its gradient is, if elsewhere.
    gradient: Vec<Vector>,
}

impl Places {
    pub fn new(gradients: GradientPoint, spacing: f64) -> Places {
        let (far, farthest_back) = (FAR * real(spacing), FARTHEST_BACK * real(spacing));
        Places { gradients, far, farthest_back, middle: Vec::new(), value: Vec::new(), gradient: Vec::new() }
    }

    pub fn memory_bytes(&self) -> usize {
        held(&self.middle) + held(&self.value) + held(&self.gradient)
    }

    /// Finds the places of an iteration.
    pub fn find(&mut self, now: Substep<'_>) {
        self.find_middle(now);
        let fine = self.is_far(now.particles);
        let rows = if fine { now.particles.dense() } else { 0 };
        self.value.resize(rows, Vector::ZERO);
        self.gradient.resize(if self.gradients == GradientPoint::Start { rows } else { 0 }, Vector::ZERO);
        if fine && now.particles.listed() > 0 {
            self.find_fine(now);
        }
    }

    /// x - dt v/2, where the constraint is taken half way: it lets a wave pass with half the damping
    /// (the iteration is stable for omega lambda < 2 instead of 4/3).
    fn find_middle(&mut self, now: Substep<'_>) {
        if self.gradients != GradientPoint::Middle {
            return;
        }
        let (positions, velocities) = (now.particles.positions(), now.particles.velocities());
        let (half, farthest) = (0.5 * now.dt, self.farthest_back);
        self.middle.resize(now.particles.dense(), Vector::ZERO);
        if now.particles.listed() == 0 {
            return; // All asleep: nobody asks.
        }
        now.parallelism.fill(&mut self.middle, |row| positions[row] - back(velocities[row], half, farthest));
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
        let half = if self.gradients == GradientPoint::Middle { 0.5 * now.dt } else { 0.0 };
        let farthest = self.farthest_back;
        now.parallelism.fill(&mut self.value, |row| {
            (starts[row] - origin) + (displacements[row] + remainders[row]) - back(velocities[row], half, farthest)
        });
        now.parallelism.fill(&mut self.gradient, |row| (starts[row] - origin) + remainders[row]);
    }

    /// The positions as they are after a substep, for differences of them alone, where f32 would spoil those.
    pub fn settled(&self, now: Substep<'_>) -> Option<Vec<Vector>> {
        let (positions, remainders) = (now.particles.positions(), &now.particles.remainder);
        self.is_far(now.particles).then(|| {
            let origin = middle_of(now, positions);
            (0..now.particles.dense()).map(|row| (positions[row] - origin) + remainders[row]).collect()
        })
    }

    /// Positions at which the density is taken.
    pub fn values<'a>(&'a self, now: Substep<'a>) -> &'a [Vector] {
        match self.gradients {
            GradientPoint::Predicted | GradientPoint::Start => now.particles.positions(),
            GradientPoint::Middle => &self.middle,
        }
    }

    /// Positions at which gradients are taken, if elsewhere.
    pub fn other_gradients<'a>(&'a self, now: Substep<'a>) -> Option<&'a [Vector]> {
        (self.gradients == GradientPoint::Start).then(|| now.particles.starts())
    }

    /// Positions at which gradients are taken.
    pub fn gradients<'a>(&'a self, now: Substep<'a>) -> &'a [Vector] {
        &self.other_gradients(now).unwrap_or(self.values(now))[..now.particles.dense()]
    }

    /// As [`values`](Self::values), for differences of positions alone.
    pub fn pair_values<'a>(&'a self, now: Substep<'a>) -> &'a [Vector] {
        if self.value.is_empty() { self.values(now) } else { &self.value }
    }

    /// As [`other_gradients`](Self::other_gradients), for differences of positions alone.
    pub fn other_pair_gradients<'a>(&'a self, now: Substep<'a>) -> Option<&'a [Vector]> {
        if self.gradient.is_empty() { self.other_gradients(now) } else { Some(&self.gradient) }
    }

    /// As [`gradients`](Self::gradients), for differences of positions alone.
    pub fn pair_gradients<'a>(&'a self, now: Substep<'a>) -> &'a [Vector] {
        &self.other_pair_gradients(now).unwrap_or(self.pair_values(now))[..now.particles.dense()]
    }
}

/// The way back over this time [s], no longer than `farthest` [m].
#[inline]
fn back(velocity: Vector, time: Real, farthest: Real) -> Vector {
    let way = velocity * time;
    let square = farthest * farthest;
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
