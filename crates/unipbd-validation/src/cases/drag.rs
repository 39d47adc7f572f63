//! A lone gas particle in the drag of the air.

use unipbd_core::kernel::Kernel;
use unipbd_core::scene::{Block, Gas, Scene};

use crate::case::{Band, Case, Figure, Measured, TARGETS, Trial};
use crate::runner::{Failure, velocities};

/// The drag of thin gas is linear in its velocity.
pub const DRAG: Case = Case {
    name: "drag",
    truth: "linear drag: v = v_t (1 - exp(-t/tau)), 1/tau = k (1 - rho/rho0) of a lone particle",
    quick: 1,
    full: &[1, 1, 1],
    targets: TARGETS,
    run: drag,
};

fn drag(trial: &Trial) -> Result<Measured, Failure> {
    let (spacing, rate) = (0.1, 2.0);
    let gas = Gas { name: "gas".to_owned(), gravity_factor: 1.0, drag: rate, ..Gas::default() };
    let scene = Scene {
        spacing,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        gas: vec![gas],
        block: vec![Block { temperature: 1.0, ..Block::new("gas", [0.0, 0.0], [spacing, spacing]) }],
        ..Scene::default()
    };
    let mut run = trial.start(&scene)?;
    let kernel = Kernel::new(trial.solver.kernel_radius * spacing);
    let own = f64::from(kernel.value(0.0));
    let inverse_time = rate * (1.0 - own / (own + kernel.lattice(spacing).value));
    let terminal = 9.81 / inverse_time;
    let mut worst = 0.0f64;
    run.frames(180, |solver| {
        let speed = velocities(solver).map(|v| -v.y).sum::<f64>();
        let exact = terminal * (1.0 - (-solver.time() * inverse_time).exp());
        worst = worst.max((speed - exact).abs() / terminal);
    })?;
    Ok((
        vec![Figure::new("largest speed error over 3 s, over the terminal speed", worst, Band::between(0.0, 0.01))],
        run.cost,
    ))
}
