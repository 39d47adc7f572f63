//! Arguments that are understood, and arguments that are refused.

use crate::support::Place;

#[test]
fn help_names_every_command_and_exit_code() {
    let help = Place::new().run(&["--help"]).exits(0).stdout();
    for word in ["run", "check", "info", "render", "schema", "--quiet", "--verbose", "--json", "UNIPBD_THREADS"] {
        assert!(help.contains(word), "{word} is missing from:\n{help}");
    }
    for code in ["  0  ", "  1  ", "  2  ", "  3  ", "  4  ", "  5  ", "130  "] {
        assert!(help.contains(code), "{code} is missing from:\n{help}");
    }
}

#[test]
fn help_of_run_names_every_option_with_its_unit() {
    let help = Place::new().run(&["run", "--help"]).exits(0).stdout();
    for word in [
        "--threads",
        "--seed",
        "--duration",
        "--fps",
        "--set",
        "--output",
        "--fields",
        "--no-record",
        "--json",
        "--quiet",
        "--verbose",
        "--force",
        "--stop-on",
        "[s]",
        "[1/s]",
        "[m/s]",
        "Examples:",
    ] {
        assert!(help.contains(word), "{word} is missing from:\n{help}");
    }
}

#[test]
fn a_scene_without_a_command_is_run() {
    let place = Place::new();
    let short = place.run(&["drop.toml", "--json", "--no-record"]).exits(0).summary();
    let long = place.run(&["run", "drop.toml", "--json", "--no-record"]).exits(0).summary();
    assert_eq!(short["state_hash"], long["state_hash"]);
    assert_eq!(short["frames"], 10);
}

#[test]
fn wrong_arguments_exit_2_and_print_nothing_on_standard_output() {
    let place = Place::new();
    for (arguments, expected) in [
        (&["drop.toml", "--thread", "2"][..], "--threads"),
        (&["drop.toml", "--threads", "0"], "from 1"),
        (&["drop.toml", "--duration", "-1"], "positive"),
        (&["drop.toml", "--fps", "0"], "positive"),
        (&["drop.toml", "--set", "spacing"], "key=value"),
        (&["drop.toml", "--fields", "speed"], "velocity"),
        (&["drop.toml", "--stop-on", "sped>1"], "did you mean"),
        (&["drop.toml", "--no-record", "-o", "a.mcap"], "cannot be used with"),
        (&["drop.toml", "-q", "-v"], "cannot be used with"),
        (&["old.mcap"], "unipbd info old.mcap"),
        (&["run", "old.mcap"], "unipbd info old.mcap"),
        (&["chekc", "drop.toml"], "unipbd check"),
        (&["info", "old.mcap", "--set", "a=1"], "--set"),
        (&[], "Usage"),
    ] {
        let ended = place.run(arguments).exits(2);
        assert!(ended.stderr().contains(expected), "{arguments:?}: {}", ended.stderr());
        assert_eq!(ended.stdout(), "", "{arguments:?}");
    }
    assert_eq!(place.files(), ["drop.toml"]);
}

#[test]
fn a_missing_scene_or_log_exits_1_and_is_named() {
    let place = Place::new();
    for arguments in [
        &["run", "absent.toml"][..],
        &["absent.toml"],
        &["check", "absent.toml"],
        &["info", "absent.toml"],
        &["info", "absent.mcap"],
        &["render", "absent.mcap", "-o", "a.png"],
    ] {
        let ended = place.run(arguments).exits(1);
        assert!(ended.stderr().contains("absent."), "{}", ended.stderr());
        assert_eq!(ended.stdout(), "");
    }
}

