//! Statistics of the particles of some phases: the input of the demand of a frame.

use crate::math::{Real, Vector, Vector64, larger, wide};
use crate::phase::Phase;
use crate::step::world::World;

/// Sums and extremes over the particles of some phases.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::step) struct FluidStatistics {
    /// Number of particles.
    count: f64,
    /// Sum of the velocities [m/s].
    velocity: Vector64,
    /// Sum of the fourth powers of the speeds [m^4/s^4].
    fourth: f64,
    /// Sum of the squares of the speeds [m^2/s^2].
    square: f64,
    /// Sum of the energies over mass that compression stores, times the square of the substep [m^2].
    stored: f64,
    /// Sum of the squares of the pressures over density, times the fourth power of the substep [m^4].
    pressure: f64,
    /// Largest coordinate along a direction and largest against it \[m]; not finite without particles.
    reach: [Real; 2],
}

impl FluidStatistics {
    const EMPTY: FluidStatistics = FluidStatistics {
        count: 0.0,
        velocity: Vector64::ZERO,
        fourth: 0.0,
        square: 0.0,
        stored: 0.0,
        pressure: 0.0,
        reach: [Real::NEG_INFINITY; 2],
    };

    fn with(self, other: FluidStatistics) -> FluidStatistics {
        FluidStatistics {
            count: self.count + other.count,
            velocity: self.velocity + other.velocity,
            fourth: self.fourth + other.fourth,
            square: self.square + other.square,
            stored: self.stored + other.stored,
            pressure: self.pressure + other.pressure,
            reach: [larger(self.reach[0], other.reach[0]), larger(self.reach[1], other.reach[1])],
        }
    }

    fn mean(self, sum: f64) -> f64 {
        sum / self.count.max(1.0)
    }

    /// Mean velocity [m/s].
    pub fn mean_velocity(self) -> Vector64 {
        self.velocity / self.count.max(1.0)
    }

    /// Root of the mean fourth power of the speed [m^2/s^2]: jets contribute, single drops hardly do.
    pub fn square_of_speed(self) -> f64 {
        self.mean(self.fourth).sqrt()
    }

    /// Largest pressure over density after a substep of this length [m^2/s^2], if it grows linearly with
    /// depth: computed from the mean square, so that a few locally compressed particles do not dominate.
    pub fn pressure(self, dt: f64) -> f64 {
        (3.0 * self.mean(self.pressure)).sqrt() / (dt * dt)
    }

    /// Energies over mass of motion and, after a substep of this length \[s], of compression [m^2/s^2].
    pub fn energies(self, dt: f64) -> [f64; 2] {
        [0.5 * self.mean(self.square), self.mean(self.stored) / (dt * dt)]
    }

    /// How far the particles extend along the direction \[m]; not finite without particles.
    pub fn depth(self) -> f64 {
        f64::from(self.reach[0]) + f64::from(self.reach[1])
    }

    /// The depth, or 0 where there is nothing \[m].
    pub fn fall(self) -> f64 {
        if self.depth().is_finite() { self.depth() } else { 0.0 }
    }
}

impl World {
    /// Computes the statistics of these phases in one pass; `down` is the direction of their extent.
    pub(in crate::step) fn survey(&self, down: Vector, counted: impl Fn(Phase) -> bool + Sync) -> FluidStatistics {
        let particles = &self.parts.particles;
        let add = |sum: FluidStatistics, row: usize| {
            if !counted(particles.phase[row]) {
                return sum;
            }
            let velocity = particles.velocity[row];
            let square = f64::from(velocity.length_squared());
            let pressure = f64::from(particles.multiplier[row] * particles.inverse_mass[row]);
            let compression = f64::from(larger(particles.density_error[row], 0.0));
            let place = particles.position[row].dot(down);
            FluidStatistics {
                count: sum.count + 1.0,
                velocity: sum.velocity + wide(velocity),
                fourth: sum.fourth + square * square,
                square: sum.square + square,
                stored: sum.stored + 0.5 * pressure * compression,
                pressure: sum.pressure + pressure * pressure,
                reach: [larger(sum.reach[0], place), larger(sum.reach[1], -place)],
            }
        };
        self.parts.parallelism.reduce(
            particles.dense(),
            |rows| rows.fold(FluidStatistics::EMPTY, add),
            FluidStatistics::with,
        )
    }

    /// Root of the mean fourth power of the speed relative to the mean velocity [m^2/s^2], of the surveyed particles.
    pub(in crate::step) fn square_of_relative_speed(
        &self,
        of: FluidStatistics,
        counted: impl Fn(Phase) -> bool + Sync,
    ) -> f64 {
        let (particles, mean) = (&self.parts.particles, of.mean_velocity());
        let fourth = self.parts.parallelism.sum(particles.dense(), |row| {
            let square = (wide(particles.velocity[row]) - mean).length_squared();
            if counted(particles.phase[row]) { square * square } else { 0.0 }
        });
        of.mean(fourth).sqrt()
    }
}
