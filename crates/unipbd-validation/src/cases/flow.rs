//! Viscous flows with exact solutions: Taylor-Green, Couette, Poiseuille.

use std::f64::consts::PI;

use unipbd_core::math::Vector64;
use unipbd_core::scene::{Block, Domain, HalfPlane, Liquid, LiquidSurface, Scene, Slip, SolverSettings};

use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::exact::{couette, poiseuille};
use crate::runner::{Failure, points, velocities};

/// Decaying vortices on a periodic square.
pub const TAYLOR_GREEN: Case = Case {
    name: "taylor_green",
    truth: "kinetic energy exp(-16 pi^2 t/Re), Re = 100, to t = 1",
    quick: 32,
    full: &[50, 100, 200],
    targets: TARGETS,
    run: |trial| taylor_green(trial, 100.0, Band::between(0.0, 0.06)),
};

/// The same with a wide kernel.
pub const TAYLOR_GREEN_WIDE: Case = Case {
    name: "taylor_green_wide",
    truth: "kinetic energy exp(-16 pi^2 t/Re), Re = 100, to t = 1, at h = 4 dx",
    quick: 32,
    full: &[50, 100, 200],
    targets: TARGETS,
    run: |trial| {
        let wide = SolverSettings { kernel_radius: 4.0, ..trial.solver.clone() };
        taylor_green(&Trial { solver: wide, ..trial.clone() }, 100.0, Band::between(0.0, 0.06))
    },
};

/// The same at Re = 1000, where numerical viscosity shows.
pub const TAYLOR_GREEN_1000: Case = Case {
    name: "taylor_green_1000",
    truth: "kinetic energy exp(-16 pi^2 t/Re), Re = 1000, to t = 1",
    quick: 32,
    full: &[50, 100, 200],
    targets: TARGETS,
    run: |trial| taylor_green(trial, 1000.0, Band::OPEN),
};

/// A liquid without a surface, of density 1 and this viscosity.
fn filling(viscosity: f64) -> Liquid {
    Liquid { kinematic_viscosity: viscosity, surface: LiquidSurface::None, ..Liquid::new("fluid", 1.0) }
}

