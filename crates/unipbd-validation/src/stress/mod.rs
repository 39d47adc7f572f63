//! Stability: scenes that ask too much. Each must end finite, contained and with bounded speed, or
//! stop with an error that says where.

pub mod chart;
mod fuzz;
pub mod map;
mod named;
mod quiet;
mod shrink;

pub use fuzz::{Counts, accountable_speed, endure_random, fuzz, random_scene, summary};
pub use named::{NAMED, Stress};
pub use quiet::{Quiet, quiet};
pub use shrink::shrink;

use unipbd_core::scene::Scene;
use unipbd_core::{BuildOptions, Solver, SolverError};

use crate::runner::{points, velocities};

/// How a stress ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Finite, contained, bounded.
    Sound {
        /// Fastest particle seen, in spacings per frame.
        speed: f64,
    },
    /// The solver stopped with an error of its own.
    Stopped(String),
    /// The scene was refused.
    Refused,
    /// A failure that must not happen.
    Broken(String),
}

impl Ending {
    /// Whether this may happen.
    pub fn is_good(&self) -> bool {
        !matches!(self, Ending::Broken(_))
    }
}

/// Runs a scene and watches it. `limit` is the speed it can account for [m/s].
pub fn endure(scene: &Scene, frames: u32, limit: f64) -> Ending {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let Ok(mut solver) = scene.build(options) else { return Ending::Refused };
    let mut fastest = 0.0f64;
    for _ in 0..frames {
        match solver.step_frame() {
            Ok(_) => (),
            Err(SolverError::Diverged { .. }) if !is_finite(&solver) => {
                return Ending::Broken("diverged to values that are not finite".to_owned());
            }
            Err(error) => return Ending::Stopped(error.to_string()),
        }
        if let Some(broken) = unsound(&solver, scene) {
            return Ending::Broken(format!("frame {}: {broken}", solver.frame()));
        }
        fastest = fastest.max(velocities(&solver).map(|v| v.length()).fold(0.0, f64::max));
    }
    if fastest > limit {
        return Ending::Broken(format!("reaches {fastest:.1} m/s where {limit:.1} m/s can be accounted for"));
    }
    Ending::Sound { speed: fastest * solver.frame_time() / solver.spacing() }
}

fn is_finite(solver: &Solver) -> bool {
    points(solver).chain(velocities(solver)).all(|vector| vector.is_finite())
        && solver.bodies().iter().all(|body| body.position.is_finite() && body.velocity.is_finite())
}

/// Description of the fault of a state, if any.
fn unsound(solver: &Solver, scene: &Scene) -> Option<String> {
    if !is_finite(solver) {
        return Some("a position or velocity is not finite".to_owned());
    }
    let errors = solver.density_errors();
    if errors.iter().any(|error| !error.is_finite()) {
        return Some("a density error is not finite".to_owned());
    }
    for tank in &scene.tank {
        // Rounding may leave a particle a hair outside.
        let slack = 1e-3 * scene.spacing + 4e-7 * tank.max.iter().chain(&tank.min).fold(0.0, |m, x| x.abs().max(m));
        let open = |side| tank.open.contains(&side);
        use unipbd_core::scene::Side::{Bottom, Left, Right, Top};
        let outside = |x: &unipbd_core::Vector64| {
            (!open(Left) && x.x < tank.min[0] - slack)
                || (!open(Right) && x.x > tank.max[0] + slack)
                || (!open(Bottom) && x.y < tank.min[1] - slack)
                || (!open(Top) && x.y > tank.max[1] + slack)
        };
        let rigid = |row: usize| solver.phases()[row] == unipbd_core::Phase::Rigid;
        if let Some((row, x)) = points(solver).enumerate().find(|(row, x)| !rigid(*row) && outside(x)) {
            return Some(format!("particle {} at {x} is outside the tank", solver.ids()[row]));
        }
    }
    None
}
