use std::path::{Path, PathBuf};
use std::{fmt, io};

/// A log that cannot be written.
#[derive(Debug)]
pub struct RecordError {
    /// The file being written.
    pub path: PathBuf,
    /// Why it cannot be written.
    pub cause: io::Error,
}

impl RecordError {
    pub(crate) fn new(path: &Path, cause: impl Into<io::Error>) -> Self {
        RecordError { path: path.to_owned(), cause: cause.into() }
    }

    pub(crate) fn from_mcap(path: &Path, error: mcap::McapError) -> Self {
        RecordError::new(path, mcap_cause(error))
    }
}

/// The operating system's error where there is one: it says more than the error around it.
pub(crate) fn mcap_cause(error: mcap::McapError) -> io::Error {
    match error {
        mcap::McapError::Io(cause) => cause,
        other => io::Error::other(other),
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write the log {}: {}", self.path.display(), self.cause)
    }
}

impl std::error::Error for RecordError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}
