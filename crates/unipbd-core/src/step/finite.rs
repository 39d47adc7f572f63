//! At the end of a frame: a number that is not finite stops a run, in whatever column it is.

use super::SolverError;
use super::world::World;
use crate::math::{Real, Vector};

/// Name of this check among the stages.
const STAGE: &str = "end_of_frame";

impl World {
    /// Refuses NaN and infinity in the columns of the particles and in the poses of bodies. Velocities are looked at in
    /// every substep.
    pub(super) fn check_finite(&self) -> Result<(), SolverError> {
        let particles = &self.parts.particles;
        let vectors = [("position", &particles.position), ("position", &particles.remainder)];
        let numbers = [
            ("temperature", &particles.temperature),
            ("density error", &particles.density_error),
            ("pressure multiplier", &particles.multiplier),
            ("age", &particles.age),
        ];
        for (name, column) in vectors {
            self.check_column(name, column, |x: &Vector| x.is_finite())?;
        }
        for (name, column) in numbers {
            self.check_column(name, column, |x: &Real| x.is_finite())?;
        }
        self.check_bodies()
    }

    fn check_column<T: Sync>(&self, name: &str, column: &[T], finite: fn(&T) -> bool) -> Result<(), SolverError> {
        if self.parts.parallelism.all(column.len(), |row| finite(&column[row])) {
            return Ok(());
        }
        let (particles, clock) = (&self.parts.particles, &self.clock);
        let row = column.iter().position(|value| !finite(value)).unwrap_or(0);
        Err(SolverError::Diverged {
            stage: STAGE,
            step: clock.step,
            time: clock.time,
            particle: particles.id[row],
            material: self.parts.materials[usize::from(particles.material[row])].name.clone(),
            what: format!("has a {name} that is not finite"),
        })
    }

    fn check_bodies(&self) -> Result<(), SolverError> {
        let Some(rigid) = &self.parts.rigid else { return Ok(()) };
        let lost = rigid.bodies.first_not_finite();
        lost.map_or(Ok(()), |body| {
            let name = rigid.views()[body].name.clone();
            Err(SolverError::Body { step: self.clock.step, time: self.clock.time, body: name })
        })
    }
}
