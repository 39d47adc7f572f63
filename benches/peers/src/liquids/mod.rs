//! The two cases of liquids, the same for every solver, and how their density errors are measured.

mod python;
mod salva;
mod table;
mod unipbd;

use cpu_time::ProcessTime;
use unipbd_validation::compression::{Errors, Estimator};

pub use table::sections;

/// A block of liquid on a lattice of spacing `dx` in a tank from the origin.
#[derive(Clone, Copy)]
pub struct Case {
    pub name: &'static str,
    pub block: [f64; 2],
    pub tank: [f64; 2],
    pub dx: f64,
    /// Simulated time [s].
    pub seconds: f64,
}

/// Seconds between two looks at the positions.
const LOOK: f64 = 0.1;
/// Radius of the estimate's kernel, in spacings.
const REACH: f64 = 2.5;
/// Gravity, downwards [m/s^2].
const GRAVITY: f64 = 9.81;

impl Case {
    /// A column twice as high as wide collapses.
    pub fn dam_break(particles: usize, seconds: f64) -> Case {
        let dx = 1.0 / (particles as f64 / 2.0).sqrt().round();
        Case { name: "dam break", block: [1.0, 2.0], tank: [3.2, 4.0], dx, seconds }
    }

    /// A square pool at rest.
    pub fn still_tank(particles: usize, seconds: f64) -> Case {
        let dx = 1.0 / (particles as f64).sqrt().round();
        Case { name: "still tank", block: [1.0, 1.0], tank: [1.0, 2.0], dx, seconds }
    }

    fn lattice(&self) -> Vec<[f64; 2]> {
        let count = |length: f64| (length / self.dx).round() as usize;
        let (columns, rows) = (count(self.block[0]), count(self.block[1]));
        let at = |k: usize| [(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5].map(|x| x * self.dx);
        (0..columns * rows).map(at).collect()
    }

    /// Density errors of the interior.
    fn errors(&self, positions: &[[f64; 2]]) -> Errors {
        Estimator { spacing: self.dx, radius: REACH, tank: self.tank }.errors(positions)
    }

    /// Length of a step of the peers without substeps of their own [s].
    fn step(&self) -> f64 {
        (0.1 * self.dx).min(0.002)
    }
}

/// What a run of one solver gave.
pub struct Outcome {
    pub solver: String,
    /// Processor time of the steps alone [s]: on one thread the wall-clock time of a machine that does nothing else.
    pub time: f64,
    pub steps: u64,
    /// Density errors of all looks.
    pub errors: Errors,
    /// Height of the centre of mass at the end [m].
    pub height: f64,
}

impl Outcome {
    /// Whether another is quicker without larger errors, or better at no more cost.
    fn is_beaten_by(&self, other: &Outcome) -> bool {
        let (mine, theirs) = ((self.time, self.errors.mean()), (other.time, other.errors.mean()));
        theirs.0 <= mine.0 && theirs.1 <= mine.1 && theirs != mine
    }
}

/// A solver that holds a case.
trait Runs {
    /// Advances by its step, whose length it returns [s].
    fn step(&mut self) -> f64;
    fn positions(&self) -> Vec<[f64; 2]>;
}

/// Runs a case to its end. Only the steps are timed.
fn run(case: &Case, solver: String, runs: &mut impl Runs) -> Outcome {
    let mut outcome = Outcome { solver, time: 0.0, steps: 0, errors: Errors::default(), height: 0.0 };
    let (mut time, mut next) = (0.0, LOOK);
    while time < case.seconds - 1e-9 {
        let begin = ProcessTime::now();
        let dt = runs.step();
        outcome.time += begin.elapsed().as_secs_f64();
        outcome.steps += 1;
        time += dt;
        if time >= next - 1e-9 {
            next += LOOK;
            outcome.errors = outcome.errors.and(case.errors(&runs.positions()));
        }
    }
    outcome.height = mean_height(&runs.positions());
    outcome
}

fn mean_height(positions: &[[f64; 2]]) -> f64 {
    positions.iter().map(|x| x[1]).sum::<f64>() / positions.len() as f64
}
