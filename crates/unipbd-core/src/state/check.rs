//! Consistency check of data read: a state with a valid checksum may still be made by hand.

use super::error::damaged;
use super::{State, StateError};
use crate::particles::Particles;

impl State {
    /// Reports values that no run could have saved.
    pub(super) fn check(&self) -> Result<(), StateError> {
        self.particles.check().map_err(damaged)?;
        let clock = &self.clock;
        if ![clock.time, clock.dt, clock.speed].into_iter().all(|value| value.is_finite() && value >= 0.0) {
            return Err(damaged("its clock is not a finite time"));
        }
        if !(0.0..=1.0).contains(&clock.stiffness) {
            return Err(damaged("the stiffness of its fluids is not between 0 and 1"));
        }
        if clock.done > clock.substeps {
            return Err(damaged("it has done more substeps than its frame has"));
        }
        if !self.list.is_finite() {
            return Err(damaged("its neighbour list is not at finite positions"));
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
        let optional = [self.temperature.len(), self.age.len(), self.anchor.len(), self.rest.len()];
        let whole = always.into_iter().chain(also).chain(last).all(|length| length == rows);
        if !whole || optional.into_iter().any(|length| length != 0 && length != rows) {
            return Err("its columns differ in length");
        }
        if self.dense() > rows
            || self.asleep() > self.dense()
            || self.listed() > self.dense()
            || (0..rows).any(|row| self.phase[row].is_dense() != (row < self.dense()))
        {
            return Err("its rows are out of order");
        }
        let mut ids = self.id.clone();
        ids.sort_unstable();
        if ids.windows(2).any(|pair| pair[0] == pair[1]) || ids.last().is_some_and(|&id| id >= self.ids_given()) {
            return Err("its ids are not those of one run");
        }
        let kinematics = [&self.position, &self.start, &self.displacement, &self.remainder, &self.velocity];
        let vectors = kinematics.into_iter().chain([&self.anchor]);
        let traits = [&self.inverse_mass, &self.density_error, &self.multiplier];
        let numbers = traits.into_iter().chain([&self.temperature, &self.age, &self.rest]);
        let finite = vectors.flatten().all(|vector| vector.is_finite())
            && numbers.into_iter().flatten().all(|number| number.is_finite());
        if finite { Ok(()) } else { Err("a number is not finite") }
    }
}
