use std::fmt;

/// Why an edit was refused. Nothing has changed then.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum EditError {
    /// No particle has this id.
    UnknownId(u32),
    /// An id is given twice for the same change.
    RepeatedId(u32),
    /// There must be one value for each id, or each new particle.
    Lengths {
        /// Name of the values.
        what: &'static str,
        /// Number of particles.
        particles: usize,
        /// Number of values.
        values: usize,
    },
    /// A value cannot be used.
    Value {
        /// Kind of the value: a position, a velocity...
        what: &'static str,
        /// Place in the values given.
        index: usize,
        /// Fault of the value.
        reason: String,
    },
    /// The scene has no material of this name.
    UnknownMaterial {
        /// The name given.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// The material's particles do not support the change.
    Unfit(String),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EditError::UnknownId(id) => write!(f, "there is no particle with id {id}"),
            EditError::RepeatedId(id) => write!(f, "the id {id} is given twice"),
            EditError::Lengths { what, particles, values } => {
                write!(f, "{values} {what} are given for {particles} particles")
            }
            EditError::Value { what, index, reason } => write!(f, "{what} {index} {reason}"),
            EditError::UnknownMaterial { name, known } => {
                write!(f, "there is no material \"{name}\"; the materials are {known:?}")
            }
            EditError::Unfit(reason) => f.write_str(reason),
        }
    }
}

impl std::error::Error for EditError {}

pub(super) fn unfit<T>(reason: impl Into<String>) -> Result<T, EditError> {
    Err(EditError::Unfit(reason.into()))
}
