//! What a live run does for the one who started it.

use serde_json::Value;

use crate::client::{Heard, Run, Viewer, command};

fn summary(text: &str) -> Value {
    serde_json::from_str(text.lines().last().unwrap_or_default()).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_viewer_that_only_watches_changes_no_bit_of_the_run() {
    let run = Run::start(&["--duration", "0.4", "--speed", "0", "--paused", "--no-record", "--json"]);
    let mut viewer = Viewer::connect(&run.url);
    viewer.subscribe(&["/particles", "/particles/columns", "/diagnostics", "/scene", "/tf", "/bodies", "/log"]);
    viewer.control(0, 0.0);
    while !matches!(viewer.hear(), Heard::Playback { status: 3, .. }) {}
    let alone = command(&run, &["run", "live.toml", "--duration", "0.4", "--no-record", "--json"]);
    drop(viewer);
    let (code, text, errors) = run.end();
    assert_eq!(code, Some(0), "{errors}");
    let alone = summary(&String::from_utf8(alone.stdout).unwrap());
    assert_eq!(summary(&text)["state_hash"], alone["state_hash"]);
    assert_eq!(summary(&text)["outcome"], "completed");
}

#[test]
fn without_viewers_a_live_run_ends_like_any_other() {
    let run = Run::start(&["--duration", "0.1", "--speed", "0", "--json", "--no-record"]);
    let (code, text, _) = run.end();
    assert_eq!((code, &summary(&text)["frames"]), (Some(0), &Value::from(5)));
}

#[cfg(unix)]
#[test]
fn a_signal_closes_a_paused_run_and_its_viewers_hear_it() {
    let mut run = Run::start(&["--paused"]);
    let mut viewer = Viewer::connect(&run.url);
    assert_eq!(viewer.step(2)["frame"], 2);
    run.interrupt();
    assert!(viewer.closes());
    let (code, _, errors) = run.end();
    assert_eq!(code, Some(143), "{errors}");
}

#[test]
fn an_address_in_use_is_an_error_that_names_it() {
    let run = Run::start(&["--paused", "--no-record"]);
    let address = run.url.trim_start_matches("ws://").to_owned();
    let second = command(&run, &["run", "live.toml", "--live", &address, "--duration", "0.1"]);
    let message = String::from_utf8(second.stderr).unwrap();
    assert_eq!(second.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot listen at") && message.contains(&address), "{message}");
    assert!(!run.folder.path().join("live.mcap").exists());
}

#[test]
fn wrong_addresses_and_paces_are_refused_with_what_is_expected() {
    let run = Run::start(&["--paused", "--no-record"]);
    for (arguments, expected) in [
        (&["run", "--live", "live.toml"][..], "put --live behind the scene"),
        (&["run", "live.toml", "--live", "nowhere"], "HOST:PORT"),
        (&["run", "live.toml", "--live", "--speed", "-2"], "as fast as it can"),
        (&["run", "live.toml", "--speed", "2"], "--live"),
    ] {
        let refused = command(&run, arguments);
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}");
    }
}
