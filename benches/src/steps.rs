//! Times whole frames by size and number of threads, in turn.

use std::time::{Duration, Instant};

use unipbd_core::Solver;
use unipbd_core::scene::{Scene, SolverSettings, Substeps};

use crate::{dam_break, solver};

/// Substeps per frame.
const SUBSTEPS: u32 = 4;

/// Nanoseconds per particle and substep of one size.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Number of particles.
    pub particles: usize,
    /// The least over all frames, on one and on two threads \[ns].
    pub least: [f64; 2],
    /// Memory of particles, lists and indexes [bytes per particle].
    pub bytes: f64,
    /// Time of each stage on one thread over all frames [ns per particle and substep].
    pub stages: Vec<(&'static str, f64)>,
}

/// A dam break of about this many particles that has run for some frames.
pub fn measure(size: usize, frames: u32) -> Measured {
    let scene = Scene {
        // As long substeps as a run of this size takes.
        fps: 60.0 * (size as f64).sqrt() / 8.0,
        solver: SolverSettings { substeps: Substeps::Fixed(SUBSTEPS), ..SolverSettings::default() },
        ..dam_break(size)
    };
    let mut solvers = [solver(&scene, 1), solver(&scene, 2)];
    for solver in &mut solvers {
        frame(solver);
    }
    let before = stages(&solvers[0]);
    let particles = solvers[0].positions().len();
    let per_particle = |time: Duration| 1e9 * time.as_secs_f64() / particles as f64 / f64::from(SUBSTEPS);
    let mut least = [f64::INFINITY; 2];
    for _ in 0..frames {
        for (solver, least) in solvers.iter_mut().zip(&mut least) {
            *least = least.min(per_particle(frame(solver)));
        }
    }
    let spent = |(name, time): (&'static str, Duration)| {
        let earlier = before.iter().find(|(known, _)| *known == name).map_or(Duration::ZERO, |(_, time)| *time);
        (name, per_particle(time - earlier) / f64::from(frames))
    };
    Measured {
        particles,
        least,
        bytes: solvers[0].memory_bytes() as f64 / particles as f64,
        stages: stages(&solvers[0]).into_iter().map(spent).collect(),
    }
}

/// Exponent with which the time of a substep grows between two sizes, on one thread.
pub fn growth(small: &Measured, large: &Measured) -> f64 {
    1.0 + (large.least[0] / small.least[0]).ln() / (large.particles as f64 / small.particles as f64).ln()
}

fn stages(solver: &Solver) -> Vec<(&'static str, Duration)> {
    solver.timings().to_vec()
}

fn frame(solver: &mut Solver) -> Duration {
    let begin = Instant::now();
    solver.step_frame().expect("a dam break does not diverge");
    begin.elapsed()
}
