//! A disc of water that its own motion stretches.

use unipbd_core::math::Vector64;
use unipbd_core::scene::{Disc, Liquid, Scene};

use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::exact::elliptical_drop;
use crate::runner::{Failure, Runner, energy, points};

/// The free elliptical drop.
pub const ELLIPTICAL_DROP: Case = Case {
    name: "elliptical_drop",
    truth: "Monaghan 1994: half-axes of a disc with u = (A0 x, -A0 y) at t A0 = 0.08, 0.38, 0.76",
    quick: 16,
    full: &[25, 50, 100],
    targets: TARGETS,
    run: elliptical,
};

fn elliptical(trial: &Trial) -> Result<Measured, Failure> {
    let spacing = 1.0 / f64::from(trial.resolution);
    let scene = Scene {
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
    };
    let mut run = trial.start(&scene)?;
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
    let momentum = run.solver.diagnostics().momentum.length() / (1000.0 * std::f64::consts::PI);
    let figures = vec![
        Figure::new("long half-axis error", long, Band::between(0.0, 0.01)),
        Figure::new("short half-axis error", short, trial.from_target(0.01, Band::between(0.0, 0.08))),
        Figure::new("energy change", energy(&run.solver) / before - 1.0, Band::between(-1.0, 0.005)),
        Figure::new("momentum over mass x A0 R", momentum, Band::within(1e-5)),
        Figure::new("mean C", compression, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// Half-axes from the second moments: of an ellipse of uniform density they are 2 sqrt(<x^2>) [m].
fn axes(run: &Runner) -> Vector64 {
    let count = run.solver.positions().len() as f64;
    let squares = points(&run.solver).fold(Vector64::ZERO, |sum, x| sum + x * x) / count;
    Vector64::new(2.0 * squares.x.sqrt(), 2.0 * squares.y.sqrt())
}
