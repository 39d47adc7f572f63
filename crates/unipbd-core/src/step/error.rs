use std::fmt;

/// A failure of the solver. The state is that of the failing substep.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SolverError {
    /// A particle has a position or velocity that is not finite, or an excessive speed.
    Diverged {
        /// Stage after which it was detected.
        stage: &'static str,
        /// Substep since the start.
        step: u64,
        /// Simulated time [s].
        time: f64,
        /// Stable id of the particle.
        particle: u32,
        /// Name of its material.
        material: String,
        /// Description of the error.
        what: String,
    },
}

impl fmt::Display for SolverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SolverError::Diverged { stage, step, time, particle, material, what } => write!(
                f,
                "diverged at {time:.6} s (substep {step}, after {stage}): particle {particle} of \"{material}\" {what}"
            ),
        }
    }
}

impl std::error::Error for SolverError {}
