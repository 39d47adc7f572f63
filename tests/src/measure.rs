//! Figures taken from positions and velocities alone, without the solver's own measurements.

use unipbd_core::math::{Vector64, wide};
use unipbd_core::{Phase, Solver};

/// Rows of one phase.
pub fn of_phase(solver: &Solver, phase: Phase) -> impl Iterator<Item = usize> {
    solver.phases().iter().enumerate().filter(move |(_, other)| **other == phase).map(|(row, _)| row)
}

/// Mean of a figure; NaN of none.
pub fn mean_of(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Kinetic energy per mass of all moving dense particles of equal mass, from the velocities [m^2/s^2].
pub fn kinetic_energy(solver: &Solver) -> f64 {
    let velocities = &solver.velocities()[..solver.particles().dense()];
    mean_of(velocities.iter().map(|velocity| 0.5 * wide(*velocity).length_squared()))
}

/// Part of the points whose nearest neighbour is nearer than `distance`.
pub fn crowded(mut points: Vec<Vector64>, distance: f64) -> f64 {
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    let close = |a: usize, b: usize| points[a].distance_squared(points[b]) < distance * distance;
    let reach = |a: usize, b: usize| (points[a].x - points[b].x).abs() < distance;
    let has_close = |&row: &usize| {
        (row + 1..points.len()).take_while(|&other| reach(row, other)).any(|other| close(row, other))
            || (0..row).rev().take_while(|&other| reach(row, other)).any(|other| close(row, other))
    };
    (0..points.len()).filter(has_close).count() as f64 / points.len().max(1) as f64
}

/// Whether two figures differ by at most this part of their size.
pub fn is_near(a: f64, b: f64, part: f64) -> bool {
    (a - b).abs() <= part * a.abs().max(b.abs())
}

/// Largest and mean of figures that come one by one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spread {
    sum: f64,
    count: f64,
    max: Option<f64>,
}

impl Spread {
    /// Takes up a figure.
    pub fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
        self.max = Some(self.max.map_or(value, |max| max.max(value)));
    }

    /// The largest; NaN of none.
    pub fn max(&self) -> f64 {
        self.max.unwrap_or(f64::NAN)
    }

    /// The mean; NaN of none.
    pub fn mean(&self) -> f64 {
        self.sum / self.count
    }
}
