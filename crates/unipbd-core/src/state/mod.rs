//! The state of a run: saved, restored, written as bytes, hashed.
//!
//! A [`State`] holds everything that a run goes on from, bit for bit: columns in row order with their
//! rounding remainders, multipliers, the reference positions and the skin of the neighbour list (the
//! same list is made from them again), clock, emitters, groups. Saving never changes a run.
//!
//! Bytes are read by the version of the format that wrote them and by no other: a run goes on bit for bit, or not at all.

mod bodies;
mod check;
mod error;
mod file;
mod hash;
mod save;
mod structure;

pub use error::StateError;

use crate::neighbors::SavedList;
use crate::particles::Particles;
use crate::step::Clock;

/// A saved moment of a run. [`Solver::save`](crate::Solver::save) makes one,
/// [`Solver::restore`](crate::Solver::restore) goes back to it; as bytes it goes into files.
#[derive(Clone, Debug)]
pub struct State {
    structure: Vec<String>,
    clock: Clock,
    particles: Particles,
    list: SavedList,
    sections: Vec<Section>,
    /// Whether it comes from bytes, which anybody may have made.
    read: bool,
}

/// The additional data of one part of a run (emitters, a constraint group).
#[derive(Clone, Debug, PartialEq, Eq)]
struct Section {
    name: String,
    words: Vec<u64>,
}

impl State {
    /// Simulated time \[s].
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Frames done.
    pub fn frame(&self) -> u64 {
        self.clock.frame
    }

    /// Substeps done.
    pub fn step(&self) -> u64 {
        self.clock.step
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.particles.len()
    }
}
