//! Where the log goes, and that nothing is lost by it.

use crate::support::Place;

#[test]
fn the_default_log_is_named_after_the_scene_and_lies_in_the_current_directory() {
    let place = Place::new();
    std::fs::create_dir(place.path("elsewhere")).unwrap();
    let scene = place.path("drop.toml");
    let mut command = place.command(&["run", scene.to_str().unwrap(), "-q"]);
    command.current_dir(place.path("elsewhere")).assert().code(0);
    assert!(place.path("elsewhere/drop.mcap").exists());
    assert_eq!(place.files(), ["drop.toml", "elsewhere"]);
}

#[test]
fn the_default_log_is_replaced_by_a_complete_one() {
    let place = Place::new();
    place.write("drop.mcap", "an old log");
    let summary = place.run(&["drop.toml", "--json"]).exits(0).summary();
    assert_eq!(summary["log"]["bytes"].as_u64().unwrap(), place.path("drop.mcap").metadata().unwrap().len());
    assert_eq!(place.files(), ["drop.mcap", "drop.toml"]);
}

#[test]
fn an_invalid_scene_leaves_an_older_log_alone() {
    let place = Place::new();
    place.write("drop.mcap", "an old log");
    place.run(&["drop.toml", "--set", "spacing=-1"]).exits(3);
    assert_eq!(std::fs::read_to_string(place.path("drop.mcap")).unwrap(), "an old log");
}

#[test]
fn an_existing_output_needs_force() {
    let place = Place::new();
    place.write("mine.mcap", "precious");
    let ended = place.run(&["drop.toml", "-o", "mine.mcap"]).exits(2);
    assert!(ended.stderr().contains("--force"), "{}", ended.stderr());
    assert_eq!(ended.stdout(), "");
    assert_eq!(std::fs::read_to_string(place.path("mine.mcap")).unwrap(), "precious");
    place.run(&["drop.toml", "-q", "-o", "mine.mcap", "--force"]).exits(0);
    place.run(&["info", "mine.mcap"]).exits(0);
}

#[test]
fn an_output_in_a_directory_that_is_absent_exits_1() {
    let ended = Place::new().run(&["drop.toml", "-o", "absent/a.mcap"]).exits(1);
    assert!(ended.stderr().contains("absent"), "{}", ended.stderr());
}

#[test]
fn no_record_writes_no_file_and_changes_no_result() {
    let place = Place::new();
    let without = place.run(&["drop.toml", "--json", "--no-record"]).exits(0).summary();
    assert_eq!(place.files(), ["drop.toml"]);
    let with = place.run(&["drop.toml", "--json", "--fields", "all"]).exits(0).summary();
    assert_eq!(without["state_hash"], with["state_hash"]);
}

#[test]
fn logs_have_the_same_bytes_whatever_their_name_and_the_threads() {
    let place = Place::new();
    place.run(&["drop.toml", "-q", "-o", "one.mcap", "--threads", "1"]).exits(0);
    place.run(&["drop.toml", "-q", "-o", "other.mcap", "--threads", "3"]).exits(0);
    assert_eq!(std::fs::read(place.path("one.mcap")).unwrap(), std::fs::read(place.path("other.mcap")).unwrap());
}

#[test]
fn info_describes_a_log() {
    let place = Place::new();
    place.run(&["drop.toml", "-q", "--fields", "velocity,density", "--set", "seed=7"]).exits(0);
    let text = place.run(&["info", "drop.mcap"]).exits(0).stdout();
    for word in ["Drop", "11 frames", "0.2", "water", "/particles", "/diagnostics", "velocity", "seed=7"] {
        assert!(text.contains(word), "{word} is missing from:\n{text}");
    }
    let object = place.run(&["info", "drop.mcap", "--json"]).exits(0).objects().remove(0);
    assert_eq!((&object["type"], &object["frames"]), (&"log".into(), &11.into()));
    assert_eq!(object["last"]["counts"]["liquid"], 100);
}

#[test]
fn a_file_that_is_no_log_exits_1() {
    let place = Place::new();
    place.write("text.mcap", "not a log at all");
    let ended = place.run(&["info", "text.mcap"]).exits(1);
    assert!(ended.stderr().contains("text.mcap"), "{}", ended.stderr());
}