#[test]
fn an_invalid_scene_exits_3_whatever_the_command() {
    let place = Place::new();
    place.write("bad.toml", "spacing = -1.0\nduratoin = 2\n");
    for command in ["run", "check", "info"] {
        let ended = place.run(&[command, "bad.toml"]).exits(3);
        assert!(ended.stderr().contains("spacing"), "{}", ended.stderr());
        assert!(ended.stderr().contains("duratoin"), "{}", ended.stderr());
        assert_eq!(ended.stdout(), "");
    }
    assert_eq!(place.files(), ["bad.toml", "drop.toml"], "nothing is written for an invalid scene");
}

#[test]
fn set_changes_the_scene_as_the_file_would() {
    let place = Place::new();
    let coarse = place.run(&["drop.toml", "--json", "--no-record", "--set", "spacing=0.2"]).exits(0).summary();
    assert_eq!(coarse["particles"], 25);
    let twice = ["drop.toml", "--json", "--no-record", "--set", "duration=0.1", "--set", "solver.substeps=2"];
    let summary = place.run(&twice).exits(0).summary();
    assert_eq!((&summary["frames"], &summary["substeps"]["max"]), (&5.into(), &2.into()));
    place.run(&["drop.toml", "--no-record", "--set", "spcing=0.2"]).exits(3);
    place.run(&["drop.toml", "--no-record", "--set", "spacing=-1"]).exits(3);
}

#[test]
fn duration_and_fps_replace_those_of_the_scene() {
    let place = Place::new();
    let summary =
        place.run(&["drop.toml", "--json", "--no-record", "--duration", "0.5", "--fps", "20"]).exits(0).summary();
    assert_eq!(summary["frames"], 10);
    assert!((summary["time"].as_f64().unwrap() - 0.5).abs() < 1e-9);
}

#[test]
fn the_seed_changes_a_scene_with_jitter_and_threads_change_nothing() {
    let place = Place::new();
    let hash = |arguments: &[&str]| {
        let mut all = vec!["drop.toml", "--json", "--no-record", "--set", "block.0.jitter=0.05"];
        all.extend(arguments);
        place.run(&all).exits(0).summary()["state_hash"].as_str().unwrap().to_owned()
    };
    let first = hash(&["--seed", "1"]);
    assert_ne!(first, hash(&["--seed", "2"]));
    for threads in ["1", "2", "3", "8"] {
        assert_eq!(first, hash(&["--seed", "1", "--threads", threads]), "{threads} threads");
    }
}

#[test]
fn the_environment_gives_the_threads_where_the_argument_does_not() {
    let place = Place::new();
    place.command(&["drop.toml", "--no-record"]).env("UNIPBD_THREADS", "2").assert().code(0);
    place.command(&["drop.toml", "--no-record"]).env("UNIPBD_THREADS", "many").assert().code(2);
    place.command(&["drop.toml", "--no-record", "--threads", "1"]).env("UNIPBD_THREADS", "2").assert().code(0);
}

#[test]
fn completions_know_the_commands_and_options_of_every_shell() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = place.run(&["completions", shell]).exits(0).stdout();
        for word in ["render", "stop-on", "threads", "completions"] {
            assert!(script.contains(word), "{word} is missing from the completions of {shell}");
        }
    }
    assert!(place.run(&["completions", "dos"]).exits(2).stderr().contains("bash"));
}

#[test]
fn the_manual_is_a_page_or_a_page_for_each_command() {
    let place = Place::new();
    let page = place.run(&["man"]).exits(0).stdout();
    for word in [".TH unipbd 1", "Exit codes", "UNIPBD_THREADS"] {
        assert!(page.contains(word), "{word} is missing from:\n{page}");
    }
    std::fs::create_dir(place.path("man")).unwrap();
    place.run(&["man", "--directory", "man"]).exits(0);
    for name in ["unipbd.1", "unipbd-run.1", "unipbd-render.1"] {
        assert!(std::fs::read_to_string(place.path("man").join(name)).unwrap().contains(".TH"), "{name}");
    }
    assert!(place.run(&["man", "--directory", "nowhere"]).exits(1).stderr().contains("nowhere"));
}
