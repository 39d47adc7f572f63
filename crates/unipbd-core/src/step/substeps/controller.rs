//! The number of substeps of a frame, and the reason for it.

use crate::observe::SubstepReason;
use crate::scene::{Drive, Scene, SubstepLaw, Substeps};

/// The number of substeps is kept while at least this fraction of it is demanded, and falls no faster: each
/// change of it changes the compression that carries a liquid, and excites oscillations.
const KEPT: f64 = 0.75;
/// Growth per frame of a reduced stiffness.
const STIFFENING: f64 = 1.02;
/// The layer that shear reaches in a substep, over the size of a body without slip along which it grows. Pressure and
/// shear follow one another, and in the layer the pressure of the grid does not see what shear did: a disc in a channel
/// sinks 11 % too fast with 0.1, 6 % with 0.065. The substeps themselves slow it.
const LAYER: f64 = 0.058;
/// Most substeps by shear: in a thicker fluid all moves slowly, and more would cost more than they are worth.
const MOST_BY_SHEAR: f64 = 32.0;
/// Most energy that this growth may release in a frame, over that of the liquids: water squeezed by a heavy body would
/// else throw it higher than it fell.
const RELEASED: f64 = 1e-3;

/// Input of the controller: a function of the state at the start of a frame alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// Fastest particle or emitter [m/s].
    pub speed: f64,
    /// Largest pressure over density, from the multipliers or the depth of the liquid [m^2/s^2].
    pub pressure: f64,
    /// Acceleration of the fluids by gravity and hooks [m/s^2].
    pub acceleration: f64,
    /// Substeps that rigid bodies need by their speed and spin.
    pub body_motion: f64,
    /// Substeps that rigid bodies need by the height of stacks and their mass ratios.
    pub support: f64,
    /// Whether bodies may press on the fluids.
    pub loaded: bool,
    /// Energy of the fluids over that which their compression stores.
    pub over_stored: f64,
}

impl Default for Demand {
    fn default() -> Self {
        Demand {
            speed: 0.0,
            pressure: 0.0,
            acceleration: 0.0,
            body_motion: 0.0,
            support: 0.0,
            loaded: false,
            over_stored: f64::INFINITY,
        }
    }
}

impl Demand {
    fn drive(&self) -> Drive {
        Drive { speed: self.speed, pressure: self.pressure, acceleration: self.acceleration }
    }
}

/// Chooses the number of substeps per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubstepRule {
    substeps: Substeps,
    cap: u32,
    law: SubstepLaw,
    /// Largest kinematic viscosity [m^2/s].
    viscosity: f64,
}

/// The choice for one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Substeps to take.
    pub substeps: u32,
    /// Substeps demanded, if that is more.
    pub wanted: u32,
    /// The criterion with the largest demand.
    pub reason: SubstepReason,
}

impl SubstepRule {
    /// The rule of a scene.
    pub fn new(scene: &Scene) -> Self {
        SubstepRule {
            substeps: scene.solver.substeps,
            cap: scene.solver.max_substeps.max(1),
            law: SubstepLaw::new(scene),
            viscosity: scene.materials().map(|material| material.kinematic_viscosity()).fold(0.0, f64::max),
        }
    }

    /// Substeps of a frame of this length \[s] by the shear along a body of this size \[m], where a grid carries the
    /// pressure: see `LAYER`.
    pub fn by_shear(&self, frame: f64, size: f64) -> f64 {
        (self.viscosity * frame / (LAYER * LAYER * size * size)).min(MOST_BY_SHEAR)
    }

    /// Whether the number is that of the scene, whatever happens.
    pub fn is_fixed(&self) -> bool {
        matches!(self.substeps, Substeps::Fixed(_))
    }

    /// Substeps for a frame of this length \[s], the first of a run.
    pub fn choose(&self, frame: f64, demand: Demand) -> Choice {
        self.choose_after(0, frame, demand)
    }

    /// Substeps for a frame of this length \[s] that follows one of `last` substeps.
    pub fn choose_after(&self, last: u32, frame: f64, demand: Demand) -> Choice {
        if let Substeps::Fixed(count) = self.substeps {
            let count = count.max(1);
            return Choice { substeps: count, wanted: count, reason: SubstepReason::Fixed };
        }
        let (wanted, reason) = self.wanted(frame, demand);
        let wanted = wanted.ceil().max(1.0).min(f64::from(u32::MAX)) as u32;
        let kept = f64::from(last) * KEPT;
        if f64::from(wanted) >= f64::from(last) || last > self.cap {
            Choice { substeps: wanted.min(self.cap), wanted, reason }
        } else {
            let substeps = if f64::from(wanted) >= kept { last } else { kept.floor().max(f64::from(wanted)) as u32 };
            let reason = if substeps > wanted { SubstepReason::Hysteresis } else { reason };
            Choice { substeps, wanted: substeps, reason }
        }
    }

    /// The fraction of its full stiffness that a liquid with a surface, or gas that bodies press on, has in a frame of
    /// `substeps` substeps. The frame before had `last` substeps and the fraction `before`.
    ///
    /// Stiffness is proportional to 1/dt^2. If it jumped with the number of substeps, a compressed liquid would release
    /// more than its stored energy, up to 4 % of the energy of a drop that is drawn out; so it keeps its value and
    /// grows frame by frame. The target compression is still met, unless most of the energy is stored: then it grows by
    /// what adds little energy, and a compression above the target is warned of.
    pub fn stiffness_after(&self, last: u32, before: f64, frame: f64, demand: Demand, substeps: u32) -> f64 {
        if self.is_fixed() || last == 0 || !self.law.stores_energy(demand.loaded) {
            return 1.0;
        }
        let square = |part: f64| part * part;
        let [_, _, compression, _] = self.law.wanted(frame, demand.drive());
        let least = square(compression / f64::from(substeps));
        let kept = before * square(f64::from(last) / f64::from(substeps));
        let most = kept * (1.0 + RELEASED * demand.over_stored);
        (kept * STIFFENING).max(least).min(most).min(1.0)
    }

