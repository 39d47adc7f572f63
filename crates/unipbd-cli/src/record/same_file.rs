//! Whether two paths lead to one file.

use std::fs;
use std::path::Path;

/// Whether both are there and are one file, by another name or by a link too.
pub fn same_file(one: &Path, other: &Path) -> bool {
    let (Ok(first), Ok(second)) = (fs::canonicalize(one), fs::canonicalize(other)) else { return false };
    first == second || hard_linked(&first, &second)
}

#[cfg(unix)]
fn hard_linked(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |path: &Path| path.metadata().ok().map(|found| (found.dev(), found.ino()));
    place(one).is_some_and(|found| place(other) == Some(found))
}

#[cfg(not(unix))]
fn hard_linked(_: &Path, _: &Path) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_itself_under_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let (file, other) = (folder.path().join("file"), folder.path().join("other"));
        fs::write(&file, "a").unwrap();
        fs::write(&other, "a").unwrap();
        assert!(same_file(&file, &folder.path().join(".").join("file")));
        assert!(!same_file(&file, &other) && !same_file(&file, &folder.path().join("absent")));
        let link = folder.path().join("link");
        fs::hard_link(&file, &link).unwrap();
        assert!(!cfg!(unix) || same_file(&file, &link));
    }
}
