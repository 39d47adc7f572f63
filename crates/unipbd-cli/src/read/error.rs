use std::path::{Path, PathBuf};
use std::{fmt, io};

use crate::record::LOG_FORMAT;

/// A log that cannot be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum LogError {
    /// The file cannot be read.
    Io(PathBuf, io::Error),
    /// The file is something else.
    Foreign(PathBuf, String),
    /// The file is a log of a format that is newer than this reader.
    Newer {
        /// The file.
        path: PathBuf,
        /// Version of its format.
        format: u32,
        /// Version of unipbd that wrote it.
        version: String,
    },
    /// The file is a log with wrong bytes in it.
    Damaged(PathBuf, String),
}

impl LogError {
    pub(crate) fn io(path: &Path, cause: io::Error) -> Self {
        LogError::Io(path.to_owned(), cause)
    }

    pub(crate) fn foreign(path: &Path, reason: impl Into<String>) -> Self {
        LogError::Foreign(path.to_owned(), reason.into())
    }

    pub(crate) fn damaged(path: &Path, reason: impl Into<String>) -> Self {
        LogError::Damaged(path.to_owned(), reason.into())
    }
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LogError::Io(path, cause) => write!(f, "cannot read the log {}: {cause}", path.display()),
            LogError::Foreign(path, reason) => write!(f, "{} is not a unipbd log: {reason}", path.display()),
            LogError::Newer { path, format, version } => write!(
                f,
                "the log {} has format {format}, written by unipbd {}; this unipbd reads formats up to {LOG_FORMAT}",
                path.display(),
                version.escape_debug()
            ),
            LogError::Damaged(path, reason) => write!(f, "the log {} is damaged: {reason}", path.display()),
        }
    }
}

impl std::error::Error for LogError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            LogError::Io(_, cause) => Some(cause),
            LogError::Foreign(..) | LogError::Newer { .. } | LogError::Damaged(..) => None,
        }
    }
}
