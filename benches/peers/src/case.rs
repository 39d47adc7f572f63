//! The two cases, the same for every solver, and how their compression is measured.

use cpu_time::ProcessTime;
use unipbd_validation::compression::Estimator;

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
pub const LOOK: f64 = 0.1;
/// Radius of the estimate's kernel, in spacings.
const REACH: f64 = 2.5;

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

    pub fn lattice(&self) -> Vec<[f64; 2]> {
        let count = |length: f64| (length / self.dx).round() as usize;
        let (columns, rows) = (count(self.block[0]), count(self.block[1]));
        let at = |k: usize| [(k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5].map(|x| x * self.dx);
        (0..columns * rows).map(at).collect()
    }

    /// Mean compression, max(rho/rho0 - 1, 0), over the interior.
    pub fn compression(&self, positions: &[[f64; 2]]) -> f64 {
        let estimator = Estimator { spacing: self.dx, radius: REACH, tank: self.tank };
        estimator.errors(positions).mean_compression()
    }
}

/// What a run of one solver gave.
pub struct Outcome {
    pub solver: String,
    /// Processor time of the steps alone [s]: on one thread the wall-clock time of a machine that does nothing else.
    pub time: f64,
    pub steps: u64,
    /// Compression at each look.
    pub compression: Vec<f64>,
    /// Height of the centre of mass at the end [m].
    pub height: f64,
}

impl Outcome {
    pub fn mean_compression(&self) -> f64 {
        self.compression.iter().sum::<f64>() / self.compression.len().max(1) as f64
    }
}

/// A solver that holds a case.
pub trait Runs {
    /// Advances by its step, whose length it returns [s].
    fn step(&mut self) -> f64;
    fn positions(&self) -> Vec<[f64; 2]>;
}

/// Runs a case to its end. Only the steps are timed.
pub fn run(case: &Case, solver: String, runs: &mut impl Runs) -> Outcome {
    let mut outcome = Outcome { solver, time: 0.0, steps: 0, compression: Vec::new(), height: 0.0 };
    let (mut time, mut next) = (0.0, LOOK);
    while time < case.seconds - 1e-9 {
        let begin = ProcessTime::now();
        let dt = runs.step();
        outcome.time += begin.elapsed().as_secs_f64();
        outcome.steps += 1;
        time += dt;
        if time >= next - 1e-9 {
            next += LOOK;
            outcome.compression.push(case.compression(&runs.positions()));
        }
    }
    let positions = runs.positions();
    outcome.height = positions.iter().map(|x| x[1]).sum::<f64>() / positions.len() as f64;
    outcome
}
