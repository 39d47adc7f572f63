//! Loads on water that cannot get away, and water that falls as a whole: they stop.

use unipbd_core::Solver;
use unipbd_core::scene::{Block, BodyDescription, RotationRule, Scene};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::runner::{Failure, energy, points, velocities};
use crate::scenes::{GRAVITY, SPACING, body, pool};

/// A piston of 20 times the mass of the water under it, `resolution` spacings deep, falls three quarters of the depth.
pub const PISTON: Case = Case {
    name: "piston",
    truth: "a load that falls on water it cannot push away: no energy gained, no rebound",
    quick: 8,
    full: &[8, 16, 24],
    targets: &[0.01],
    run: |trial| fall(trial, &Load { what: "piston", height: 0.5, gap: 0.75, density: 40_000.0, gain: 0.0 }),
};

/// A block of steel that seals a shaft lies on the water.
pub const PRESS: Case = Case {
    name: "press",
    truth: "a load at rest on water that it seals in: no energy gained, rest",
    run: |trial| fall(trial, &Load { what: "press", height: 2.0, gap: 0.0, density: 7800.0, gain: 0.001 }),
    ..PISTON
};

/// Water as wide as its tank falls five quarters of its depth.
pub const SLAB: Case =
    Case { name: "slab", truth: "an inelastic impact: no energy gained, no rebound", run: slab, ..PISTON };

/// A load as wide as the shaft: twice the depth of the water.
struct Load {
    what: &'static str,
    /// Its height and the gap below it, over the depth.
    height: f64,
    gap: f64,
    /// Density [kg/m^2].
    density: f64,
    /// Most energy gained, over that of the way: one at rest may settle a thousandth higher.
    gain: f64,
}

/// Drops a load on water; the rebound is judged over the way it falls, or the depth where it does not.
fn fall(trial: &Trial, load: &Load) -> Result<Measured, Failure> {
    let cells = f64::from(trial.resolution);
    let depth = cells * SPACING;
    let mut one = body(load.what, [depth, (1.0 + load.gap + 0.5 * load.height) * depth]);
    (one.size, one.density, one.friction) = (Some([2.0 * depth, load.height * depth]), load.density, 0.0);
    let body = vec![BodyDescription { rotation: RotationRule::Locked, ..one }];
    let scene = Scene { body, ..shaft(trial, 0.0) };
    let way = if load.gap > 0.0 { load.gap } else { 1.0 } * depth;
    let scale = load.density * 2.0 * depth * load.height * depth * GRAVITY * way;
    watch(trial, &scene, (way, scale, [load.gain, 0.02]), |solver| solver.bodies()[0].position.y)
}

fn slab(trial: &Trial) -> Result<Measured, Failure> {
    let depth = f64::from(trial.resolution) * SPACING;
    let way = 1.25 * depth;
    let scale = 1000.0 * 2.0 * depth * depth * GRAVITY * way;
    watch(trial, &shaft(trial, way), (way, scale, [0.0, 0.1]), |solver| {
        points(solver).map(|x| x.y).sum::<f64>() / solver.positions().len() as f64
    })
}

/// Water this far above the floor of a shaft twice as wide as the water is deep.
fn shaft(trial: &Trial, above: f64) -> Scene {
    let cells = f64::from(trial.resolution);
    let (width, top) = (2.0 * cells * SPACING, above + cells * SPACING);
    let mut scene = Scene {
        block: vec![Block::new("water", [0.0, above], [width, top])],
        ..pool((2.0 * cells, cells), 2.0 * cells, trial)
    };
    scene.tank[0].max[1] = 15.0 * cells * SPACING;
    scene
}

/// Two seconds of a fall in a shaft 0.8 m wide, longer in a wider one. `way` is that of the fall, `scale` its energy.
fn watch(
    trial: &Trial,
    scene: &Scene,
    (way, scale, [most_gain, most_rebound]): (f64, f64, [f64; 2]),
    height: impl Fn(&Solver) -> f64,
) -> Result<Measured, Failure> {
    let mut run = trial.start(scene)?;
    let start = energy(&run.solver);
    let frames = (120.0 * (f64::from(trial.resolution) * SPACING / 0.4).sqrt()) as u32;
    let (mut gain, mut lowest, mut rebound, mut fastest) = (f64::MIN, f64::INFINITY, 0.0f64, 0.0f64);
    run.frames(frames, |solver| {
        gain = gain.max((energy(solver) - start) / scale);
        let now = height(solver);
        lowest = lowest.min(now);
        rebound = rebound.max(now - lowest);
        fastest = velocities(solver).map(|v| v.length()).fold(fastest, f64::max);
    })?;
    let fall = (2.0 * GRAVITY * way).sqrt();
    let figures = vec![
        Figure::new(
            "energy gained over that of the fall",
            gain,
            trial.with_grid(Band::between(f64::NEG_INFINITY, most_gain)),
        ),
        Figure::new("rebound over the fall", rebound / way, trial.with_grid(Band::between(0.0, most_rebound))),
        Figure::new("greatest speed over that of the fall", fastest / fall, Band::OPEN),
        Figure::new("lowest height over the depth", lowest / (f64::from(trial.resolution) * SPACING), Band::OPEN),
        Figure::new(super::SUBSTEPS_PER_FRAME, run.cost.substeps as f64 / f64::from(frames), Band::OPEN),
    ];
    Ok((figures, run.cost))
}
