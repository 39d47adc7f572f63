//! Vortices between walls that slip: a pair that carries itself along, and decaying ones.

use std::f64::consts::PI;

use unipbd_core::Solver;
use unipbd_core::math::Vector64;
use unipbd_core::scene::{Block, Gas, Liquid, LiquidSurface, Scene, Tank};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::exact::VortexPair;
use crate::runner::{Failure, points, velocities};

/// Two Gaussian vortices `resolution` spacings apart, in a liquid without a surface.
pub const VORTEX_PAIR: Case = Case {
    name: "vortex_pair",
    truth: "point vortices b apart: Gamma/(2 pi b), with their images behind the walls of the box; over 5 b",
    quick: 16,
    full: &[24],
    targets: &[0.01],
    run: |trial| vortex_pair(trial, Filling::Liquid),
};

/// The same in a gas.
pub const VORTEX_PAIR_GAS: Case = Case {
    name: "vortex_pair_gas",
    truth: "point vortices b apart: Gamma/(2 pi b), with their images behind the walls of the box; over 5 b, in a gas",
    run: |trial| vortex_pair(trial, Filling::Gas),
    ..VORTEX_PAIR
};

/// The fluid that fills a box.
#[derive(Clone, Copy, PartialEq)]
enum Filling {
    Liquid,
    Gas,
}

/// Side of the box, and way of the pair, in distances b; from this resolution on, and below.
const FINE: u32 = 24;
const SIDES: [f64; 2] = [12.0, 6.0];
const WAYS: [f64; 2] = [5.0, 2.0];
/// Radius of the cores, over b: the vorticity goes as exp(-(r/core)^2).
const CORE: f64 = 0.15;

/// A closed box of this side \[m], at rest.
fn full_box(trial: &Trial, filling: Filling, side: f64, viscosity: f64) -> Scene {
    let liquid = Liquid { surface: LiquidSurface::None, kinematic_viscosity: viscosity, ..Liquid::new("fluid", 1.0) };
    let gas = Gas { name: "fluid".to_owned(), density: 1.0, kinematic_viscosity: viscosity, ..Gas::default() };
    Scene {
        spacing: 1.0 / f64::from(trial.resolution),
        gravity: [0.0; 2],
        fps: 100.0,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        liquid: if filling == Filling::Liquid { vec![liquid] } else { Vec::new() },
        gas: if filling == Filling::Gas { vec![gas] } else { Vec::new() },
        block: vec![Block { jitter: 0.5, ..Block::new("fluid", [0.0; 2], [side; 2]) }],
        tank: vec![Tank { open: Vec::new(), ..Tank::new([0.0; 2], [side; 2]) }],
        ..Scene::default()
    }
}

