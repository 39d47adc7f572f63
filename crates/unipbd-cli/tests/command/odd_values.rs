//! Values that are odd, but mean something to users of command lines, or mean nothing and are refused as such.

use std::process::Stdio;

use crate::support::{Ended, Place};

#[test]
fn a_minus_sends_the_log_to_standard_output() {
    let place = Place::new();
    let ended = place.run(&["drop.toml", "-o", "-"]);
    assert_eq!(ended.0.status.code(), Some(0));
    std::fs::write(place.path("piped.mcap"), &ended.0.stdout).unwrap();
    place.run(&["drop.toml", "-q", "-o", "file.mcap"]).exits(0);
    assert_eq!(ended.0.stdout, std::fs::read(place.path("file.mcap")).unwrap(), "the same bytes as in a file");
    assert!(ended.stderr().contains("done at"), "the summary is a message: {}", ended.stderr());
    assert_eq!(place.files(), ["drop.toml", "file.mcap", "piped.mcap"], "no file is called -");
}

#[test]
fn a_log_and_json_do_not_share_standard_output() {
    let ended = Place::new().run(&["drop.toml", "-o", "-", "--json"]).exits(2);
    assert!(ended.stderr().contains("cannot be used together"), "{}", ended.stderr());
    assert_eq!(ended.stdout(), "");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_written_to_as_soon_as_somebody_reads_it() {
    let place = Place::new();
    assert!(std::process::Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    let run = place.start(&["drop.toml", "-q", "-o", "pipe"]).stderr(Stdio::piped()).spawn().unwrap();
    let read = std::fs::read(place.path("pipe")).unwrap();
    Ended(run.wait_with_output().unwrap()).exits(0);
    place.run(&["drop.toml", "-q", "-o", "file.mcap"]).exits(0);
    assert_eq!(read, std::fs::read(place.path("file.mcap")).unwrap());
}

#[cfg(unix)]
#[test]
fn a_run_that_waits_for_a_reader_can_be_ended() {
    let place = Place::new();
    assert!(std::process::Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success());
    let mut run = place.start(&["drop.toml", "-o", "pipe"]).stderr(Stdio::piped()).spawn().unwrap();
    // It says what it waits for.
    let mut said = String::new();
    let mut lines = std::io::BufReader::new(run.stderr.take().unwrap());
    std::io::BufRead::read_line(&mut lines, &mut said).unwrap();
    assert!(said.contains("waiting for somebody to read pipe"), "{said}");
    crate::ending::signal(&run, "-TERM");
    assert!(!run.wait().unwrap().success());
}

#[test]
fn a_device_needs_no_force() {
    if cfg!(unix) {
        Place::new().run(&["drop.toml", "-q", "-o", "/dev/null"]).exits(0);
    }
}

#[test]
fn numbers_out_of_range_are_wrong_arguments() {
    let place = Place::new();
    for (option, value, expected) in [
        ("--seed", "-1", "a whole number from 0 to 9223372036854775807"),
        ("--seed", "9223372036854775808", "a whole number from 0 to"),
        ("--seed", "1.5", "a whole number from 0 to"),
        ("--duration", "0", "positive"),
        ("--duration", "-1", "positive"),
        ("--duration", "1e9", "at most 1000000 s"),
        ("--fps", "1e9", "from 0.001 to 1000000"),
        ("--fps", "0.0005", "from 0.001 to 1000000"),
        ("--fps", "nan", "positive"),
    ] {
        let ended = place.run(&["run", "drop.toml", option, value]).exits(2);
        assert!(ended.stderr().contains(expected), "{option} {value}: {}", ended.stderr());
        assert_eq!(ended.stdout(), "");
    }
    assert_eq!(place.files(), ["drop.toml"]);
}
