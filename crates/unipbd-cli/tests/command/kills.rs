//! Runs that are killed at any moment: every log can be read.
#![cfg(unix)]

use std::process::Stdio;
use std::time::Duration;

use crate::ending::signal;
use crate::support::Place;

/// Kills, without `UNIPBD_KILLS`.
const USUAL: u64 = 6;

#[test]
fn a_log_is_readable_whenever_its_run_is_killed() {
    let kills = std::env::var("UNIPBD_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(USUAL);
    let (mut readable, mut empty) = (0, 0);
    for kill in 0..kills {
        let place = Place::new();
        let mut child = place
            .start(&["drop.toml", "-q", "--duration", "3000", "-o", "run.mcap", "--fields", "all"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Moments between the start of the process and a few hundred frames, spread by the golden ratio.
        let share = (kill as f64 * 0.618_033_988_75).fract();
        std::thread::sleep(Duration::from_micros((share * share * 1e6) as u64));
        signal(&child, "-KILL");
        child.wait().unwrap();
        let size = place.path("run.mcap").metadata().map_or(0, |metadata| metadata.len());
        if size == 0 {
            empty += 1;
            continue;
        }
        let ended = place.run(&["info", "run.mcap", "--json"]);
        if ended.0.status.success() {
            assert_eq!(ended.objects()[0]["truncated"], true);
            readable += 1;
        } else {
            // Killed before the first frame was out.
            assert!(ended.stderr().contains("ends before its first frame") || size < 8, "{}", ended.stderr());
            empty += 1;
        }
    }
    println!("{kills} kills: {readable} logs read, {empty} without a frame");
    assert!(readable > 0, "no run got as far as a frame");
}
