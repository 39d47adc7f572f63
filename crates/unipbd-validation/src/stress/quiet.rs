//! A pool at rest for very many steps: does it drift, heat up or fail to sleep?

use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Substeps, Tank};
use unipbd_core::{BuildOptions, Solver, SolverError};

use crate::runner::{points, velocities};

/// Substeps per frame.
const SUBSTEPS: u32 = 8;
/// Frames in which the pool comes to rest before the count begins: 20 s.
const TO_REST: u64 = 1200;
/// Particles across and up.
const SIZE: [f64; 2] = [20.0, 10.0];
const SPACING: f64 = 0.1;

/// Effect of very many steps on a pool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quiet {
    /// Steps counted.
    pub steps: u64,
    /// Largest way of the centre of mass from where it was at rest \[spacings].
    pub drift: f64,
    /// Largest rise of the energy over that at rest, over the weight times the depth.
    pub energy_rise: f64,
    /// Root mean square of all velocities at the end [spacings/s].
    pub restlessness: f64,
    /// Largest density error at the end.
    pub density_error: f64,
    /// Distance of the centre of mass from that of a pool which was let sleep \[spacings].
    pub slept: f64,
}

impl Quiet {
    /// Whether the pool is where and what it was.
    pub fn is_good(&self) -> bool {
        let rest = self.drift <= 0.1 && self.slept <= 0.1 && self.energy_rise <= 0.005;
        rest && self.restlessness <= 0.8 && self.density_error <= 0.02
    }
}

/// Steps a pool at least `steps` times after it came to rest.
pub fn quiet(steps: u64) -> Result<Quiet, SolverError> {
    let (mut awake, mut sleeper) = (pool(false), pool(true));
    for _ in 0..TO_REST {
        awake.step_frame()?;
        sleeper.step_frame()?;
    }
    let (start, energy) = (center(&awake), energy(&awake));
    let scale = 9.81 * SIZE[1] * SPACING * mass(&awake);
    let (mut drift, mut rise) = (0.0_f64, 0.0_f64);
    let frames = steps.div_ceil(u64::from(SUBSTEPS));
    for _ in 0..frames {
        awake.step_frame()?;
        sleeper.step_frame()?;
        drift = drift.max((center(&awake) - start).length() / SPACING);
        rise = rise.max((self::energy(&awake) - energy) / scale);
    }
    let square = velocities(&awake).map(|velocity| velocity.length_squared()).sum::<f64>();
    Ok(Quiet {
        steps: frames * u64::from(SUBSTEPS),
        drift,
        energy_rise: rise,
        restlessness: (square / awake.positions().len() as f64).sqrt() / SPACING,
        density_error: awake.diagnostics().density_error_max,
        slept: (center(&awake) - center(&sleeper)).length() / SPACING,
    })
}

fn pool(sleep: bool) -> Solver {
    let [width, depth] = SIZE.map(|size| size * SPACING);
    let scene = Scene {
        spacing: SPACING,
        liquid: vec![Liquid { xsph: 0.01, ..Liquid::new("water", 1000.0) }],
        block: vec![Block::new("water", [0.0, 0.0], [width, depth])],
        tank: vec![Tank::new([0.0, 0.0], [width, 2.0 * depth])],
        solver: SolverSettings { sleep, substeps: Substeps::Fixed(SUBSTEPS), ..SolverSettings::default() },
        ..Scene::default()
    };
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn center(solver: &Solver) -> unipbd_core::Vector64 {
    points(solver).sum::<unipbd_core::Vector64>() / solver.positions().len() as f64
}

/// Mass of all particles, which have the same \[kg].
fn mass(solver: &Solver) -> f64 {
    1000.0 * SPACING * SPACING * solver.positions().len() as f64
}

/// Kinetic and potential energy \[J].
fn energy(solver: &Solver) -> f64 {
    let particle = mass(solver) / solver.positions().len() as f64;
    let kinetic = velocities(solver).map(|velocity| 0.5 * velocity.length_squared()).sum::<f64>();
    particle * (kinetic + points(solver).map(|place| 9.81 * place.y).sum::<f64>())
}
