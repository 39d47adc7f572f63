//! Where a log goes, and what happens to the file that is already there.
//!
//! | output | there already | written to | replaced |
//! |---|---|---|---|
//! | `<scene>.mcap`, by default | - or a file | `.<scene>.mcap.partial` beside it | when complete |
//! | `-o FILE` | no | `FILE` itself | - |
//! | `-o FILE` | a file | refused without `--force` | - |
//! | `-o FILE --force` | a file | `.FILE.partial` beside it | when complete |
//! | `-o FILE` | a device or a pipe | `FILE` itself | - |
//! | `-o -` | | standard output | - |
//!
//! The scene itself is never an output, by any name. A log that is not complete replaces none: where a run is
//! interrupted or diverges and there is an older log, the new one is left beside it as `FILE.partial.mcap`. After a crash
//! the partial file stays, readable up to its last frame; the next run to the same output starts it anew.

use std::path::{Path, PathBuf};
use std::{fmt, fs, io};

use super::same_file::same_file;

/// Treatment of a file that already exists at the destination of a log.
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
    /// Whether the log goes to standard output.
    to_output: bool,
}

/// A destination that cannot be used.
#[derive(Debug)]
#[non_exhaustive]
pub enum DestinationError {
    /// There is a file already, and it may not be replaced: an error of usage.
    Exists(PathBuf),
    /// The output is the input: an error of usage.
    IsInput(PathBuf),
    /// The file system refuses.
    Io(PathBuf, io::Error),
}

impl fmt::Display for DestinationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DestinationError::Exists(path) => {
                write!(f, "{} exists already: choose another name or add --force", path.display())
            }
            DestinationError::IsInput(path) => f.write_str(&is_input(path)),
            DestinationError::Io(path, cause) => write!(f, "cannot write the log {}: {cause}", path.display()),
        }
    }
}

impl std::error::Error for DestinationError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            DestinationError::Exists(_) | DestinationError::IsInput(_) => None,
            DestinationError::Io(_, cause) => Some(cause),
        }
    }
}

/// The message about an output that would replace its input.
pub fn is_input(path: &Path) -> String {
    format!("{} is the input itself: choose another name for the output", path.display())
}

impl Destination {
    /// Standard output.
    pub fn standard_output() -> Destination {
        let name = PathBuf::from("-");
        Destination { target: name.clone(), written: name, to_output: true }
    }

    /// Whether the log goes to standard output.
    pub fn is_standard_output(&self) -> bool {
        self.to_output
    }

    /// The same, unless it would replace this file.
    pub fn sparing(self, input: &Path) -> Result<Destination, DestinationError> {
        let hit = !self.to_output && (same_file(&self.target, input) || same_file(&self.written, input));
        if hit { Err(DestinationError::IsInput(self.target)) } else { Ok(self) }
    }

    /// A file or a device that is written to as it is.
    fn in_place(path: &Path) -> Destination {
        Destination { target: path.to_owned(), written: path.to_owned(), to_output: false }
    }

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
                return Ok(Destination::in_place(path));
            }
            Err(error) => return Err(DestinationError::Io(path.to_owned(), error)),
        };
        if found.is_dir() {
            let cause = io::Error::new(io::ErrorKind::IsADirectory, "it is a directory");
            return Err(DestinationError::Io(path.to_owned(), cause));
        }
        if !found.is_file() {
            return Ok(Destination::in_place(path));
        }
        if existing == Existing::Refuse {
            return Err(DestinationError::Exists(path.to_owned()));
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
        Ok(Destination { target, written, to_output: false })
    }

    /// Where the log is written to: the path to give to [`Recorder::create`](super::Recorder::create).
    pub fn written(&self) -> &Path {
        &self.written
    }

    /// Where the complete log will be.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Leaves a log that is not complete: in its place where that is free, beside an older log where there is one.
    pub fn leave(mut self) -> Result<PathBuf, DestinationError> {
        if self.written != self.target && self.target.exists() {
            let mut name = self.target.file_stem().unwrap_or_default().to_owned();
            name.push(".partial.mcap");
            self.target.set_file_name(name);
        }
        self.commit()
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
    fn the_input_is_no_destination_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let (scene, hard) = (folder.path().join("scene.toml"), folder.path().join("hard.mcap"));
        fs::write(&scene, "scene").unwrap();
        fs::hard_link(&scene, &hard).unwrap();
        for path in [&scene, &hard, &folder.path().join(".").join("scene.toml")] {
            let destination = Destination::explicit(path, Existing::Replace).unwrap();
            let refused = destination.sparing(&scene).unwrap_err();
            assert!(refused.to_string().contains("is the input itself"), "{refused}");
        }
        assert!(
            Destination::explicit(&folder.path().join("new.mcap"), Existing::Refuse).unwrap().sparing(&scene).is_ok()
        );
    }

    #[test]
    fn a_partial_log_is_left_beside_an_older_one() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("run.mcap");
        let left = |text: &str| {
            let destination = Destination::default_for("run.toml".as_ref(), folder.path()).unwrap();
            fs::write(destination.written(), text).unwrap();
            destination.leave().unwrap()
        };
        assert_eq!(left("first"), target);
        assert_eq!(left("second"), folder.path().join("run.partial.mcap"));
        assert_eq!(left("third"), folder.path().join("run.partial.mcap"));
        assert_eq!(fs::read_to_string(target).unwrap(), "first");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
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
        let device = Destination::explicit("/dev/null".as_ref(), Existing::Refuse).unwrap();
        assert_eq!(device.written(), Path::new("/dev/null"));
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file.mcap"), folder.path().join("link.mcap"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let linked = Destination::explicit(&link, Existing::Replace).unwrap();
        assert_eq!(linked.target(), fs::canonicalize(&file).unwrap());
    }
}
