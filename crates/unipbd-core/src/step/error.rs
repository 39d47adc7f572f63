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
        /// Simulated time \[s].
        time: f64,
        /// Stable id of the particle.
        particle: u32,
        /// Name of its material.
        material: String,
        /// Description of the error.
        what: String,
    },
    /// A body has a place or a velocity that is not finite.
    Body {
        /// Substep since the start.
        step: u64,
        /// Simulated time \[s].
        time: f64,
        /// Its name.
        body: String,
    },
    /// A hook asked for an acceleration that is not finite or absurd. The run stands before the substep.
    Hook {
        /// Substep since the start.
        step: u64,
        /// Simulated time \[s].
        time: f64,
        /// Stable id of the particle.
        particle: u32,
        /// Name of its material.
        material: String,
        /// Acceleration requested by the hook, all hooks together [m/s^2].
        acceleration: [f64; 2],
        /// The acceleration from which on a run would diverge at once [m/s^2].
        limit: f64,
    },
}

impl fmt::Display for SolverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SolverError::Diverged { stage, step, time, particle, material, what } => write!(
                f,
                "diverged at {time:.6} s (substep {step}, after {stage}): particle {particle} of \"{material}\" {what}"
            ),
            SolverError::Body { step, time, body } => write!(
                f,
                "diverged at {time:.6} s (substep {step}): the place or velocity of body \"{body}\" is not finite"
            ),
            SolverError::Hook { step, time, particle, material, acceleration: [x, y], limit } => write!(
                f,
                "a hook accelerates particle {particle} of \"{material}\" by ({x:e}, {y:e}) m/s^2 at {time:.6} s (substep \
                 {step}); the limit is {limit:.3e} m/s^2"
            ),
        }
    }
}

impl std::error::Error for SolverError {}