fn vortex_pair(trial: &Trial, filling: Filling) -> Result<Measured, Failure> {
    let coarse = usize::from(trial.resolution < FINE);
    let (side, way) = (SIDES[coarse], WAYS[coarse]);
    let pair = VortexPair { side, circulation: 2.0 * PI };
    let low = 0.5 * (side - way);
    let start = [Vector64::new(0.5 * side - 0.5, low), Vector64::new(0.5 * side + 0.5, low)];
    let mut run = trial.start(&full_box(trial, filling, side, 0.0))?;
    run.stir(|x| stirred(pair, start, x))?;
    let cores = start.map(|core| cored(&run.solver, core));
    let before = run.solver.diagnostics().kinetic_energy;
    let mut compression = 0.0;
    let frames = (100.0 * way) as u32;
    run.frames(frames, |solver| compression += solver.diagnostics().density_error_mean / f64::from(frames))?;
    let exact = pair.after(start, run.solver.time());
    let mean = |core: &Vec<u32>| {
        let among = points(&run.solver).zip(run.solver.ids()).filter(|(_, id)| core.binary_search(id).is_ok());
        among.map(|(x, _)| x).sum::<Vector64>() / core.len() as f64
    };
    let [left, right] = [mean(&cores[0]), mean(&cores[1])];
    let error = (0.5 * (left.y + right.y) - low) / (exact[0].y - low) - 1.0;
    let apart = (right.x - left.x) / (exact[1].x - exact[0].x) - 1.0;
    let kept = run.solver.diagnostics().kinetic_energy / before;
    let figures = vec![
        Figure::new("speed error", error, trial.with_grid(Band::within(0.06))),
        Figure::new("error of the distance", apart, Band::OPEN),
        Figure::new("kinetic energy over that of the start", kept, Band::between(0.0, 1.005)),
        Figure::new("mean C", compression, Band::OPEN),
        Figure::new(super::SUBSTEPS_PER_FRAME, run.cost.substeps as f64 / f64::from(frames), Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Velocity of the pair with Gaussian cores [m/s].
fn stirred(pair: VortexPair, vortices: [Vector64; 2], x: Vector64) -> Vector64 {
    let softened = vortices.into_iter().zip([pair.circulation, -pair.circulation]).map(|(vortex, strength)| {
        let away = x - vortex;
        let square = away.length_squared().max(1e-12);
        Vector64::new(-away.y, away.x) * (strength / (2.0 * PI * square) * (-square / (CORE * CORE)).exp())
    });
    pair.velocity(vortices, x) - softened.sum::<Vector64>()
}

/// The particles of a core, by their numbers, in order.
fn cored(solver: &Solver, core: Vector64) -> Vec<u32> {
    let inside = points(solver).zip(solver.ids()).filter(|(x, _)| (*x - core).length() < CORE);
    let mut ids: Vec<u32> = inside.map(|(_, id)| *id).collect();
    ids.sort_unstable();
    ids
}

/// Decaying vortices at Re 1000 in a box, `resolution` spacings along its side.
pub const TAYLOR_GREEN_BOX: Case = Case {
    name: "taylor_green_box",
    truth: "kinetic energy exp(-16 pi^2 t/Re), Re = 1000, to t = 1, between walls that slip",
    quick: 32,
    full: &[50, 100, 200],
    targets: &[0.01],
    run: taylor_green_box,
};

const REYNOLDS: f64 = 1000.0;

fn taylor_green_box(trial: &Trial) -> Result<Measured, Failure> {
    let mut run = trial.start(&full_box(trial, Filling::Liquid, 1.0, 1.0 / REYNOLDS))?;
    run.stir(mode_of_start)?;
    let start = run.solver.diagnostics().kinetic_energy;
    let (mut highest, mut compression) = (0.0f64, 0.0);
    run.frames(100, |solver| {
        let diagnostics = solver.diagnostics();
        highest = highest.max(diagnostics.kinetic_energy / start);
        compression += diagnostics.density_error_mean / 100.0;
    })?;
    let kept = run.solver.diagnostics().kinetic_energy / start;
    let fitted = -kept.ln() / (16.0 * PI * PI * run.solver.time()) * REYNOLDS;
    // The part of the motion that is still the mode of the start.
    let mode = points(&run.solver).zip(velocities(&run.solver)).map(|(x, v)| v.dot(mode_of_start(x)));
    let mode = 2.0 * mode.sum::<f64>() / points(&run.solver).count() as f64;
    let of_mode = -2.0 * mode.ln() / (16.0 * PI * PI * run.solver.time()) * REYNOLDS;
    let figures = vec![
        Figure::new("fitted viscosity over the true one", fitted, fine(trial)),
        Figure::new("the same of the mode alone", of_mode, Band::OPEN),
        Figure::new("largest kinetic energy over that of the start", highest, Band::between(0.0, 1.005)),
        Figure::new("mean C", compression, Band::OPEN),
        Figure::new(super::SUBSTEPS_PER_FRAME, run.cost.substeps as f64 / 100.0, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Velocity of four vortices in a box of side 1 m [m/s].
fn mode_of_start(x: Vector64) -> Vector64 {
    let (x, y) = (2.0 * PI * x.x, 2.0 * PI * x.y);
    Vector64::new(x.sin() * y.cos(), -x.cos() * y.sin())
}

/// The band required from 100 spacings along the side on.
fn fine(trial: &Trial) -> Band {
    if trial.resolution < 100 { Band::OPEN } else { trial.with_grid(Band::between(0.9, 1.25)) }
}
