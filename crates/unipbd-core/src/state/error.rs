use std::fmt;

use crate::bytes::Damage;

/// Reasons why a state was rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StateError {
    /// The bytes are not a saved state.
    NotAState,
    /// Written by another version of the format.
    Version {
        /// Version of the bytes.
        found: u32,
        /// Version that can be read.
        expected: u32,
    },
    /// Truncated, altered, or inconsistent.
    Damaged(String),
    /// Saved from a scene that is built differently.
    OtherScene {
        /// Value in the state.
        saved: String,
        /// Value in the run.
        running: String,
    },
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StateError::NotAState => f.write_str("not a saved state of unipbd"),
            StateError::Version { found, expected } => {
                write!(f, "the state has format version {found}, this version of unipbd reads version {expected}")
            }
            StateError::Damaged(what) => write!(f, "the saved state is damaged: {what}"),
            StateError::OtherScene { saved, running } => {
                write!(f, "the state is of another scene: it has {saved}, this run has {running}")
            }
        }
    }
}

impl std::error::Error for StateError {}

impl From<Damage> for StateError {
    fn from(damage: Damage) -> Self {
        StateError::Damaged(damage.0.to_owned())
    }
}

pub(super) fn damaged(what: &str) -> StateError {
    StateError::Damaged(what.to_owned())
}
