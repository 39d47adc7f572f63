//! How many substeps a frame takes, and why.

use crate::scene::{Scene, Substeps};

/// Way per substep, in spacings, that the Courant-Friedrichs-Lewy condition allows.
const COURANT: f64 = 0.4;
/// Error constant D of C_max = (D/omega) P dt^2/dx^2 for Wendland C2 at h = 2.5 dx.
const ERROR_CONSTANT: f64 = 0.335;
/// Relaxation of liquids, omega.
const RELAXATION: f64 = 0.5;

/// Height of a stack of bodies that one substep per frame can carry.
const BODIES_PER_SUBSTEP: f64 = 2.5;

/// What the choice follows from: a function of the state at the start of a frame alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Fastest particle or emitter [m/s].
    pub speed: f64,
    /// Largest pressure over density, from the multipliers or the depth of the liquid [m^2/s^2].
    pub pressure: f64,
    /// Bodies that may have to carry each other.
    pub chain: f64,
}

/// Chooses the number of substeps per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubstepRule {
    substeps: Substeps,
    cap: u32,
    target: f64,
    spacing: f64,
}

/// The choice for one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Substeps to take.
    pub substeps: u32,
    /// Substeps that were wanted, where that is more.
    pub wanted: u32,
}

impl SubstepRule {
    /// The rule of a scene.
    pub fn new(scene: &Scene) -> Self {
        SubstepRule {
            substeps: scene.solver.substeps,
            cap: scene.solver.max_substeps.max(1),
            target: scene.solver.target_compression,
            spacing: scene.spacing,
        }
    }

    /// Substeps for a frame of this length [s].
    pub fn choose(&self, frame: f64, demand: Demand) -> Choice {
        match self.substeps {
            Substeps::Fixed(count) => Choice { substeps: count.max(1), wanted: count.max(1) },
            Substeps::Auto => {
                let wanted = self.wanted(frame, demand).max(1.0).min(f64::from(u32::MAX)) as u32;
                Choice { substeps: wanted.min(self.cap), wanted }
            }
        }
    }

    /// The largest of four demands: the height of stacks, speed (CFL), trust region (the compression within one substep
    /// stays below 0.2), and the target compression.
    fn wanted(&self, frame: f64, demand: Demand) -> f64 {
        let courant = frame * demand.speed / (COURANT * self.spacing);
        let trust = 2.0 * frame * demand.pressure.sqrt() / self.spacing;
        let accuracy = frame / self.spacing * (ERROR_CONSTANT / RELAXATION * demand.pressure / self.target).sqrt();
        let support = demand.chain / BODIES_PER_SUBSTEP;
        courant.max(trust).max(accuracy).max(support).ceil()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule() -> SubstepRule {
        SubstepRule::new(&Scene { spacing: 0.1, ..Scene::default() })
    }

    #[test]
    fn substeps_grow_with_the_square_root_of_the_depth() {
        let at =
            |depth: f64| rule().choose(1.0 / 60.0, Demand { pressure: 9.81 * depth, ..Demand::default() }).substeps;
        assert_eq!(at(3.0), 8);
        assert!((f64::from(at(120.0)) / f64::from(at(30.0)) - 2.0).abs() < 0.1);
    }

    #[test]
    fn speed_is_bound_to_two_fifths_of_a_spacing() {
        let choice = rule().choose(1.0 / 60.0, Demand { speed: 12.0, ..Demand::default() });
        assert_eq!(choice.substeps, 5);
    }

    #[test]
    fn the_cap_binds_and_says_what_was_wanted() {
        let choice = rule().choose(1.0, Demand { speed: 1e4, ..Demand::default() });
        assert_eq!(choice, Choice { substeps: 256, wanted: 250_000 });
    }
}
