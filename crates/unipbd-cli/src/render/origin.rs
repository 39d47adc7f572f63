use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Beginning of the mark in a file.
const MARK: &str = "unipbd-run:";
/// A mark lies in the first or in the last bytes of a file, so many of them.
const SEARCHED: u64 = 64 * 1024;

/// The run that a picture shows. Pictures carry it as a mark, so that one may be made anew from the same run without
/// more ado: PNG, SVG, PDF, GIF and HTML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin(String);

impl Origin {
    /// The run with this name: hexadecimal digits, the same for the same run only.
    pub fn new(name: &str) -> Origin {
        Origin(format!("{MARK}{name}"))
    }

    /// The mark.
    pub(super) fn mark(&self) -> &str {
        &self.0
    }

    /// Whether a file carries the mark: it was made from this run. No if it cannot be read.
    pub fn made(&self, path: &Path) -> bool {
        let both_ends = || -> std::io::Result<[Vec<u8>; 2]> {
            let mut file = File::open(path)?;
            let mut ends = [Vec::new(), Vec::new()];
            let length = file.metadata()?.len();
            (&mut file).take(SEARCHED).read_to_end(&mut ends[0])?;
            file.seek(SeekFrom::Start(length.saturating_sub(SEARCHED)))?;
            file.take(SEARCHED).read_to_end(&mut ends[1])?;
            Ok(ends)
        };
        let mark = self.0.as_bytes();
        // A folder or a pipe is no picture, and a pipe would not let go.
        let is_file = path.metadata().is_ok_and(|found| found.is_file());
        is_file && both_ends().is_ok_and(|ends| ends.iter().any(|end| end.windows(mark.len()).any(|part| part == mark)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_found_at_both_ends_of_a_file_and_another_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let origin = Origin::new("12ab");
        let far = vec![b'x'; 2 * SEARCHED as usize];
        for text in [[origin.mark().as_bytes(), &far].concat(), [&far, origin.mark().as_bytes()].concat()] {
            std::fs::write(&path, text).unwrap();
            assert!(origin.made(&path));
            assert!(!Origin::new("34cd").made(&path));
        }
        assert!(!origin.made(folder.path()) && !origin.made(&folder.path().join("none")));
    }
}
