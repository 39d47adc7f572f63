//! Where a log goes, and what happens to the file that is already there.
//!
//! | output | there already | written to | replaced |
//! |---|---|---|---|
//! | `<scene>.mcap`, by default | - or a file | `.<scene>.mcap.partial` beside it | when complete |
//! | `-o FILE` | no | `FILE` itself | - |
//! | `-o FILE` | a file | refused without `--force` | - |
//! | `-o FILE --force` | a file | `.FILE.partial` beside it | when complete |
//! | `-o FILE --force` | a device or a pipe | `FILE` itself | - |
//!
//! After a crash the partial file stays, readable up to its last frame; the next run to the same
//! output starts it anew.

use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

/// What to do with a file that is already where a log shall go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// Leave it and report an error.
    Refuse,
    /// Replace it when the new log is complete.
    Replace,
}

/// Where a log goes and where it is until it is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    target: PathBuf,
    written: PathBuf,
}

/// A destination that cannot be used.
#[derive(Debug)]
#[non_exhaustive]
pub enum DestinationError {
    /// There is a file already, and it may not be replaced: an error of usage.
    Exists(PathBuf),
    /// The file system refuses.
    Io(PathBuf, io::Error),
}

impl fmt::Display for DestinationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DestinationError::Exists(path) => {
                write!(f, "{} exists already: choose another name or add --force", path.display())
            }
            DestinationError::Io(path, cause) => write!(f, "cannot write the log {}: {cause}", path.display()),
        }
    }
}

impl std::error::Error for DestinationError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            DestinationError::Exists(_) => None,
            DestinationError::Io(_, cause) => Some(cause),
        }
    }
}

impl Destination {
    /// The default: `<scene>.mcap` in `directory`, replaced when the new log is complete.
    pub fn default_for(scene: &Path, directory: &Path) -> Result<Destination, DestinationError> {
        let stem = scene.file_stem().unwrap_or("scene".as_ref());
        let mut name = stem.to_owned();
        name.push(".mcap");
        Destination::beside(directory.join(name))
    }

    /// A path the user named.
    pub fn explicit(path: &Path, existing: Existing) -> Result<Destination, DestinationError> {
        let found = match fs::metadata(path) {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(Destination { target: path.to_owned(), written: path.to_owned() });
            }
            Err(error) => return Err(DestinationError::Io(path.to_owned(), error)),
        };
        if found.is_dir() {
            let cause = io::Error::new(io::ErrorKind::IsADirectory, "it is a directory");
            return Err(DestinationError::Io(path.to_owned(), cause));
        }
        if existing == Existing::Refuse {
            return Err(DestinationError::Exists(path.to_owned()));
        }
        if !found.is_file() {
            return Ok(Destination { target: path.to_owned(), written: path.to_owned() });
        }
        // A link stays a link: what it points to is replaced.
        let target = fs::canonicalize(path).map_err(|error| DestinationError::Io(path.to_owned(), error))?;
        Destination::beside(target)
    }

    fn beside(target: PathBuf) -> Result<Destination, DestinationError> {
        let Some(name) = target.file_name() else {
            let cause = io::Error::new(io::ErrorKind::InvalidInput, "it names no file");
            return Err(DestinationError::Io(target, cause));
        };
        let mut partial = std::ffi::OsString::from(".");
        partial.push(name);
        partial.push(".partial");
        let written = target.with_file_name(partial);
        Ok(Destination { target, written })
    }

    /// Where the log is written to: the path to give to [`Recorder::create`](super::Recorder::create).
    pub fn written(&self) -> &Path {
        &self.written
    }

    /// Where the complete log will be.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Puts the complete log in its place.
    pub fn commit(self) -> Result<PathBuf, DestinationError> {
        if self.written != self.target {
            fs::rename(&self.written, &self.target)
                .map_err(|error| DestinationError::Io(self.target.clone(), error))?;
        }
        Ok(self.target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_output_replaces_the_old_log_only_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let old = folder.path().join("plume.mcap");
        fs::write(&old, "old").unwrap();
        let destination = Destination::default_for("scenes/plume.toml".as_ref(), folder.path()).unwrap();
        assert_eq!(destination.written(), folder.path().join(".plume.mcap.partial"));
        fs::write(destination.written(), "new").unwrap();
        assert_eq!(fs::read_to_string(&old).unwrap(), "old");
        assert_eq!(destination.commit().unwrap(), old);
        assert_eq!(fs::read_to_string(&old).unwrap(), "new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_new_file_the_user_named_is_written_in_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        let destination = Destination::explicit(&path, Existing::Refuse).unwrap();
        assert_eq!(destination.written(), path);
    }

    #[test]
    fn an_existing_file_the_user_named_is_refused_or_replaced_when_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.mcap");
        fs::write(&path, "old").unwrap();
        let refused = Destination::explicit(&path, Existing::Refuse).unwrap_err();
        assert!(matches!(refused, DestinationError::Exists(_)));
        assert!(refused.to_string().contains("run.mcap exists already"), "{refused}");
        let forced = Destination::explicit(&path, Existing::Replace).unwrap();
        assert!(forced.written().ends_with(".run.mcap.partial"));
    }

    #[test]
    fn directories_are_no_destination() {
        let folder = tempfile::tempdir().unwrap();
        let refused = Destination::explicit(folder.path(), Existing::Replace).unwrap_err();
        assert!(matches!(refused, DestinationError::Io(..)), "{refused}");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_written_in_place_and_links_are_followed() {
        let device = Destination::explicit("/dev/null".as_ref(), Existing::Replace).unwrap();
        assert_eq!(device.written(), Path::new("/dev/null"));
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file.mcap"), folder.path().join("link.mcap"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let linked = Destination::explicit(&link, Existing::Replace).unwrap();
        assert_eq!(linked.target(), fs::canonicalize(&file).unwrap());
    }
}
