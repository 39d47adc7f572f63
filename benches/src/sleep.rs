//! What a pool that sleeps costs over the same pool awake.

use std::time::Instant;

use unipbd_core::Solver;
use unipbd_core::scene::{Scene, SolverSettings};

use crate::{pool, solver};

/// Milliseconds per frame of a pool of about this many particles: awake, and asleep. `None` where it did
/// not fall asleep in `frames`.
pub fn measure(particles: usize, frames: u32) -> Option<[f64; 2]> {
    let base = pool(particles);
    let scene = |sleep| Scene { solver: SolverSettings { sleep, ..base.solver.clone() }, ..base.clone() };
    let mut sleeper = calmed(&scene(true));
    for _ in 0..frames {
        if sleeper.particles().awake() == 0 {
            break;
        }
        sleeper.step_frame().expect("a pool is calm");
    }
    let mut awake = calmed(&scene(false));
    let (mut least, rounds) = ([f64::INFINITY; 2], 15);
    for _ in 0..rounds {
        least[0] = least[0].min(frame(&mut awake));
        least[1] = least[1].min(frame(&mut sleeper));
    }
    (sleeper.particles().awake() == 0).then_some(least)
}

fn calmed(scene: &Scene) -> Solver {
    let mut viscous = scene.clone();
    viscous.liquid[0].viscosity = 0.1;
    solver(&viscous, 1)
}

fn frame(solver: &mut Solver) -> f64 {
    let begin = Instant::now();
    solver.step_frame().expect("a pool is calm");
    1e3 * begin.elapsed().as_secs_f64()
}
