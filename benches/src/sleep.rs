//! What a pool that sleeps costs over the same pool awake.

use std::time::Instant;

use unipbd_core::Solver;
use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Substeps, Tank};

use crate::solver;

/// Spacing of a pool 4 m wide and 1 m deep: 10,000 particles \[m].
const SPACING: f64 = 0.02;

/// Milliseconds per frame of a pool: awake, and asleep. `None` where it did not fall asleep in `frames`.
pub fn measure(frames: u32) -> Option<[f64; 2]> {
    let settings = |sleep| SolverSettings { sleep, substeps: Substeps::Fixed(8), ..SolverSettings::default() };
    let scene = |sleep| Scene {
        spacing: SPACING,
        liquid: vec![Liquid { xsph: 0.1, ..Liquid::new("water", 1000.0) }],
        block: vec![Block::new("water", [0.0, 0.0], [4.0, 1.0])],
        tank: vec![Tank::new([0.0, 0.0], [4.0, 2.0])],
        solver: settings(sleep),
        ..Scene::default()
    };
    let mut sleeper = solver(&scene(true), 1);
    for _ in 0..frames {
        if sleeper.particles().awake() == 0 {
            break;
        }
        sleeper.step_frame().expect("a pool is calm");
    }
    let mut awake = solver(&scene(false), 1);
    let (mut least, rounds) = ([f64::INFINITY; 2], 15);
    for _ in 0..rounds {
        least[0] = least[0].min(frame(&mut awake));
        least[1] = least[1].min(frame(&mut sleeper));
    }
    (sleeper.particles().awake() == 0).then_some(least)
}

fn frame(solver: &mut Solver) -> f64 {
    let begin = Instant::now();
    solver.step_frame().expect("a pool is calm");
    1e3 * begin.elapsed().as_secs_f64()
}
