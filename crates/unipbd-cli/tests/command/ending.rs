//! Runs that end early: conditions, divergence, Ctrl-C.

use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use crate::support::{Ended, Place};

/// Waits until the child has finished a few frames.
pub fn wait_for_frames(place: &Place, child: &mut Child) {
    let start = Instant::now();
    let grown = || {
        place
            .files()
            .iter()
            .any(|name| name.contains(".mcap") && place.path(name).metadata().is_ok_and(|m| m.len() > 20_000))
    };
    while !grown() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended by itself");
        assert!(start.elapsed() < Duration::from_secs(60), "no frames in a minute: {:?}", place.files());
        std::thread::sleep(Duration::from_millis(20));
    }
}

pub fn signal(child: &Child, name: &str) {
    let status = std::process::Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

#[test]
fn a_condition_that_is_met_ends_the_run_with_5_and_keeps_the_log() {
    let place = Place::new();
    let arguments = ["drop.toml", "--json", "--stop-on", "density_error>10", "--stop-on", "time>0.09"];
    let ended = place.run(&arguments).exits(5);
    let summary = ended.summary();
    assert_eq!((&summary["outcome"], &summary["frames"]), (&"condition_met".into(), &5.into()));
    assert!(summary["message"].as_str().unwrap().contains("time>0.09"));
    assert_eq!(summary["log"]["path"], "drop.mcap");
    place.run(&["info", "drop.mcap"]).exits(0);
}

#[test]
fn a_condition_may_hold_at_the_start_but_counts_after_a_frame() {
    let summary =
        Place::new().run(&["drop.toml", "--json", "--no-record", "--stop-on", "speed<1000"]).exits(5).summary();
    assert_eq!(summary["frames"], 1);
}

#[test]
fn a_run_that_diverges_exits_4_and_keeps_its_log() {
    let place = Place::new();
    let ended = place.run(&["drop.toml", "--json", "--set", "gravity=[0.0, 1e9]"]).exits(4);
    assert_eq!(ended.summary()["outcome"], "diverged");
    assert!(ended.stderr().contains("diverged at"), "{}", ended.stderr());
    assert_eq!(place.files(), ["drop.mcap", "drop.toml"]);
    place.run(&["info", "drop.mcap"]).exits(0);
}

/// Whether a signal of this number is ignored here, as in the background jobs of a script: what is started here ignores
/// it too.
#[cfg(unix)]
fn ignores(signal: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> (signal - 1) & 1 != 0)
}

/// How a run ends by a signal; `None` where this process ignores it.
#[cfg(unix)]
pub fn ends_with(name: &str, number: u32, code: i32) -> Option<Ended> {
    if ignores(number) {
        println!("skipped: this process ignores {name}");
        return None;
    }
    let place = Place::new();
    let mut child = place
        .start(&["drop.toml", "--json", "--duration", "3000"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for_frames(&place, &mut child);
    signal(&child, name);
    let ended = Ended(child.wait_with_output().unwrap()).exits(code);
    assert_eq!(place.files(), ["drop.mcap", "drop.toml"], "the log has its final name");
    let log = place.run(&["info", "drop.mcap", "--json"]).exits(0).objects().remove(0);
    assert_eq!(log["truncated"], false, "{log}");
    assert!(log["frames"].as_u64().unwrap() > 1, "{log}");
    Some(ended)
}

#[cfg(unix)]
#[test]
fn ctrl_c_finishes_the_frame_closes_the_log_and_exits_130() {
    let Some(ended) = ends_with("-INT", 2, 130) else { return };
    assert!(ended.stderr().contains("interrupted"), "{}", ended.stderr());
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_a_log_that_reads_up_to_its_last_flush() {
    let place = Place::new();
    let mut child = place
        .start(&["drop.toml", "-q", "--duration", "3000"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_frames(&place, &mut child);
    signal(&child, "-KILL");
    child.wait().unwrap();
    let left = place.files().into_iter().find(|name| name.contains("mcap")).expect("a partial log");
    std::fs::rename(place.path(&left), place.path("rescued.mcap")).unwrap();
    let log = place.run(&["info", "rescued.mcap", "--json"]).exits(0).objects().remove(0);
    assert!(log["frames"].as_u64().unwrap() > 1, "{log}");
    assert!(log["duration"].as_f64().unwrap() > 0.0, "{log}");
}
