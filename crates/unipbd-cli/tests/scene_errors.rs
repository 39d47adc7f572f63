//! Faulty scene files and the messages they get: each `scene_errors/*.toml` has its message beside
//! it. `UPDATE_MESSAGES=1 cargo test --test scene_errors` writes the messages anew; read them.
//!
//! A line `# --set key=value` in a case is an override.

use std::fs;
use std::path::{Path, PathBuf};

use unipbd_cli::scene_file::{self, Override, SceneFileError};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene_errors")
}

fn cases() -> Vec<PathBuf> {
    let entries = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let mut cases: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    cases.sort();
    cases
}

fn overrides_in(case: &Path) -> Vec<Override> {
    let text = String::from_utf8_lossy(&fs::read(case).unwrap()).into_owned();
    text.lines().filter_map(|line| line.strip_prefix("# --set ")).map(|change| change.parse().unwrap()).collect()
}

/// The message for a case, with the folder taken out.
fn message(case: &Path) -> String {
    let error = scene_file::load(case, &overrides_in(case)).expect_err(&format!("{} is faulty", case.display()));
    assert!(matches!(error, SceneFileError::Invalid { .. }), "{}: {error}", case.display());
    error.to_string().replace(&format!("{}/", folder().display()), "")
}

#[test]
fn every_faulty_scene_gets_its_message() {
    let cases = cases();
    assert!(cases.len() >= 45, "only {} cases", cases.len());
    let mut differing = Vec::new();
    for case in &cases {
        let (expected, message) = (case.with_extension("txt"), message(case));
        if std::env::var_os("UPDATE_MESSAGES").is_some() {
            fs::write(&expected, &message).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != message {
            differing.push(format!("{}:\n{message}", case.display()));
        }
    }
    assert!(differing.is_empty(), "messages differ:\n{}", differing.join("\n"));
}

#[test]
fn every_problem_has_a_place_inside_its_line() {
    for case in cases() {
        let error = scene_file::load(&case, &overrides_in(&case)).unwrap_err();
        for problem in error.problems() {
            let length = problem.source_line.chars().count();
            assert!(problem.caret.start <= length && problem.caret.end <= length, "{problem}");
            assert_eq!(problem.column, problem.caret.start + 1, "{problem}");
        }
    }
}
