//! Particles as columns, one row each.
//!
//! Rows `[0, dense)` take part in the density and in neighbour lists (liquid, gas, rigid samples), the
//! last of them, `[awake, dense)`, asleep: they are held in place. Those that sleep near others that are
//! awake, `[awake, listed)`, have neighbour lists and a pressure all the same. Rows `[dense, len)` are
//! loose: smoke markers and free points. Rows are re-sorted as particles move, so a row number is not
//! valid between two steps: the id is.

use crate::bytes::{Damage, Reader, Writer, held};
use crate::math::{Real, Vector, Vector64, vector, wide};
use crate::parallel::Parallelism;
use crate::phase::{MaterialIndex, Phase};
use std::ops::Range;

mod scratch;
pub(crate) use scratch::Scratch;
use scratch::{Buffer, gather};

/// Position of a particle that was displaced by u since the start x_n of the substep: x = x_n + (u + rem), where rem is
/// the part of earlier displacements that rounding kept out of the position \[m]. In f32 this stays accurate out to 10^5
/// spacings from the origin, where x - x_n would lose gravity altogether.
#[inline(always)]
pub(crate) fn displaced(start: Vector, displacement: Vector, remainder: Vector) -> Vector {
    start + (displacement + remainder)
}

/// Columns that not every scene has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OptionalColumns {
    /// Temperature, for gas.
    pub temperature: bool,
    /// Age, for materials with a lifetime.
    pub age: bool,
    /// Time and place of rest of a particle, for liquids that sleep.
    pub rest: bool,
}

/// A particle about to be added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewParticle {
    /// Position \[m]; the rounding error is kept.
    pub position: Vector64,
    /// Velocity [m/s].
    pub velocity: Vector,
    /// Inverse mass [1/kg]; 0 for a kinematic particle.
    pub inverse_mass: Real,
    /// Material.
    pub material: MaterialIndex,
    /// Phase of the material.
    pub phase: Phase,
    /// Temperature; dropped where the scene has none.
    pub temperature: Real,
}

