//! A log of a run that did not come to its end never takes the place of a complete one.

use crate::support::Place;

#[test]
fn a_diverged_run_leaves_its_log_beside_the_older_one() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let before = std::fs::read(place.path("drop.mcap")).unwrap();
    let ended = place.run(&["drop.toml", "--json", "--set", "gravity=[0.0, 1e9]"]).exits(4);
    assert_eq!(ended.summary()["log"]["path"], "drop.partial.mcap");
    assert!(ended.stderr().contains("drop.mcap stays"), "{}", ended.stderr());
    assert_eq!(std::fs::read(place.path("drop.mcap")).unwrap(), before);
    place.run(&["info", "drop.partial.mcap"]).exits(0);
    assert_eq!(place.files(), ["drop.mcap", "drop.partial.mcap", "drop.toml"]);
}

#[test]
fn the_same_holds_for_an_output_that_was_named() {
    let place = Place::new();
    place.write("mine.mcap", "precious");
    place.run(&["drop.toml", "-q", "-o", "mine.mcap", "--force", "--set", "gravity=[0.0, 1e9]"]).exits(4);
    assert_eq!(std::fs::read_to_string(place.path("mine.mcap")).unwrap(), "precious");
    place.run(&["info", "mine.partial.mcap"]).exits(0);
}

#[cfg(unix)]
#[test]
fn a_run_whose_output_breaks_leaves_the_older_log_alone() {
    let place = Place::new();
    place.write("drop.mcap", "precious");
    let mut child = place
        .start(&["drop.toml", "--json", "--duration", "60"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    crate::support::Ended(child.wait_with_output().unwrap()).exits(141);
    assert_eq!(std::fs::read_to_string(place.path("drop.mcap")).unwrap(), "precious");
    place.run(&["info", "drop.partial.mcap"]).exits(0);
}

#[test]
fn a_run_that_met_its_condition_is_complete() {
    let place = Place::new();
    place.write("drop.mcap", "an old log");
    place.run(&["drop.toml", "-q", "--stop-on", "time>0.09"]).exits(5);
    place.run(&["info", "drop.mcap"]).exits(0);
    assert_eq!(place.files(), ["drop.mcap", "drop.toml"]);
}
