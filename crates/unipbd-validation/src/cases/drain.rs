//! Water that runs out of a hole in the floor of a tank.

use unipbd_core::Solver;
use unipbd_core::scene::{Block, Domain, Obstacle, Scene, Side, Tank};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::runner::{Cost, Failure, points};
use crate::scenes::{GRAVITY, SPACING, pool};

/// A hole as wide as `resolution` spacings.
pub const DRAIN: Case = Case {
    name: "drain",
    truth: "Kirchhoff 1869: a jet from a slot contracts to pi/(pi + 2) = 0.611 of its width, at sqrt(2 g head)",
    quick: 4,
    full: &[4, 8, 16],
    targets: &[0.01],
    run: drain,
};

/// Width of the tank, and its heads at the start and the end of the measurement, in holes.
const WIDTH: f64 = 10.0;
const HEADS: [f64; 3] = [12.0, 11.5, 10.0];
/// Thickness of the floor \[spacings].
const FLOOR: f64 = 2.0;

/// Places of the hole beside the middle of the tank \[spacings]: its edges on lines of the pressure grid, and between.
const ASIDE: [f64; 2] = [0.0, 1.0];

fn drain(trial: &Trial) -> Result<Measured, Failure> {
    let [(on_lines, substeps, cost), (between, _, more)] = [discharge(trial, ASIDE[0])?, discharge(trial, ASIDE[1])?];
    let band = trial.with_grid(Band::between(0.60, 0.67));
    let figures = vec![
        Figure::new("discharge coefficient", on_lines, band),
        Figure::new("discharge coefficient half a cell aside", between, band),
        Figure::new(super::SUBSTEPS_PER_FRAME, substeps, Band::OPEN),
    ];
    Ok((figures, cost.and(more)))
}

/// The discharge coefficient of a hole this far aside, substeps per frame, and cost.
fn discharge(trial: &Trial, aside: f64) -> Result<(f64, f64, Cost), Failure> {
    let hole = f64::from(trial.resolution) * SPACING;
    let mut run = trial.start(&with_hole(trial, aside))?;
    let head = |solver: &Solver| above_floor(solver) / (WIDTH * hole);
    let (mut flowed, mut expected, mut frames) = (0.0, 0.0, 0);
    while head(&run.solver) > HEADS[2] * hole && frames < trial.frames.min(6000) {
        let (before, from) = (above_floor(&run.solver), head(&run.solver));
        run.frame()?;
        let middle = 0.5 * (from + head(&run.solver));
        if from < HEADS[1] * hole {
            flowed += before - above_floor(&run.solver);
            expected += hole * (2.0 * GRAVITY * middle).sqrt() * run.solver.frame_time();
        }
        frames += 1;
    }
    let substeps = run.cost.substeps as f64 / f64::from(frames);
    Ok((flowed / expected, substeps, run.cost))
}

fn with_hole(trial: &Trial, aside: f64) -> Scene {
    let cells = f64::from(trial.resolution);
    let (width, top, floor) = (WIDTH * cells, HEADS[0] * cells, -FLOOR);
    let [left, right] = [-0.5, 0.5].map(|side| (0.5 * width + aside + side * cells) * SPACING);
    let at = |x: f64, y: f64| [x * SPACING, y * SPACING];
    let sides = Tank::new(at(0.0, -4.0 * cells), at(width, 2.0 * top));
    Scene {
        block: vec![Block::new("water", [0.0; 2], at(width, top))],
        tank: vec![Tank { open: vec![Side::Top, Side::Bottom], ..sides }],
        obstacle: vec![
            Obstacle::new(at(-cells, floor), [left, 0.0]),
            Obstacle::new([right, floor * SPACING], at(width + cells, 0.0)),
        ],
        domain: Domain { remove_below: Some(at(-cells, -2.0 * cells)), ..Domain::default() },
        ..pool((width, top), width, trial)
    }
}

/// Area of the water above the floor \[m^2].
fn above_floor(solver: &Solver) -> f64 {
    points(solver).filter(|x| x.y > 0.0).count() as f64 * SPACING * SPACING
}
