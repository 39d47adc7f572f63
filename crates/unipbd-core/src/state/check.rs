//! Consistency check of data read: a state with a valid checksum may still be made by hand.

use super::error::damaged;
use super::{State, StateError};
use crate::particles::Particles;

/// Frames and substeps that no run reaches: beyond, time as a number no longer advances.
const MOST_STEPS: u64 = 1 << 53;
/// Ids that are left to a run that goes on from a state.
const LEFT_IDS: u32 = 1 << 28;

impl State {
    /// Reports values that no run could have saved.
    pub(super) fn check(&self) -> Result<(), StateError> {
        self.particles.check().map_err(damaged)?;
        self.check_clock()?;
        if !self.list.is_finite() {
            return Err(damaged("its neighbour list is not at finite positions"));
        }
        Ok(())
    }

    fn check_clock(&self) -> Result<(), StateError> {
        let clock = &self.clock;
        let times = [clock.time, clock.dt, clock.speed, clock.pressure_limit];
        let finite = clock.time.is_finite() && clock.dt.is_finite();
        if !(finite && times.into_iter().all(|value| value >= 0.0)) {
            return Err(damaged("its clock is not a finite time"));
        }
        if ![clock.frame, clock.step, clock.generation].into_iter().all(|count| count < MOST_STEPS) {
            return Err(damaged("its clock has counted too far"));
        }
        if !(clock.push.mean.is_finite() && clock.push.spread >= 0.0 && clock.push.spread.is_finite()) {
            return Err(damaged("the acceleration by its hooks is not finite"));
        }
        if !(0.0..=1.0).contains(&clock.stiffness) {
            return Err(damaged("the stiffness of its fluids is not between 0 and 1"));
        }
        if clock.done > clock.substeps || (clock.done > 0 && clock.dt <= 0.0) {
            return Err(damaged("it has done more substeps than its frame has"));
        }
        Ok(())
    }
}

impl Particles {
    /// Reports inconsistencies of columns from an external source.
    fn check(&self) -> Result<(), &'static str> {
        let rows = self.len();
        let always = [self.start.len(), self.displacement.len(), self.remainder.len(), self.velocity.len()];
        let also = [self.inverse_mass.len(), self.density_error.len(), self.multiplier.len(), self.id.len()];
        let last = [self.material.len(), self.phase.len()];
        let kept = [self.temperature.len(), self.age.len(), self.anchor.len(), self.rest.len()];
        let optional = kept.into_iter().chain([self.acceleration.len()]);
        let whole = always.into_iter().chain(also).chain(last).all(|length| length == rows);
        if !whole || optional.into_iter().any(|length| length != 0 && length != rows) {
            return Err("its columns differ in length");
        }
        let awake = self.dense().checked_sub(self.asleep()).filter(|_| self.dense() <= rows);
        if awake.and_then(|awake| awake.checked_add(self.border())).is_none_or(|listed| listed > self.dense())
            || (0..rows).any(|row| self.phase[row].is_dense() != (row < self.dense()))
        {
            return Err("its rows are out of order");
        }
        let mut ids = self.id.clone();
        ids.sort_unstable();
        if ids.windows(2).any(|pair| pair[0] == pair[1]) || ids.last().is_some_and(|&id| id >= self.ids_given()) {
            return Err("its ids are not those of one run");
        }
        if self.ids_given() > u32::MAX - LEFT_IDS {
            return Err("it has hardly an id left");
        }
        let kinematics = [&self.position, &self.start, &self.displacement, &self.remainder, &self.velocity];
        let vectors = kinematics.into_iter().chain([&self.anchor, &self.acceleration]);
        let traits = [&self.inverse_mass, &self.density_error, &self.multiplier];
        let numbers = traits.into_iter().chain([&self.temperature, &self.age, &self.rest]);
        let finite = vectors.flatten().all(|vector| vector.is_finite())
            && numbers.into_iter().flatten().all(|number| number.is_finite());
        if !finite {
            return Err("a number is not finite");
        }
        let massive = self.inverse_mass.iter().all(|&inverse_mass| inverse_mass >= 0.0);
        if massive { Ok(()) } else { Err("a mass is negative") }
    }
}
