//! How the work grows with the number of particles, at an error that stays the same.

use unipbd_core::scene::{Block, Gas, Liquid, Scene};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::runner::{Cost, Failure};
use crate::scenes::{SPACING, body, closed_tank};

/// Squares of `resolution` spacings, and of two and four times as many, of what rests.
pub const WORK: Case = Case {
    name: "work",
    truth: "the work of what rests grows as the number of particles N, without more substeps",
    quick: 16,
    full: &[32],
    targets: &[0.01],
    run: work,
};

fn work(trial: &Trial) -> Result<Measured, Failure> {
    let (mut figures, mut cost) = (Vec::new(), Cost::default());
    let kinds: [(fn(&Trial) -> Scene, [&'static str; 3]); 3] = [
        (layers, ["two layers: power of N", "two layers: power of the substeps", "two layers: change of mean C"]),
        (floats, ["floats: power of N", "floats: power of the substeps", "floats: change of mean C"]),
        (closed_gas, ["closed gas: power of N", "closed gas: power of the substeps", "closed gas: change of mean C"]),
    ];
    for (scene, names) in kinds {
        let points = [1, 2, 4].map(|times| point(trial, times, scene));
        let mut found = Vec::new();
        for point in points {
            let (point, spent) = point?;
            found.push(point);
            cost = cost.and(spent);
        }
        let (first, last) = (&found[0], &found[found.len() - 1]);
        let power = |of: fn(&Point) -> f64| (of(last) / of(first)).ln() / (last.particles / first.particles).ln();
        figures.push(Figure::new(names[0], power(|point| point.time), Band::OPEN));
        figures.push(Figure::new(names[1], power(|point| point.substeps), Band::OPEN));
        figures.push(Figure::new(names[2], last.compression / first.compression, Band::OPEN));
    }
    Ok((figures, cost))
}

/// Cost of a size: per frame.
struct Point {
    particles: f64,
    time: f64,
    substeps: f64,
    compression: f64,
}

fn point(trial: &Trial, times: u32, scene: fn(&Trial) -> Scene) -> Result<(Point, Cost), Failure> {
    let trial = Trial { resolution: trial.resolution * times, ..trial.clone() };
    let mut run = trial.start(&scene(&trial))?;
    let mut compression = 0.0;
    // A scene at rest takes on its pressure first.
    run.frames(30, |_| ())?;
    let before = run.cost;
    run.frames(60, |solver| compression += solver.diagnostics().density_error_mean_abs / 60.0)?;
    let point = Point {
        particles: run.cost.particles as f64,
        time: (run.cost.processor - before.processor).as_secs_f64(),
        substeps: (run.cost.substeps - before.substeps) as f64,
        compression,
    };
    Ok((point, run.cost))
}

/// A square tank of this many spacings, closed, without fluids.
fn tank(trial: &Trial) -> Scene {
    let side = f64::from(trial.resolution) * SPACING;
    closed_tank(trial, [0.0; 2], [side; 2])
}

/// A light liquid on one twice as heavy.
fn layers(trial: &Trial) -> Scene {
    let side = f64::from(trial.resolution) * SPACING;
    Scene {
        liquid: vec![Liquid::new("lower", 2000.0), Liquid::new("upper", 1000.0)],
        block: vec![
            Block::new("lower", [0.0; 2], [side, 0.5 * side]),
            Block::new("upper", [0.0, 0.5 * side], [side, side]),
        ],
        ..tank(trial)
    }
}

/// Boxes of a quarter of the width on water that fills half of the tank.
fn floats(trial: &Trial) -> Scene {
    let side = f64::from(trial.resolution) * SPACING;
    let float = |ratio: f64, place: f64| {
        let height = 0.125 * side;
        let mut float = body(&format!("float {place}"), [place * side, 0.5 * side + height * (0.5 - ratio)]);
        (float.size, float.density) = (Some([0.25 * side, height]), 1000.0 * ratio);
        float
    };
    Scene {
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0; 2], [side, 0.5 * side])],
        body: vec![float(0.3, 0.25), float(0.6, 0.75)],
        ..tank(trial)
    }
}

/// Hot gas over cold gas in a closed box.
fn closed_gas(trial: &Trial) -> Scene {
    let side = f64::from(trial.resolution) * SPACING;
    Scene {
        gas: vec![Gas { name: "gas".to_owned(), ..Gas::default() }],
        block: vec![
            Block::new("gas", [0.0; 2], [side, 0.5 * side]),
            Block { temperature: 1.0, ..Block::new("gas", [0.0, 0.5 * side], [side, side]) },
        ],
        ..tank(trial)
    }
}
