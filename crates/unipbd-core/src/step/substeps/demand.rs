//! The number of substeps demanded by a frame, and the limit of the pressure, from the state alone.

use super::controller::Demand;
use super::statistics::FluidStatistics;
use crate::coupling::RigidBodies;
use crate::math::{Vector, Vector64, vector, wide};
use crate::observe::{Event, Severity, SubstepReason};
use crate::phase::Phase;
use crate::pressure_grid::PressureBound;
use crate::step::clock::Push;
use crate::step::world::World;
use std::ops::Range;

/// Limit of the pressure, relative to the pressure expected from depth and speed.
const PRESSURE_MARGIN: f64 = 8.0;
/// The pressure of the multipliers decides the number of substeps only where it is this many times the
/// expected one: they rise when the number changes, and must not change it in turn. A column that is let go
/// swings to twice its weight; to answer that with more substeps pumps energy into the swing.
const UNEXPECTED: f64 = 3.0;
/// Margin of the pressure by which the grid stops what moves.
const STOPPED: f64 = 0.25;
/// Speed limit, in spacings per frame, that a compressed liquid is always allowed.
const LEAST_SPEED: f64 = 2.0;

impl World {
    /// Sets the substeps of a frame, the stiffness and the limit of the pressure.
    pub(in crate::step) fn choose_substeps(&mut self) -> u32 {
        let liquids = self.survey(self.down(), is_liquid);
        let fluids = if self.has_gas() { self.survey(self.down(), Phase::is_fluid) } else { liquids };
        let demand = self.demand(liquids, fluids);
        self.clock.pressure_limit = self.pressure_limit_of(fluids);
        let (rule, last, frame) = (self.parts.substeps, self.clock.substeps, self.parts.frame_time);
        let choice = self.within_budget(rule.choose_after(last, frame, demand));
        self.clock.stiffness = rule.stiffness_after(last, self.clock.stiffness, frame, demand, choice.substeps);
        let capped = choice.wanted > choice.substeps && choice.reason != SubstepReason::Budget;
        if capped && !self.clock.capped {
            let message = format!(
                "substeps capped at {}: {} were wanted for speed {:.3} m/s and pressure {:.3} m^2/s^2; \
                 raise solver.max_substeps to keep the target",
                choice.substeps, choice.wanted, demand.speed, demand.pressure
            );
            self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
        }
        self.clock.capped = capped;
        self.choice = choice;
        choice.substeps
    }

    pub(in crate::step) fn warn_of_cut(&mut self, effect: &str, stable_fraction: f64) {
        let wanted = (f64::from(self.clock.substeps) / stable_fraction).ceil();
        let message = format!(
            "{effect} cut to {:.3} of what the scene asks for: {wanted} substeps per frame would bear it, {} were taken",
            stable_fraction, self.clock.substeps
        );
        self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
    }

    /// The quantities that determine the number of substeps.
    fn demand(&self, liquids: FluidStatistics, fluids: FluidStatistics) -> Demand {
        let parts = &self.parts;
        // Gas hardly carries its own weight, but bodies may lie on it.
        let loaded = parts.rigid.as_ref().is_some_and(RigidBodies::has_dynamic);
        let carrying = if loaded { fluids } else { liquids };
        let emitted = parts.emitters.as_ref().map_or(0.0, |emitters| emitters.speed_max(self.clock.time));
        let acceleration = self.pull().length() + self.clock.push.spread;
        let moving = match self.clock.step {
            0 => self.fastest() + parts.substeps.first_speed(parts.frame_time, acceleration, liquids.fall()),
            _ => self.clock.speed,
        };
        let of_bodies = |rigid: &RigidBodies| rigid.demand(parts.frame_time, wide(parts.gravity));
        let bodies = parts.rigid.as_ref().filter(|_| !parts.substeps.is_fixed()).map(of_bodies).unwrap_or_default();
        // Pressure from the relative motion within the liquids.
        let dynamic = self.square_of_relative_speed(liquids, is_liquid);
        let known = if self.clock.step == 0 { 0.0 } else { carrying.pressure(self.clock.dt) };
        let of_depth = self.depth_pressure(liquids);
        let carried = if loaded { self.sealed_pressure() } else { 0.0 };
        let pressure = of_depth.max(self.buoyancy_pressure()).max(dynamic).max(known / UNEXPECTED).max(carried);
        Demand {
            speed: moving.max(emitted),
            pressure,
            acceleration,
            body_motion: bodies.motion.max(self.by_shear()),
            support: bodies.support,
            loaded,
            over_stored: self.energy_over_stored(carrying, of_depth),
        }
    }