macro_rules! columns {
    ($( $(#[$doc:meta])* $name:ident : $type:ty ),* $(,)?) => {
        /// The particles of a run.
        #[derive(Clone, Debug, Default)]
        pub struct Particles {
            $( $(#[$doc])* pub(crate) $name: Vec<$type>, )*
            dense: usize,
            asleep: usize,
            border: usize,
            next_id: u32,
            optional: OptionalColumns,
            kinematic: bool,
        }

        impl Particles {
            fn swap_rows(&mut self, a: usize, b: usize) {
                $( if !self.$name.is_empty() { self.$name.swap(a, b); } )*
            }

            fn pop_row(&mut self) {
                $( self.$name.pop(); )*
            }

            /// Lets go of the room that filling the columns one by one has left over.
            pub(crate) fn fit(&mut self) {
                $( self.$name.shrink_to_fit(); )*
            }

            /// Brings the rows from `first` on into a new order: row `first + i` becomes the old
            /// row `first + order[i]`.
            pub(crate) fn reorder(
                &mut self,
                first: usize,
                order: &[u32],
                parallelism: Parallelism,
                scratch: &mut Scratch,
            ) {
                if !order.is_empty() {
                    $( gather(&mut self.$name, first, order, parallelism, scratch.buffer()); )*
                }
            }

            /// Appends every column to a saved state.
            pub(crate) fn write(&self, out: &mut Writer) {
                $( out.column(&self.$name); )*
                out.value(self.dense as u64);
                out.value(self.asleep as u64);
                out.value(self.border as u64);
                out.value(self.next_id);
                let flags = [self.optional.temperature, self.optional.age, self.kinematic, self.optional.rest];
                out.value(flags.into_iter().rev().fold(0_u16, |bits, flag| bits << 1 | u16::from(flag)));
            }

            /// Takes every column from a saved state.
            pub(crate) fn read(input: &mut Reader<'_>) -> Result<Self, Damage> {
                let mut particles = Particles { $( $name: input.column()?, )* ..Particles::default() };
                particles.dense = usize::try_from(input.value::<u64>()?).unwrap_or(usize::MAX);
                particles.asleep = usize::try_from(input.value::<u64>()?).unwrap_or(usize::MAX);
                particles.border = usize::try_from(input.value::<u64>()?).unwrap_or(usize::MAX);
                particles.next_id = input.value()?;
                let flags = input.value::<u16>()?;
                particles.optional = OptionalColumns {
                    temperature: flags & 1 != 0,
                    age: flags & 2 != 0,
                    rest: flags & 8 != 0,
                };
                particles.kinematic = flags & 4 != 0;
                Ok(particles)
            }

            /// Memory held by the columns \[bytes].
            pub(crate) fn memory_bytes(&self) -> usize {
                0 $( + held(&self.$name) )*
            }
        }
    };
}

columns! {
    /// Position x; during a substep the predicted and projected one \[m].
    position: Vector,
    /// Position at the start of the substep, x_n \[m].
    start: Vector,
    /// Displacement since the start of the substep, u \[m]; for smoke the velocity one substep ago [m/s].
    displacement: Vector,
    /// Part of the displacement that rounding kept out of the position \[m].
    remainder: Vector,
    /// Velocity [m/s].
    velocity: Vector,
    /// Inverse mass [1/kg]; 0 for kinematic particles.
    inverse_mass: Real,
    /// Density error C of the last substep.
    density_error: Real,
    /// Density multiplier of the last substep [kg m^2].
    multiplier: Real,
    /// Stable id, never reused within a run.
    id: u32,
    /// Material.
    material: MaterialIndex,
    /// Phase.
    phase: Phase,
    /// Temperature (optional column).
    temperature: Real,
    /// Time since the particle was added \[s] (optional column).
    age: Real,
    /// Where the particle came to rest \[m] (optional column).
    anchor: Vector,
    /// How long its surroundings have been at rest \[s] (optional column).
    rest: Real,
    /// Acceleration that a hook adds in this substep [m/s^2]; empty unless one does.
    acceleration: Vector,
}

impl Particles {
    /// An empty set with these optional columns.
    pub(crate) fn new(optional: OptionalColumns) -> Self {
        Particles { optional, ..Particles::default() }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Rows that take part in the density.
    pub fn dense(&self) -> usize {
        self.dense
    }

    /// Dense rows that move: all before the sleeping ones.
    pub fn awake(&self) -> usize {
        self.dense - self.asleep
    }

    /// Dense rows that sleep: held in place until a body or particle near them moves.
    pub fn asleep(&self) -> usize {
        self.asleep
    }

    /// Sleeping rows near others that are awake.
    pub(crate) fn border(&self) -> usize {
        self.border
    }

    /// Dense rows with a neighbour list: those awake, and those that sleep near them.
    pub fn listed(&self) -> usize {
        self.awake() + self.border
    }

    /// The rows that move: those awake, and the loose ones.
    pub(crate) fn bands(&self) -> [Range<usize>; 2] {
        // One band where no row sleeps: then loops are cut into the same chunks as without sleep.
        if self.asleep == 0 { [0..self.len(), 0..0] } else { [0..self.awake(), self.dense..self.len()] }
    }

    /// The rows that have a list or need none.
    pub(crate) fn listed_bands(&self) -> [Range<usize>; 2] {
        if self.asleep == 0 { [0..self.len(), 0..0] } else { [0..self.listed(), self.dense..self.len()] }
    }

    /// From now on the last dense rows, this many, sleep; the first of them, `border`, near others
    /// that are awake.
    pub(crate) fn set_asleep(&mut self, asleep: usize, border: usize) {
        (self.asleep, self.border) = (asleep, border);
    }

    /// Number of ids given so far: every id is below it.
    pub fn ids_given(&self) -> u32 {
        self.next_id
    }

    /// Which columns the scene asked for.
    pub(crate) fn optional(&self) -> OptionalColumns {
        self.optional
    }

    /// Positions \[m].
    pub fn positions(&self) -> &[Vector] {
        &self.position
    }

    /// Positions at the start of the substep \[m].
    pub fn starts(&self) -> &[Vector] {
        &self.start
    }

    /// Velocities [m/s].
    pub fn velocities(&self) -> &[Vector] {
        &self.velocity
    }

    /// Inverse masses [1/kg]; 0 for kinematic particles.
    pub fn inverse_masses(&self) -> &[Real] {
        &self.inverse_mass
    }

    /// Stable ids.
    pub fn ids(&self) -> &[u32] {
        &self.id
    }

    /// Phases.
    pub fn phases(&self) -> &[Phase] {
        &self.phase
    }

    /// Materials.
    pub fn materials(&self) -> &[MaterialIndex] {
        &self.material
    }

    /// Temperatures; empty where the scene has none.
    pub fn temperatures(&self) -> &[Real] {
        &self.temperature
    }

    /// Density errors C = rho/rho0 - 1 of the last substep, 0 for rows without a density constraint.
    pub fn density_errors(&self) -> &[Real] {
        &self.density_error
    }

    /// Whether a dense particle is, or ever was, kinematic.
    pub(crate) fn any_kinematic(&self) -> bool {
        self.kinematic
    }

    /// From now on dense rows may have an inverse mass of 0.
    pub(crate) fn note_kinematic(&mut self) {
        self.kinematic = true;
    }

    /// Accelerations by row for the next prediction, zero at first [m/s^2].
    pub(crate) fn accelerations_mut(&mut self) -> &mut [Vector] {
        let rows = self.len();
        self.acceleration.resize(rows, Vector::ZERO);
        &mut self.acceleration
    }

    /// No accelerations beside those of the scene.
    pub(crate) fn clear_accelerations(&mut self) {
        self.acceleration.clear();
    }

    /// Lets the substep start at the present positions.
    pub(crate) fn start_here(&mut self) {
        self.start.copy_from_slice(&self.position);
    }

    /// Adds a particle and returns its id.
    pub(crate) fn push(&mut self, new: NewParticle) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        let position = vector(new.position);
        self.position.push(position);
        self.start.push(position);
        self.displacement.push(if new.phase.is_passive() { new.velocity } else { Vector::ZERO });
        self.remainder.push(if new.phase.is_passive() { Vector::ZERO } else { vector(new.position - wide(position)) });
        self.velocity.push(new.velocity);
        self.inverse_mass.push(new.inverse_mass);
        self.density_error.push(0.0);
        self.multiplier.push(0.0);
        self.id.push(id);
        self.material.push(new.material);
        self.phase.push(new.phase);
        if self.optional.temperature {
            self.temperature.push(new.temperature);
        }
        if self.optional.age {
            self.age.push(0.0);
        }
        if self.optional.rest {
            self.anchor.push(position);
            self.rest.push(0.0);
        }
        if !self.acceleration.is_empty() {
            self.acceleration.push(Vector::ZERO);
        }
        self.kinematic |= new.inverse_mass == 0.0 && new.phase.is_dense();
        if new.phase.is_dense() {
            let last = self.len() - 1;
            self.swap_rows(self.dense, last);
            self.swap_rows(self.listed(), self.dense);
            self.swap_rows(self.awake(), self.listed());
            self.dense += 1;
        }
        id
    }

    /// Removes rows, given in ascending order; the rows behind them fill the holes.
    pub(crate) fn remove_rows(&mut self, rows: &[u32]) {
        for &row in rows.iter().rev() {
            let mut hole = row as usize;
            if hole < self.dense {
                hole = self.close_gap(hole);
                self.dense -= 1;
                self.swap_rows(hole, self.dense);
                hole = self.dense;
            }
            let last = self.len() - 1;
            self.swap_rows(hole, last);
            self.pop_row();
        }
    }
}

impl Particles {
    /// Moves a dense row that is to go to the end of its kind, and on into the place before the deep
    /// sleepers; counts it out of those asleep.
    fn close_gap(&mut self, row: usize) -> usize {
        let (awake, listed) = (self.awake(), self.listed());
        let mut hole = row;
        if hole < awake {
            self.swap_rows(hole, awake - 1);
            hole = awake - 1;
        } else {
            self.asleep -= 1;
        }
        if hole < listed {
            self.swap_rows(hole, listed - 1);
            self.border -= usize::from(row >= awake);
            hole = listed - 1;
        }
        hole
    }
}

#[cfg(test)]
mod tests;
