//! Two liquids: light over heavy at rest, heavy over light overturning.

use std::f64::consts::PI;

use unipbd_core::Solver;
use unipbd_core::scene::{Block, Liquid, Scene, Tank, Wave};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::runner::{Failure, Runner, points, points_of};
use crate::scenes::{GRAVITY, SPACING};

fn layers(width: f64, upper: (f64, f64), lower: (f64, f64), trial: &Trial) -> Scene {
    let (right, middle, top) = (SPACING * width, SPACING * lower.1, SPACING * (lower.1 + upper.1));
    Scene {
        spacing: SPACING,
        solver: trial.solver.clone(),
        liquid: vec![Liquid::new("lower", lower.0), Liquid::new("upper", upper.0)],
        block: vec![Block::new("lower", [0.0, 0.0], [right, middle]), Block::new("upper", [0.0, middle], [right, top])],
        tank: vec![Tank { open: Vec::new(), ..Tank::new([0.0, 0.0], [right, top]) }],
        ..Scene::default()
    }
}

/// A light layer over one twice as heavy.
pub const TWO_LAYERS: Case = Case {
    name: "two_layers",
    truth: "hydrostatics: dp/dz = rho g in each layer, rest",
    quick: 16,
    full: [16, 32, 64],
    run: two_layers,
};

fn two_layers(trial: &Trial) -> Result<Measured, Failure> {
    let half = f64::from(trial.resolution) / 2.0;
    let mut scene = layers(16.0, (1000.0, half), (2000.0, half), trial);
    scene.tank = vec![Tank::new([0.0, 0.0], [1.6, 4.0 * half * SPACING])];
    let mut run = Runner::new(&scene)?;
    run.frames(180, |_| ())?;
    let (mut upper, mut lower, mut square, mut mean, mut level) = (0.0, 0.0, 0.0, 0.0, 0.0f64);
    run.frames(30, |solver| {
        let diagnostics = solver.diagnostics();
        let mass = 1500.0 * SPACING * SPACING * diagnostics.particles() as f64;
        lower += layer_slope(solver, 0) / 30.0;
        upper += layer_slope(solver, 1) / 30.0;
        square += 2.0 * diagnostics.kinetic_energy / mass / 30.0;
        mean += diagnostics.density_error_mean / 30.0;
        level += 2.0 * points(solver).map(|x| x.y).sum::<f64>() / diagnostics.particles() as f64 / 30.0;
    })?;
    let figures = vec![
        Figure::new("mean C", mean, Band::OPEN),
        Figure::new("pressure slope error of the upper layer", upper / GRAVITY - 1.0, Band::within(0.02)),
        Figure::new("pressure slope error of the lower layer", lower / GRAVITY - 1.0, Band::within(0.02)),
        Figure::new("level error", level / (2.0 * half * SPACING) - 1.0, Band::within(0.012)),
        Figure::new("v_rms [dx/s]", square.sqrt() / SPACING, Band::between(0.0, 0.8)),
    ];
    Ok((figures, run.cost))
}

/// Slope of pressure over density with depth within a layer [m/s^2].
fn layer_slope(solver: &Solver, material: u16) -> f64 {
    let (pressures, materials) = (solver.pressures(), solver.material_indices());
    let own: Vec<(f64, f64)> = points(solver)
        .zip(pressures)
        .zip(materials)
        .filter(|(_, of)| **of == material)
        .map(|((x, p), _)| (x.y, p))
        .collect();
    let low = own.iter().map(|(y, _)| *y).fold(f64::INFINITY, f64::min) + 2.0 * SPACING;
    let high = own.iter().map(|(y, _)| *y).fold(0.0, f64::max) - 2.0 * SPACING;
    let inside = || own.iter().filter(|(y, _)| *y > low && *y < high);
    let count = inside().count() as f64;
    let (my, mp) = (inside().map(|p| p.0).sum::<f64>() / count, inside().map(|p| p.1).sum::<f64>() / count);
    let (top, bottom) = inside().fold((0.0, 0.0), |(a, b), (y, p)| (a + (y - my) * (p - mp), b + (y - my) * (y - my)));
    -top / bottom
}

/// Heavy over light.
pub const RAYLEIGH_TAYLOR: Case = Case {
    name: "rayleigh_taylor",
    truth: "linear growth at the rate sqrt(A g k tanh kH), without viscosity, density ratio 2",
    quick: 48,
    full: [48, 64, 96],
    run: rayleigh_taylor,
};

/// Amplitude of the start [spacings].
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
    let mut run = Runner::new(&scene)?;
    let exact = (GRAVITY * k * (k * width).tanh() / 3.0).sqrt();
    let start = amplitude(&run, k, width);
    let mut compression = Vec::new();
    while run.solver.time() < PHASE / exact {
        run.frame()?;
        compression.push(run.solver.diagnostics().density_error_mean);
    }
    // From rest the amplitude goes as cosh(rate t).
    let growth = (amplitude(&run, k, width) / start).max(1.0).acosh() / run.solver.time();
    let figures = vec![
        Figure::new("growth over the exact rate", growth / exact, Band::between(0.75, 1.05)),
        Figure::new("mean C", compression.iter().sum::<f64>() / compression.len() as f64, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Amplitude of the interface, from the lower liquid alone [m].
fn amplitude(run: &Runner, k: f64, width: f64) -> f64 {
    points_of(&run.solver, 0).map(|x| (k * x.x).cos()).sum::<f64>() * SPACING * SPACING * 2.0 / width
}
