//! A disc of water that its own motion stretches.

use std::f64::consts::PI;

use unipbd_core::Solver;
use unipbd_core::math::Vector64;
use unipbd_core::scene::{Disc, Liquid, Scene};

use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::exact::{elliptical_drop, oscillation_period};
use crate::runner::{Failure, Runner, energy, points, velocities};

/// The free elliptical drop.
pub const ELLIPTICAL_DROP: Case = Case {
    name: "elliptical_drop",
    truth: "Monaghan 1994: half-axes of a disc with u = (A0 x, -A0 y) at t A0 = 0.08, 0.38, 0.76",
    quick: 16,
    full: &[25, 50, 100],
    targets: TARGETS,
    run: elliptical,
};

/// A disc of water that a central force holds together while it swings.
pub const OSCILLATING_DROP: Case = Case {
    name: "oscillating_drop",
    truth: "Monaghan & Rafiee 2013: period of a drop with u = (A0 x, -A0 y) under the acceleration -A0^2 x; 14 periods",
    quick: 12,
    full: &[25, 50],
    targets: TARGETS,
    run: oscillating,
};

/// A disc of water of radius 1 m without gravity.
fn disc(trial: &Trial) -> Scene {
    let spacing = 1.0 / f64::from(trial.resolution);
    Scene {
        spacing,
        gravity: [0.0; 2],
        fps: 100.0,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        liquid: vec![Liquid::new("water", 1000.0)],
        disc: vec![Disc {
            material: "water".to_owned(),
            center: [0.0; 2],
            radius: 1.0,
            velocity: [0.0; 2],
            jitter: 0.0,
            temperature: 0.0,
        }],
        ..Scene::default()
    }
}

fn elliptical(trial: &Trial) -> Result<Measured, Failure> {
    let mut run = trial.start(&disc(trial))?;
    run.stir(|x| Vector64::new(x.x, -x.y))?;
    let (start, before) = (axes(&run), energy(&run.solver));
    let (mut long, mut short) = (0.0f64, 0.0f64);
    let mut compression = 0.0;
    for frames in [8, 30, 38] {
        run.frames(frames, |solver| compression += solver.diagnostics().density_error_mean / 76.0)?;
        let (now, exact) = (axes(&run), elliptical_drop(run.solver.time()));
        long = long.max((now.x / start.x / exact - 1.0).abs());
        short = short.max((now.y / start.y * exact - 1.0).abs());
    }
    let momentum = run.solver.diagnostics().momentum.length() / (1000.0 * PI);
    let figures = vec![
        Figure::new("long half-axis error", long, Band::between(0.0, 0.01)),
        Figure::new("short half-axis error", short, trial.from_target(0.01, Band::between(0.0, 0.08))),
        Figure::new("energy change", energy(&run.solver) / before - 1.0, Band::between(-1.0, 0.005)),
        Figure::new("momentum over mass x A0 R", momentum, Band::within(1e-5)),
        Figure::new("mean C", compression, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Periods of the oscillating drop in which its losses are measured.
const PERIODS: f64 = 14.0;

fn oscillating(trial: &Trial) -> Result<Measured, Failure> {
    let mut run = trial.start(&disc(trial))?;
    run.stir(|x| Vector64::new(x.x, -x.y))?;
    let exact = oscillation_period();
    let least = field_energy(&run.solver);
    let before = run.solver.diagnostics().kinetic_energy;
    let (mut strain, mut energies, mut compression) = (vec![(0.0, 1.0)], vec![1.0], 0.0);
    let frames = (100.0 * PERIODS * exact).round() as u32;
    run.frames_under(
        frames,
        |x| -x,
        |solver| {
            let diagnostics = solver.diagnostics();
            strain.push((solver.time(), strain_rate(solver)));
            energies.push((diagnostics.kinetic_energy + field_energy(solver) - least) / before);
            compression += diagnostics.density_error_mean / f64::from(frames);
        },
    )?;
    let falls: Vec<f64> = strain
        .windows(2)
        .filter(|pair| pair[0].1 >= 0.0 && pair[1].1 < 0.0)
        .map(|pair| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1))
        .collect();
    let period =
        (falls.last().unwrap_or(&f64::NAN) - falls.first().unwrap_or(&f64::NAN)) / falls.len().saturating_sub(1) as f64;
    // The energy sways within a period: means over the first and the last one.
    let one = ((100.0 * exact) as usize).min(energies.len());
    let mean = |energies: &[f64]| energies.iter().sum::<f64>() / energies.len() as f64;
    let loss = 1.0 - mean(&energies[energies.len() - one..]) / mean(&energies[..one]);
    let highest = energies.iter().copied().fold(0.0, f64::max);
    let figures = vec![
        Figure::new("energy lost in 14 periods", loss, Band::OPEN),
        Figure::new("period error", period / exact - 1.0, Band::within(0.03)),
        Figure::new("largest energy over that of the start", highest, Band::between(0.0, 1.02)),
        Figure::new("substeps per frame", run.cost.substeps as f64 / f64::from(frames), Band::OPEN),
        Figure::new("mean C", compression, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Energy in the central field of strength 1 s^-2 \[J].
fn field_energy(solver: &Solver) -> f64 {
    let mass = 1000.0 * PI / solver.positions().len() as f64;
    0.5 * mass * points(solver).map(Vector64::length_squared).sum::<f64>()
}

/// The rate A of the velocity (A x, -A y) that fits best [1/s].
fn strain_rate(solver: &Solver) -> f64 {
    let moment = points(solver).zip(velocities(solver)).map(|(x, v)| x.x * v.x - x.y * v.y).sum::<f64>();
    moment / points(solver).map(Vector64::length_squared).sum::<f64>()
}

/// Half-axes from the second moments: of an ellipse of uniform density they are 2 sqrt(<x^2>) \[m].
fn axes(run: &Runner) -> Vector64 {
    let count = run.solver.positions().len() as f64;
    let squares = points(&run.solver).fold(Vector64::ZERO, |sum, x| sum + x * x) / count;
    Vector64::new(2.0 * squares.x.sqrt(), 2.0 * squares.y.sqrt())
}
