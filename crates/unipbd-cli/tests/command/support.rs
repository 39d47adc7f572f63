//! Small scenes and helpers to run the command on them.

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A hundred particles of water that fall in a tank for a fifth of a second.
pub const DROP: &str = r#"
name = "Drop"
spacing = 0.1
duration = 0.2
fps = 50

[solver]
substeps = 4

[[liquid]]
name = "water"

[[block]]
material = "water"
min = [0.0, 0.0]
max = [1.0, 1.0]

[[tank]]
min = [0.0, 0.0]
max = [2.0, 2.0]
open = ["top"]
"#;

/// A directory with `drop.toml` in it.
pub struct Place {
    directory: TempDir,
}

impl Place {
    pub fn new() -> Self {
        let place = Place { directory: tempfile::tempdir().unwrap() };
        place.write("drop.toml", DROP);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Names of the files here, sorted.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command with these arguments, in this directory.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::cargo_bin("unipbd").unwrap();
        command.args(arguments).current_dir(self.directory.path()).env_remove("UNIPBD_THREADS");
        command
    }

    /// Runs the command to its end.
    pub fn run(&self, arguments: &[&str]) -> Ended {
        Ended(self.command(arguments).output().unwrap())
    }

    /// The command as a child that can be signalled.
    pub fn start(&self, arguments: &[&str]) -> std::process::Command {
        let mut command = std::process::Command::new(binary());
        command.args(arguments).current_dir(self.directory.path()).env_remove("UNIPBD_THREADS");
        command
    }
}

fn binary() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_unipbd"))
}

/// A command that has ended.
pub struct Ended(pub Output);

impl Ended {
    #[track_caller]
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.0.status.code(), Some(code), "stdout:\n{}\nstderr:\n{}", self.stdout(), self.stderr());
        assert!(!self.stderr().contains("panicked"), "{}", self.stderr());
        self
    }

    pub fn stdout(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    pub fn stderr(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }

    /// Standard output as JSON, one object a line.
    #[track_caller]
    pub fn objects(&self) -> Vec<Value> {
        self.stdout().lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
    }

    /// The last object.
    #[track_caller]
    pub fn object(&self) -> Value {
        self.objects().pop().expect("there is an object")
    }

    /// The last object, which has to be the summary.
    #[track_caller]
    pub fn summary(&self) -> Value {
        let summary = self.objects().pop().expect("there is a summary");
        assert_eq!(summary["type"], "summary");
        summary
    }
}