fn taylor_green(trial: &Trial, reynolds: f64, band: Band) -> Result<Measured, Failure> {
    let scene = Scene {
        spacing: 1.0 / f64::from(trial.resolution),
        gravity: [0.0; 2],
        fps: 100.0,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        domain: Domain { periodic_x: Some([0.0, 1.0]), periodic_y: Some([0.0, 1.0]), ..Domain::default() },
        liquid: vec![filling(1.0 / reynolds)],
        // A lattice resists shear until it is broken up.
        block: vec![Block { jitter: 0.5, ..Block::new("fluid", [0.0, 0.0], [1.0, 1.0]) }],
        ..Scene::default()
    };
    let mut run = trial.start(&scene)?;
    let field = |x: Vector64| {
        let (x, y) = (2.0 * PI * x.x, 2.0 * PI * x.y);
        Vector64::new(-x.cos() * y.sin(), x.sin() * y.cos())
    };
    // At scattered points the field does not sum to zero: what is left would pass for a drift of momentum.
    let mean = points(&run.solver).fold(Vector64::ZERO, |sum, x| sum + field(x)) / points(&run.solver).count() as f64;
    run.stir(|x| field(x) - mean)?;
    let start = run.solver.diagnostics().kinetic_energy;
    let mut curve = Vec::new();
    let mut compression = 0.0;
    run.frames(100, |solver| {
        let diagnostics = solver.diagnostics();
        curve.push((solver.time(), diagnostics.kinetic_energy / start));
        compression += diagnostics.density_error_mean / 100.0;
    })?;
    let exact = |time: f64| (-16.0 * PI * PI * time / reynolds).exp();
    let error = curve.iter().map(|(time, energy)| (energy / exact(*time) - 1.0).abs()).fold(0.0, f64::max);
    let (time, energy) = curve[curve.len() - 1];
    let fitted = -energy.ln() / (16.0 * PI * PI * time);
    let momentum = run.solver.diagnostics().momentum.length();
    let highest = curve.iter().map(|(_, energy)| *energy).fold(0.0, f64::max);
    let figures = vec![
        Figure::new("kinetic energy error to t = 1", error, band),
        Figure::new("fitted viscosity over the true one", fitted * reynolds, Band::OPEN),
        Figure::new("momentum over mass x U", momentum, Band::within(1e-5)),
        Figure::new("largest kinetic energy over that of the start", highest, Band::between(0.0, 1.005)),
        Figure::new("mean C", compression, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Flow between a fixed floor and a lid that starts to move.
pub const COUETTE: Case = Case {
    name: "couette",
    truth: "start-up of plane Couette flow (series; Morris et al. 1997), tau = 0.05, 0.1, 0.2",
    quick: 16,
    full: &[16, 32, 64],
    targets: TARGETS,
    run: |trial| channel(trial, Drive::Lid),
};

/// Flow between fixed walls under a body force.
pub const POISEUILLE: Case = Case {
    name: "poiseuille",
    truth: "start-up of plane Poiseuille flow (series; Morris et al. 1997), tau = 0.05, 0.1, 0.2",
    quick: 16,
    full: &[16, 32, 64],
    targets: TARGETS,
    run: |trial| channel(trial, Drive::Force),
};

#[derive(Clone, Copy, PartialEq)]
enum Drive {
    Lid,
    Force,
}

/// Largest speed of both flows [m/s], and the viscosity of a channel 1 m high at Re = 10 [m^2/s].
const SPEED: f64 = 1.0;
const VISCOSITY: f64 = 0.1;

fn channel(trial: &Trial, drive: Drive) -> Result<Measured, Failure> {
    let mut run = trial.start(&channel_scene(drive, trial))?;
    let profile = |y: f64, tau: f64| match drive {
        Drive::Lid => couette(y, tau),
        Drive::Force => poiseuille(y, tau),
    };
    let mut worst = 0.0f64;
    for frames in [50, 50, 100] {
        run.frames(frames, |_| ())?;
        let tau = VISCOSITY * run.solver.time();
        let (mut square, mut whole) = (0.0, 0.0);
        for (x, v) in points(&run.solver).zip(velocities(&run.solver)) {
            let exact = SPEED * profile(x.y, tau);
            square += (v - Vector64::new(exact, 0.0)).length_squared();
            whole += exact * exact;
        }
        worst = worst.max((square / whole).sqrt());
    }
    let compression = run.solver.diagnostics().density_error_mean;
    let figures = vec![
        Figure::new("largest L2 error of the profile", worst, Band::between(0.0, 0.02)),
        Figure::new("mean C", compression, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

fn channel_scene(drive: Drive, trial: &Trial) -> Scene {
    let spacing = 1.0 / f64::from(trial.resolution);
    let length = 16.0 * spacing;
    let wall = |y: f64, normal: f64, speed: f64| HalfPlane {
        velocity: [speed, 0.0],
        slip: Slip::None,
        ..HalfPlane::new([0.0, y], [0.0, normal])
    };
    let (lid, force) = match drive {
        Drive::Lid => (SPEED, 0.0),
        Drive::Force => (0.0, 8.0 * VISCOSITY * SPEED),
    };
    Scene {
        spacing,
        gravity: [force, 0.0],
        fps: 100.0,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        domain: Domain { periodic_x: Some([0.0, length]), ..Domain::default() },
        liquid: vec![filling(VISCOSITY)],
        block: vec![Block::new("fluid", [0.0, 0.0], [length, 1.0])],
        half_plane: vec![wall(0.0, 1.0, 0.0), wall(1.0, -1.0, lid)],
        ..Scene::default()
    }
}