    /// Way of sound in the compressed particles per substep \[spacings].
    pub fn sound(&self) -> f64 {
        self.law.sound()
    }

    /// Whether particles alone hold gas in a closed tank.
    pub fn confines_gas(&self) -> bool {
        self.law.confines_gas
    }

    /// Speed that a fluid at rest may gain in its first frame: see the law.
    pub fn first_speed(&self, frame: f64, acceleration: f64, depth: f64) -> f64 {
        self.law.first_speed(frame, acceleration, depth)
    }

    /// Largest pressure over density that surface tension may bring about [m^2/s^2].
    pub fn tension_pressure(&self) -> f64 {
        self.law.tension_pressure()
    }

    /// The largest of the demands: speed, trust region, target compression, surface tension, motion and support of bodies.
    fn wanted(&self, frame: f64, demand: Demand) -> (f64, SubstepReason) {
        let [speed, trust, compression, tension] = self.law.wanted(frame, demand.drive());
        let fast = demand.speed * demand.speed > demand.pressure;
        let demands = [
            (speed, SubstepReason::Speed),
            (trust, if fast { SubstepReason::Speed } else { SubstepReason::TrustRegion }),
            (compression, SubstepReason::Compression),
            (tension, SubstepReason::Capillary),
            (demand.body_motion, SubstepReason::Bodies),
            (demand.support, SubstepReason::Support),
        ];
        demands.into_iter().fold((0.0, SubstepReason::Compression), |a, b| if b.0 > a.0 { b } else { a })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule() -> SubstepRule {
        SubstepRule::new(&Scene { spacing: 0.1, ..Scene::default() })
    }

    fn driven(speed: f64, pressure: f64) -> Demand {
        Demand { speed, pressure, ..Demand::default() }
    }

    #[test]
    fn substeps_grow_with_the_square_root_of_the_depth() {
        let at = |depth: f64| rule().choose(1.0 / 60.0, driven(0.0, 9.81 * depth)).substeps;
        assert_eq!(at(3.0), 7);
        assert!((f64::from(at(120.0)) / f64::from(at(30.0)) - 2.0).abs() < 0.1);
    }

    #[test]
    fn speed_is_bound_to_two_fifths_of_a_spacing() {
        let choice = rule().choose(1.0 / 60.0, driven(12.0, 0.0));
        assert_eq!(choice.substeps, 5);
    }

    #[test]
    fn the_cap_binds_and_says_what_was_wanted() {
        let choice = rule().choose(1.0, driven(1e4, 0.0));
        assert_eq!((choice.substeps, choice.wanted, choice.reason), (256, 250_000, SubstepReason::Speed));
    }

    #[test]
    fn the_number_rises_at_once_and_falls_slowly() {
        let after = |last, speed| rule().choose_after(last, 1.0 / 60.0, driven(speed, 0.0)).substeps;
        assert_eq!(after(5, 24.0), 10);
        assert_eq!(after(10, 23.0), 10, "a little less changes nothing");
        assert_eq!(after(10, 2.4), 7, "much less is approached in steps");
        assert_eq!(after(2, 0.0), 1, "and reached");
    }

    #[test]
    fn stiffness_does_not_jump_with_the_number_of_substeps() {
        let demand = |pressure| driven(10.0, pressure);
        let after = |last, now, pressure| rule().stiffness_after(last, 1.0, 1.0 / 60.0, demand(pressure), now);
        let full = |part: f64, substeps: f64| part * substeps * substeps;
        assert_eq!(after(0, 2, 0.0), 1.0, "there is nothing to keep at the start");
        assert!((full(after(1, 2, 0.0), 2.0) / full(1.0, 1.0) - STIFFENING).abs() < 1e-12, "it grows slowly");
        assert_eq!(after(3, 2, 0.0), 1.0, "and falls at once");
        let wanted = rule().choose(1.0 / 60.0, demand(200.0)).substeps;
        assert!(after(1, wanted, 200.0) > 0.9, "where the target needs it, it is there");
        assert_eq!(rule().stiffness_after(4, 0.5, 1.0 / 60.0, demand(0.0), 4), 0.5 * STIFFENING);
    }

    #[test]
    fn the_demand_that_decides_is_named() {
        let reason = |demand| rule().choose(1.0 / 60.0, demand).reason;
        assert_eq!(reason(driven(50.0, 0.0)), SubstepReason::Speed);
        assert_eq!(reason(driven(0.0, 30.0)), SubstepReason::Compression);
        let loose = Scene { spacing: 0.1, ..Scene::default() };
        let loose = Scene { solver: crate::scene::SolverSettings { target_compression: 0.1, ..loose.solver }, ..loose };
        let still = driven(0.0, 30.0);
        assert_eq!(SubstepRule::new(&loose).choose(1.0 / 60.0, still).reason, SubstepReason::TrustRegion);
        assert_eq!(reason(Demand { support: 100.0, ..Demand::default() }), SubstepReason::Support);
    }
}
