//! The solver loop.
use crate::bodies::Body;
use crate::math::{Real, Vector};
use crate::observe::{Diagnostics, Event, Material, WallOutline};
use crate::phase::{MaterialIndex, Phase};
use crate::scene::{Problems, Scene};
use std::time::Duration;

/// How a scene is built.
#[derive(Clone, Debug, Default)]
pub struct BuildOptions {
    /// Threads to use; left out, all the machine has. Never changes results.
    pub threads: Option<usize>,
    /// Replaces the seed of the scene.
    pub seed: Option<u64>,
}

/// What one frame did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameReport {
    /// Substeps done.
    pub substeps: u32,
    /// Neighbour lists built.
    pub list_builds: u32,
    /// Particles added by emitters.
    pub emitted: u64,
    /// Particles removed.
    pub removed: u64,
}

/// A failure of the solver. The state is that of the failing substep.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SolverError {
    /// A particle has a position or velocity that is not finite, or is absurdly fast.
    Diverged {
        /// Stage after which it was noticed.
        stage: &'static str,
        /// Substep since the start.
        step: u64,
        /// Simulated time [s].
        time: f64,
        /// Stable id of the particle.
        particle: u32,
        /// Name of its material.
        material: String,
        /// What is wrong with it.
        what: String,
    },
}
impl std::fmt::Display for SolverError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SolverError::Diverged { stage, step, time, particle, material, what } => write!(
                f,
                "diverged at {time:.6} s (substep {step}, after {stage}): particle {particle} of \"{material}\" {what}"
            ),
        }
    }
}
impl std::error::Error for SolverError {}

/// A running simulation.
pub struct Solver {
    dummy: (),
}

impl Scene {
    /// Builds a solver; on a faulty scene returns all its problems.
    pub fn build(&self, _options: BuildOptions) -> Result<Solver, Problems> {
        Ok(Solver { dummy: () })
    }
}

#[allow(missing_docs)]
impl Solver {
    /// Advances by one frame (1/fps) and says what it did.
    pub fn step_frame(&mut self) -> Result<FrameReport, SolverError> {
        let _ = self.dummy;
        Ok(FrameReport { substeps: 1, list_builds: 0, emitted: 0, removed: 0 })
    }
    /// Simulated time [s].
    pub fn time(&self) -> f64 {
        0.0
    }
    /// Frames done.
    pub fn frame(&self) -> u64 {
        0
    }
    /// Length of a frame [s].
    pub fn frame_time(&self) -> f64 {
        1.0 / 60.0
    }
    pub fn particles(&self) -> usize {
        0
    }
    // Columns, all in the same row order; rows are re-sorted by steps, ids are stable.
    pub fn positions(&self) -> &[Vector] {
        &[]
    }
    pub fn velocities(&self) -> &[Vector] {
        &[]
    }
    pub fn ids(&self) -> &[u32] {
        &[]
    }
    pub fn phases(&self) -> &[Phase] {
        &[]
    }
    pub fn material_indices(&self) -> &[MaterialIndex] {
        &[]
    }
    /// C = rho/rho0 - 1 per particle at the last substep; 0 for particles without a density constraint.
    pub fn density_errors(&self) -> &[Real] {
        &[]
    }
    /// Temperature per particle, or empty when no material has one.
    pub fn temperatures(&self) -> &[Real] {
        &[]
    }
    /// Advances each time the set of ids changes (emission, removal).
    pub fn id_generation(&self) -> u64 {
        0
    }
    pub fn materials(&self) -> &[Material] {
        &[]
    }
    pub fn bodies(&self) -> &[Body] {
        &[]
    }
    pub fn wall_outlines(&self) -> &[WallOutline] {
        &[]
    }
    /// Takes the events since the last call.
    pub fn take_events(&mut self) -> Vec<Event> {
        Vec::new()
    }
    pub fn diagnostics(&self) -> Diagnostics {
        unimplemented!()
    }
    /// Wall-clock time spent per stage since the start, under the stage's name.
    pub fn timings(&self) -> Vec<(&'static str, Duration)> {
        Vec::new()
    }
    /// Names of the stages this scene runs, in order.
    pub fn stage_names(&self) -> Vec<&'static str> {
        Vec::new()
    }
    /// Hash of the whole state, in id order: the same on any number of threads.
    pub fn state_hash(&self) -> u64 {
        0
    }
    pub fn memory_bytes(&self) -> usize {
        0
    }
    pub fn seed(&self) -> u64 {
        0
    }
    pub fn spacing(&self) -> f64 {
        0.1
    }
}
