//! What a frame demands of its substeps, and what pressure is believed, from the state alone.

use super::substeps::Demand;
use super::world::World;
use crate::math::{Real, Vector, Vector64, wide};
use crate::observe::{Event, Severity};
use crate::phase::Phase;

/// Pressures up to this many times what depth and speed account for are believed.
const PRESSURE_MARGIN: f64 = 8.0;
/// The pressure of the multipliers decides the number of substeps only where it is this many times the
/// expected one: they rise when the number changes, and must not change it in turn. A column that is let go
/// swings to twice its weight; to answer that with more substeps pumps energy into the swing.
const UNEXPECTED: f64 = 3.0;
/// Speed, in spacings per frame, that a compressed liquid may always reach.
const LEAST_SPEED: f64 = 2.0;

impl World {
    pub(super) fn choose_substeps(&mut self) -> u32 {
        let demand = self.demand();
        let (rule, last, frame) = (self.parts.substeps, self.clock.substeps, self.parts.frame_time);
        let choice = rule.choose_after(last, frame, demand);
        self.clock.stiffness = rule.stiffness_after(last, self.clock.stiffness, frame, demand, choice.substeps);
        let capped = choice.wanted > choice.substeps;
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

    pub(super) fn warn_of_cut(&mut self, effect: &str, granted: f64) {
        let wanted = (f64::from(self.clock.substeps) / granted).ceil();
        let message = format!(
            "{effect} cut to {:.3} of what the scene asks for: {wanted} substeps per frame would bear it, {} were taken",
            granted, self.clock.substeps
        );
        self.events.push(Event { time: self.clock.time, severity: Severity::Warning, message });
    }

    /// What the number of substeps follows from.
    pub fn demand(&self) -> Demand {
        let parts = &self.parts;
        let emitted = parts.emitters.as_ref().map_or(0.0, |emitters| emitters.speed_max(self.clock.time));
        let moving = if self.clock.step == 0 { self.fastest() } else { self.clock.speed };
        let chain = parts.rigid.as_ref().map_or(0.0, |rigid| rigid.support_chain(wide(parts.gravity)));
        let expected = self.depth_pressure(is_liquid).max(self.dynamic_pressure());
        Demand { speed: moving.max(emitted), chain, pressure: expected.max(self.multiplier_pressure() / UNEXPECTED) }
    }

    pub(super) fn fastest(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let dense = self.parts.particles.dense();
        let square = self.parts.parallelism.max(dense, |row| velocities[row].length_squared());
        f64::from(square.max(0.0)).sqrt()
    }

    /// Pressure over density at the bottom of these phases, from their extent along gravity [m^2/s^2].
    fn depth_pressure(&self, counted: fn(Phase) -> bool) -> f64 {
        let parts = &self.parts;
        let gravity = parts.gravity.length();
        if gravity == 0.0 {
            return 0.0;
        }
        let depth = self.extent_along(parts.gravity / gravity, counted);
        if depth.is_finite() { f64::from(gravity) * depth * self.density_ratio() } else { 0.0 }
    }

    /// How far these phases extend in this direction [m]; not finite where there are none.
    fn extent_along(&self, direction: Vector, counted: fn(Phase) -> bool) -> f64 {
        let (parts, particles) = (&self.parts, &self.parts.particles);
        let place = |row: usize| match particles.phase[row] {
            phase if counted(phase) => particles.position[row].dot(direction),
            _ => Real::NAN,
        };
        let most = parts.parallelism.max(particles.dense(), place);
        let least = parts.parallelism.max(particles.dense(), |row| -place(row));
        f64::from(most) + f64::from(least)
    }

    /// Width and depth of the liquids, across gravity and along it [m]; 0 without either.
    pub(super) fn extent(&self) -> [f64; 2] {
        let gravity = self.parts.gravity.length();
        let down = if gravity > 0.0 { self.parts.gravity / gravity } else { Vector::ZERO };
        let extents = [down.perp(), down].map(|direction| self.extent_along(direction, is_liquid));
        if extents.iter().all(|extent| extent.is_finite()) { extents } else { [0.0; 2] }
    }

    /// Pressure over density of the liquids after the last substep [m^2/s^2]: the largest one if it
    /// grows linearly with depth, taken from the mean square, so that a few particles squeezed in
    /// somewhere do not decide for all.
    fn multiplier_pressure(&self) -> f64 {
        if self.clock.step == 0 {
            return 0.0;
        }
        let particles = &self.parts.particles;
        let (sum, count) = self.over(is_liquid, |row| {
            let pressure = f64::from(particles.multiplier[row] * particles.inverse_mass[row]);
            pressure * pressure
        });
        (3.0 * sum / count.max(1.0)).sqrt() / (self.clock.dt * self.clock.dt)
    }

    /// The pressure that a fluid as deep and as fast as this one can reach, with a wide margin
    /// [m^2/s^2]. The speed is the fourth root of the mean fourth power: jets count, single drops do not.
    pub(super) fn pressure_limit(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let (sum, count) = self.over(Phase::is_fluid, |row| {
            let square = f64::from(velocities[row].length_squared());
            square * square
        });
        let dynamic = 0.5 * (sum / count.max(1.0)).sqrt();
        let least = LEAST_SPEED * self.parts.spacing / self.parts.frame_time;
        PRESSURE_MARGIN * (self.depth_pressure(Phase::is_fluid) + dynamic) + least * least
    }

    /// Pressure over density that the motion of the liquids within themselves can bring about
    /// [m^2/s^2]: the square of their speed relative to the mean one, as the fourth root of its mean
    /// fourth power.
    fn dynamic_pressure(&self) -> f64 {
        let velocities = &self.parts.particles.velocity;
        let (x, count) = self.over(is_liquid, |row| f64::from(velocities[row].x));
        let (y, _) = self.over(is_liquid, |row| f64::from(velocities[row].y));
        let mean = Vector64::new(x, y) / count.max(1.0);
        let (sum, count) = self.over(is_liquid, |row| {
            let square = (wide(velocities[row]) - mean).length_squared();
            square * square
        });
        (sum / count.max(1.0)).sqrt()
    }

    /// Sum of a value over the particles of these phases, and their number.
    fn over(&self, counted: fn(Phase) -> bool, value: impl Fn(usize) -> f64 + Sync) -> (f64, f64) {
        let particles = &self.parts.particles;
        let counts = |row: usize| counted(particles.phase[row]);
        let sum = self.parts.parallelism.sum(particles.dense(), |row| if counts(row) { value(row) } else { 0.0 });
        (sum, self.parts.parallelism.sum(particles.dense(), |row| f64::from(u8::from(counts(row)))))
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
            // Only one that would change the ratio is looked for.
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