    /// Substeps wanted by bodies that a viscous fluid does not slip along.
    fn by_shear(&self) -> f64 {
        let parts = &self.parts;
        let Some(rigid) = parts.rigid.as_ref().filter(|_| parts.pressure_grid.is_some()) else { return 0.0 };
        let sizes = (0..parts.without_slip.len()).map(|k| rigid.bodies.sizes[parts.without_slip.body(k) as usize]);
        sizes.map(|size| parts.substeps.by_shear(parts.frame_time, size)).fold(0.0, f64::max)
    }

    /// Energy of motion, and of the height of fluids whose depth brings about this pressure over density [m^2/s^2], over
    /// the energy that their compression stores.
    fn energy_over_stored(&self, fluids: FluidStatistics, of_depth: f64) -> f64 {
        if self.clock.step == 0 {
            return f64::INFINITY;
        }
        let [motion, stored] = fluids.energies(self.clock.dt);
        if stored > 0.0 { (motion + 0.5 * of_depth) / stored } else { f64::INFINITY }
    }

    pub(in crate::step) fn fastest(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let dense = self.parts.particles.dense();
        let square = self.parts.parallelism.max(dense, |row| velocities[row].length_squared());
        f64::from(square.max(0.0)).sqrt()
    }

    /// Measures the acceleration by hooks, which the number of substeps and the limit of the pressure follow.
    pub(in crate::step) fn measure_push(&mut self) {
        let particles = &self.parts.particles;
        if particles.acceleration.is_empty() {
            self.clock.push = Push::default();
            return;
        }
        let of_row = |row: usize| {
            let a = if particles.phase[row].is_fluid() { wide(particles.acceleration[row]) } else { return [0.0; 4] };
            [1.0, a.x, a.y, a.length_squared()]
        };
        let add = |a: [f64; 4], b: [f64; 4]| std::array::from_fn(|k| a[k] + b[k]);
        let sum_of = |rows: Range<usize>| rows.map(of_row).fold([0.0; 4], add);
        let [count, x, y, square] = self.parts.parallelism.reduce(particles.dense(), sum_of, add);
        let count = count.max(1.0);
        let mean = Vector64::new(x, y) / count;
        let push = Push { mean, spread: (square / count - mean.length_squared()).max(0.0).sqrt() };
        // The first substep of a frame may be the first with this hook.
        let grown = push.size() > self.clock.push.size();
        self.clock.push = push;
        if grown {
            self.clock.pressure_limit = self.pressure_limit().max(self.clock.pressure_limit);
        }
    }

    /// Mean acceleration of the fluids by gravity and hooks [m/s^2].
    fn pull(&self) -> Vector64 {
        wide(self.parts.gravity) + self.clock.push.mean
    }

    /// Direction of gravity and hooks; zero without either.
    fn down(&self) -> Vector {
        if self.clock.push == Push::default() {
            return self.parts.gravity.normalize_or_zero();
        }
        vector(self.pull().normalize_or_zero())
    }

    fn has_gas(&self) -> bool {
        self.parts.materials.iter().any(|material| material.phase == Phase::Gas)
    }

    /// Pressure over density at the bottom of the surveyed particles, from their extent along gravity [m^2/s^2].
    fn depth_pressure(&self, of: FluidStatistics) -> f64 {
        if self.clock.push != Push::default() {
            return self.pushed_pressure(of) * self.density_ratio();
        }
        let (gravity, depth) = (f64::from(self.parts.gravity.length()), of.depth());
        if gravity > 0.0 && depth.is_finite() { gravity * depth * self.density_ratio() } else { 0.0 }
    }

    /// Pressure over density by which gas in a closed tank presses on its lid or floor, from its mean buoyancy or weight
    /// and its height [m^2/s^2].
    fn buoyancy_pressure(&self) -> f64 {
        if !self.parts.substeps.confines_gas() {
            return 0.0;
        }
        let (particles, forces) = (&self.parts.particles, &self.parts.forces);
        let add = |[count, x, y]: [f64; 3], row: usize| {
            if particles.phase[row] != Phase::Gas {
                return [count, x, y];
            }
            let force = &forces[usize::from(particles.material[row])];
            let pull = wide(force.acceleration * force.factor_at(row, &particles.temperature));
            [count + 1.0, x + pull.x, y + pull.y]
        };
        let [count, x, y] = self.parts.parallelism.reduce(
            particles.dense(),
            |rows| rows.fold([0.0; 3], add),
            |a, b| std::array::from_fn(|k| a[k] + b[k]),
        );
        let pull = Vector64::new(x, y) / count.max(1.0);
        let height = self.survey(vector(pull.normalize_or_zero()), |phase| phase == Phase::Gas).depth();
        if height.is_finite() { pull.length() * height } else { 0.0 }
    }

