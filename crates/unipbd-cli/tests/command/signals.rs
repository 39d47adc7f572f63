//! Signals that ask for an end: the frame is finished, the log closed, the exit code 128 and the signal's number.
#![cfg(unix)]

use crate::ending::{ends_with, signal, wait_for_frames};
use crate::support::Place;

#[test]
fn sigterm_closes_the_log_and_exits_143() {
    ends_with("-TERM", 15, 143);
}

#[test]
fn sighup_closes_the_log_and_exits_129() {
    ends_with("-HUP", 1, 129);
}

#[test]
fn under_nohup_a_closed_terminal_changes_nothing() {
    let place = Place::new();
    let command = format!("trap '' HUP; exec {} drop.toml -q --duration 3000", env!("CARGO_BIN_EXE_unipbd"));
    let mut shell = std::process::Command::new("sh");
    let mut child = shell.args(["-c", &command]).current_dir(place.path(".")).spawn().unwrap();
    wait_for_frames(&place, &mut child);
    signal(&child, "-HUP");
    wait_for_frames(&place, &mut child);
    assert!(child.try_wait().unwrap().is_none() || !cfg!(target_os = "linux"));
    signal(&child, "-KILL");
    child.wait().unwrap();
}
