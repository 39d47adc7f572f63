//! Two liquids: light over heavy at rest, heavy over light overturning.

use std::f64::consts::PI;

use unipbd_core::Solver;
use unipbd_core::scene::{Block, Liquid, Scene, Tank, Wave};

use super::pool::floor_force;
use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::runner::{Failure, points, points_of};
use crate::scenes::{GRAVITY, SPACING};

fn layers(width: f64, upper: (f64, f64), lower: (f64, f64), trial: &Trial) -> Scene {
    let (right, middle, top) = (SPACING * width, SPACING * lower.1, SPACING * (lower.1 + upper.1));
    Scene {
        spacing: SPACING,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        liquid: vec![Liquid::new("lower", lower.0), Liquid::new("upper", upper.0)],
        block: vec![Block::new("lower", [0.0, 0.0], [right, middle]), Block::new("upper", [0.0, middle], [right, top])],
        tank: vec![Tank { open: Vec::new(), ..Tank::new([0.0, 0.0], [right, top]) }],
        ..Scene::default()
    }
}

/// A light layer over one twice as heavy.
pub const TWO_LAYERS: Case = Case {
    name: "two_layers",
    truth: "hydrostatics: p = p(interface) + rho g depth in each layer, rest",
    quick: 16,
    full: &[16, 32, 64],
    targets: TARGETS,
    run: two_layers,
};

fn two_layers(trial: &Trial) -> Result<Measured, Failure> {
    let half = f64::from(trial.resolution) / 2.0;
    let mut scene = layers(16.0, (1000.0, half), (2000.0, half), trial);
    scene.tank = vec![Tank { name: "tank".to_owned(), ..Tank::new([0.0, 0.0], [1.6, 4.0 * half * SPACING]) }];
    let mut run = trial.start(&scene)?;
    let frames = (60.0 * 20.0 * (2.0 * half * SPACING / GRAVITY).sqrt()).ceil() as u32;
    run.frames(frames, |_| ())?;
    let (mut upper, mut lower, mut square, mut mean, mut level) = (0.0, 0.0, 0.0, 0.0, 0.0f64);
    let mut force = 0.0;
    let mass = 1500.0 * SPACING * SPACING * run.solver.positions().len() as f64;
    run.frames(30, |solver| {
        let diagnostics = solver.diagnostics();
        lower += layer_pressure(solver, 0) / 30.0;
        upper += layer_pressure(solver, 1) / 30.0;
        square += 2.0 * diagnostics.kinetic_energy / mass / 30.0;
        mean += diagnostics.density_error_mean / 30.0;
        level += 2.0 * points(solver).map(|x| x.y).sum::<f64>() / diagnostics.particles() as f64 / 30.0;
        force += floor_force(solver) / 30.0;
    })?;
    let (slight, of_level) = (Band::within(0.02), Band::within(0.012));
    let (slight, of_level) = (trial.from_target(0.01, slight), trial.from_target(0.01, of_level));
    let figures = vec![
        Figure::new("mean C", mean, Band::OPEN),
        Figure::new("pressure error of the upper layer", upper - 1.0, slight),
        Figure::new("pressure error of the lower layer", lower - 1.0, slight),
        Figure::new("error of the force on the floor", force / (mass * GRAVITY) - 1.0, slight),
        Figure::new("level error", level / (2.0 * half * SPACING) - 1.0, of_level),
        Figure::new("v_rms [dx/s]", square.sqrt() / SPACING, Band::between(0.0, 0.8)),
    ];
    Ok((figures, run.cost))
}

/// Pressure in a layer over that of hydrostatics, by least squares; level and interface are those that
/// the mean heights of both layers tell.
fn layer_pressure(solver: &Solver, material: u16) -> f64 {
    let mean_height = |of: u16| {
        let (sum, count) = points_of(solver, of).fold((0.0, 0.0), |(sum, count), x| (sum + x.y, count + 1.0));
        sum / count
    };
    // The lower layer reaches from the floor to twice its mean height.
    let interface = 2.0 * mean_height(0);
    let level = 2.0 * mean_height(1) - interface;
    let hydrostatic = |y: f64| match material {
        1 => GRAVITY * (level - y),
        _ => GRAVITY * (0.5 * (level - interface) + interface - y),
    };
    let (pressures, materials) = (solver.pressures(), solver.material_indices());
    let own = points(solver).zip(pressures).zip(materials).filter(|(_, of)| **of == material);
    let (top, bottom) = own.fold((0.0, 0.0), |(top, bottom), ((x, p), _)| {
        let expected = hydrostatic(x.y);
        (top + expected * f64::from(*p), bottom + expected * expected)
    });
    top / bottom
}

/// Heavy over light.
pub const RAYLEIGH_TAYLOR: Case = Case {
    name: "rayleigh_taylor",
    truth: "linear growth at the rate sqrt(A g k tanh kH), without viscosity, density ratio 2",
    quick: 48,
    full: &[48, 64, 96],
    targets: TARGETS,
    run: rayleigh_taylor,
};

/// Amplitude of the start \[spacings].
const START: f64 = 2.0;
/// Growth is measured over this many times of growth, while the wave is shallow.
const PHASE: f64 = 1.5;

fn rayleigh_taylor(trial: &Trial) -> Result<Measured, Failure> {
    let cells = f64::from(trial.resolution);
    let width = cells * SPACING;
    let k = 2.0 * PI / width;
    let wave = Wave {
        level: width,
        amplitude: START * SPACING,
        wavelength: width,
        phase_deg: Some(0.0),
        bottom: Some(0.0),
        top: Some(2.0 * width),
    };
    let scene = Scene { wave: vec![wave], ..layers(cells, (2000.0, cells), (1000.0, cells), trial) };
    let mut run = trial.start(&scene)?;
    let exact = (GRAVITY * k * (k * width).tanh() / 3.0).sqrt();
    let start = amplitude(&run.solver, k, width);
    let mut compression = Vec::new();
    let frames = (60.0 * PHASE / exact).ceil() as u32;
    run.frames(frames, |solver| compression.push(solver.diagnostics().density_error_mean))?;
    // From rest the amplitude goes as cosh(rate t).
    let growth = (amplitude(&run.solver, k, width) / start).max(1.0).acosh() / run.solver.time();
    let figures = vec![
        Figure::new("growth over the exact rate", growth / exact, Band::between(0.75, 1.05)),
        Figure::new("mean C", compression.iter().sum::<f64>() / compression.len() as f64, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Amplitude of the interface, from the lower liquid alone \[m].
fn amplitude(solver: &Solver, k: f64, width: f64) -> f64 {
    points_of(solver, 0).map(|x| (k * x.x).cos()).sum::<f64>() * SPACING * SPACING * 2.0 / width
}
