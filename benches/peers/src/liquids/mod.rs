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
#[derive(Default)]
pub struct Outcome {
    pub solver: String,
    /// Processor time of the steps alone [s]: on one thread the wall-clock time of a machine that does nothing else.
    pub time: f64,
    /// Steps, or substeps where frames consist of them.
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
trait Solver {
    /// Its name and settings.
    fn name(&self) -> String;
    /// Advances to this time.
    fn advance(&mut self, until: f64) -> Result<Spent, String>;
    fn positions(&self) -> Vec<[f64; 2]>;
}

/// What an advance took.
#[derive(Clone, Copy, Default)]
struct Spent {
    /// Processor time [s].
    time: f64,
    steps: u64,
}

impl Spent {
    /// Calls `step` from one time to another, which returns how far it came [s] in how many steps; only it is timed.
    fn by(now: &mut f64, until: f64, mut step: impl FnMut() -> (f64, u64)) -> Spent {
        let mut spent = Spent::default();
        while *now < until - 1e-9 {
            let begin = ProcessTime::now();
            let (length, steps) = step();
            *now += length;
            spent = Spent { time: spent.time + begin.elapsed().as_secs_f64(), steps: spent.steps + steps };
        }
        spent
    }
}

/// Runs a case to its end by all solvers in turn, from look to look: a slow moment of the machine hits all of them.
fn race(case: &Case, solvers: &mut [Box<dyn Solver>]) -> Result<Vec<Outcome>, String> {
    let start = |solver: &Box<dyn Solver>| Outcome { solver: solver.name(), ..Outcome::default() };
    let mut outcomes: Vec<Outcome> = solvers.iter().map(start).collect();
    for look in 1..=(case.seconds / LOOK).round() as u32 {
        for (solver, outcome) in solvers.iter_mut().zip(&mut outcomes) {
            let spent = solver.advance(LOOK * f64::from(look))?;
            let positions = solver.positions();
            outcome.time += spent.time;
            outcome.steps += spent.steps;
            outcome.errors = outcome.errors.and(case.errors(&positions));
            outcome.height = positions.iter().map(|x| x[1]).sum::<f64>() / positions.len() as f64;
        }
    }
    Ok(outcomes)
}
