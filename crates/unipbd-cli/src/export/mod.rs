//! Logs as files that pandas, NumPy and ParaView read.
//!
//! Parquet is behind the feature `parquet`, which is on by default.

mod csv;
mod npz;
#[cfg(feature = "parquet")]
mod parquet;
mod vtk;

use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use crate::read::Frame;

pub use csv::Csv;
pub use npz::Npz;
#[cfg(feature = "parquet")]
pub use parquet::Parquet;
pub use vtk::Vtk;

/// Takes the frames of a log one by one.
pub trait Exporter {
    /// Adds a frame with its number in the log.
    fn add(&mut self, number: u64, frame: &Frame) -> Result<(), ExportError>;

    /// Completes the files; their paths.
    fn finish(self: Box<Self>) -> Result<Vec<PathBuf>, ExportError>;
}

/// Files that cannot be written.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExportError {
    /// A file is there already and may not be replaced.
    Exists(PathBuf),
    /// The file system refuses.
    Write(PathBuf, io::Error),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ExportError::Exists(path) => {
                write!(f, "{} exists already: choose another name or add --force", path.display())
            }
            ExportError::Write(path, cause) => write!(f, "cannot write {}: {cause}", path.display()),
        }
    }
}

impl std::error::Error for ExportError {}

/// The column of a gauge in tables that hold the diagnostics too.
fn gauge_column(name: &str) -> String {
    format!("gauge_{name}")
}

/// An error of the file system, with the file.
fn at(path: &Path) -> impl FnOnce(io::Error) -> ExportError {
    let path = path.to_owned();
    move |cause| ExportError::Write(path, cause)
}

/// Makes the folder of an export; each of these files must be new unless it may be replaced.
fn prepare_folder(folder: &Path, names: &[&str], replace: bool) -> Result<(), ExportError> {
    fs::create_dir_all(folder).map_err(at(folder))?;
    let paths = names.iter().map(|name| folder.join(name));
    match paths.into_iter().find(|path| !replace && path.symlink_metadata().is_ok()) {
        Some(path) => Err(ExportError::Exists(path)),
        None => Ok(()),
    }
}