    /// Pressure over density of gas that a body seals, where particles alone carry it: the weight of all bodies over the
    /// width of the gas [m^2/s^2].
    fn sealed_pressure(&self) -> f64 {
        let parts = &self.parts;
        let Some(rigid) = parts.rigid.as_ref().filter(|_| parts.pressure_grid.is_none() && self.has_gas()) else {
            return 0.0;
        };
        let (down, is_gas) = (self.down(), |phase| phase == Phase::Gas);
        let width = self.survey(down.perp(), is_gas).depth();
        let lightest = self.lightest(is_gas);
        match rigid.spans(wide(down.perp()), width) {
            true => rigid.weight(self.pull().length()) / (width * lightest),
            false => 0.0,
        }
    }

    /// The same with hooks: the acceleration common to all presses along the whole depth, the rest from all sides.
    fn pushed_pressure(&self, of: FluidStatistics) -> f64 {
        let half = 0.5 * self.extent().into_iter().fold(0.0, f64::max);
        let depth = if of.depth().is_finite() { of.depth() } else { 0.0 };
        self.pull().length() * depth + self.clock.push.spread * half
    }

    /// Width and depth of the liquids, across gravity and along it \[m]; 0 without either.
    pub(in crate::step) fn extent(&self) -> [f64; 2] {
        let down = self.down();
        let extents = [down.perp(), down].map(|direction| self.survey(direction, is_liquid).depth());
        if extents.iter().all(|extent| extent.is_finite()) { extents } else { [0.0; 2] }
    }

    /// The maximum pressure over density for this depth and speed of the fluid, with a wide margin [m^2/s^2].
    pub(in crate::step) fn pressure_limit(&self) -> f64 {
        self.pressure_limit_of(self.survey(self.down(), Phase::is_fluid))
    }

    fn pressure_limit_of(&self, fluids: FluidStatistics) -> f64 {
        let least = LEAST_SPEED * self.parts.spacing / self.parts.frame_time;
        let tension = self.parts.substeps.tension_pressure();
        // The grid bears what bodies press with.
        let of_bodies = if self.parts.pressure_grid.is_none() { self.body_pressure() } else { 0.0 };
        let expected = self.depth_pressure(fluids) + 0.5 * fluids.square_of_speed() + tension + of_bodies;
        PRESSURE_MARGIN * expected + least * least
    }

    /// The largest pressure that the grid may find where contacts hold bodies: with margins, what depth, speed and bodies
    /// bring about, and what stops the fastest matter.
    pub(in crate::step) fn grid_pressure_bound(&self) -> PressureBound {
        let of_bodies = self.parts.rigid.as_ref().map_or(0.0, RigidBodies::fastest);
        let pressure = self.clock.pressure_limit + PRESSURE_MARGIN * self.body_pressure();
        PressureBound { pressure, stopped: STOPPED * self.clock.speed.max(of_bodies) }
    }

    /// Least density of the materials of some phases [kg/m^2]; infinite without any.
    fn lightest(&self, counted: impl Fn(Phase) -> bool) -> f64 {
        let materials = self.parts.materials.iter().filter(|material| counted(material.phase));
        materials.map(|material| material.density).fold(f64::INFINITY, f64::min)
    }

    /// Largest pressure of bodies over the density of the lightest fluid that carries them [m^2/s^2].
    fn body_pressure(&self) -> f64 {
        let parts = &self.parts;
        let Some(rigid) = parts.rigid.as_ref() else { return 0.0 };
        let lightest = self.lightest(Phase::is_fluid);
        if lightest.is_finite() { rigid.pressure(f64::from(parts.gravity.length())) / lightest } else { 0.0 }
    }

    /// Density of the heaviest liquid in the scene over that of the lightest: a light liquid carries a heavy one.
    fn density_ratio(&self) -> f64 {
        let is_there = |index: usize| {
            let particles = &self.parts.particles;
            particles.material[..particles.dense()].iter().any(|&material| usize::from(material) == index)
        };
        let materials = self.parts.materials.iter().enumerate();
        let liquids = materials.filter(|(_, material)| material.phase == Phase::Liquid);
        let (mut light, mut heavy) = (f64::INFINITY, 0.0_f64);
        for (index, liquid) in liquids {
            // The search covers only liquids that would change the ratio.
            if (liquid.density < light || liquid.density > heavy) && is_there(index) {
                (light, heavy) = (light.min(liquid.density), heavy.max(liquid.density));
            }
        }
        if heavy > 0.0 { heavy / light } else { 1.0 }
    }
}

fn is_liquid(phase: Phase) -> bool {
    phase == Phase::Liquid
}
