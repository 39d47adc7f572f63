//! What goes to standard output and what to standard error.

use crate::support::Place;

#[test]
fn json_is_one_object_a_frame_and_a_summary_at_the_end() {
    let ended = Place::new().run(&["drop.toml", "--json", "--no-record"]).exits(0);
    let objects = ended.objects();
    let frames: Vec<_> = objects.iter().filter(|object| object["type"] == "frame").collect();
    assert_eq!(frames.len(), 11, "the start and ten frames");
    for (number, frame) in frames.iter().enumerate() {
        assert_eq!(frame["frame"], number);
        assert!((frame["time"].as_f64().unwrap() - number as f64 / 50.0).abs() < 1e-9);
        assert_eq!(frame["counts"]["liquid"], 100);
        for name in ["density_error_mean", "density_error_max", "kinetic_energy", "speed_max", "substeps"] {
            assert!(frame[name].is_number(), "{name} in {frame}");
        }
    }
    let summary = ended.summary();
    let hash = summary["state_hash"].as_str().unwrap();
    assert!(hash.len() == 16 && u64::from_str_radix(hash, 16).is_ok(), "{hash}");
    assert_eq!(summary["outcome"], "completed");
    assert_eq!(summary["steps"], 40);
    assert_eq!(summary["substeps"]["mean"], 4.0);
    assert_eq!(summary["counts_peak"]["liquid"], 100);
    let (mean, max) = (summary["density_error_mean"].as_f64().unwrap(), summary["density_error_max"].as_f64().unwrap());
    assert!(0.0 <= mean && mean <= max && max < 0.2, "fractions: {mean} and {max}");
    assert!(summary["wall_time"].as_f64().unwrap() > 0.0);
    assert!(summary["log"].is_null());
}

#[test]
fn worst_and_peak_figures_of_the_summary_are_those_of_the_frames() {
    let ended = Place::new().run(&["drop.toml", "--json", "--no-record"]).exits(0);
    let largest = |name: &str| {
        let values = ended.objects().into_iter().filter(|object| object["type"] == "frame");
        values.map(|frame| frame[name].as_f64().unwrap()).fold(0.0, f64::max)
    };
    let summary = ended.summary();
    assert_eq!(summary["density_error_max"].as_f64().unwrap(), largest("density_error_max"));
    assert_eq!(summary["speed_max"].as_f64().unwrap(), largest("speed_max"));
    assert!(largest("speed_max") > 0.0, "the water moves");
}

#[test]
fn progress_goes_to_standard_error_and_the_summary_to_standard_output() {
    let ended = Place::new().run(&["drop.toml", "--no-record"]).exits(0);
    assert!(ended.stderr().contains("100 %"), "{}", ended.stderr());
    assert!(ended.stderr().lines().count() <= 12, "{}", ended.stderr());
    for word in ["Drop: done at 0.20 s", "100 liquid", "substeps", "density error", "wall time", "state hash"] {
        assert!(ended.stdout().contains(word), "{word} is missing from:\n{}", ended.stdout());
    }
    assert!(!ended.stdout().contains('%') || !ended.stdout().contains("ETA"));
}

#[test]
fn quiet_prints_nothing_and_quiet_json_prints_data_only() {
    let place = Place::new();
    let quiet = place.run(&["-q", "drop.toml"]).exits(0);
    assert_eq!((quiet.stdout(), quiet.stderr()), (String::new(), String::new()));
    let json = place.run(&["-q", "--json", "drop.toml"]).exits(0);
    assert_eq!(json.stderr(), "");
    assert_eq!(json.objects().len(), 12);
    assert_ne!(place.run(&["-q", "absent.toml"]).exits(1).stderr(), "", "errors are printed even so");
}

#[test]
fn verbose_shows_the_time_of_each_stage() {
    let ended = Place::new().run(&["-v", "drop.toml", "--no-record"]).exits(0);
    assert!(ended.stderr().contains("stages"), "{}", ended.stderr());
    assert!(ended.stdout().matches(" %").count() > 4, "{}", ended.stdout());
}

#[test]
fn messages_have_no_colours_in_a_file() {
    let ended = Place::new().run(&["absent.toml"]).exits(1);
    assert!(ended.stderr().starts_with("error: "), "{:?}", ended.stderr());
}

#[test]
fn no_color_wins_over_forced_colours() {
    let place = Place::new();
    let forced = place.command(&["absent.toml"]).env("CLICOLOR_FORCE", "1").output().unwrap();
    assert!(String::from_utf8_lossy(&forced.stderr).contains('\u{1b}'));
    let plain = place.command(&["absent.toml"]).env("NO_COLOR", "1").output().unwrap();
    assert!(!String::from_utf8_lossy(&plain.stderr).contains('\u{1b}'));
}

#[test]
fn a_closed_pipe_ends_the_run_without_a_word() {
    let place = Place::new();
    let mut child = place
        .start(&["drop.toml", "--json", "--duration", "60", "-o", "cut.mcap"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let ended = crate::support::Ended(child.wait_with_output().unwrap()).exits(141);
    assert!(!ended.stderr().contains("error"), "{}", ended.stderr());
    place.run(&["info", "cut.mcap"]).exits(0);
}

#[test]
fn check_estimates_and_info_describes() {
    let place = Place::new();
    let check = place.run(&["check", "drop.toml"]).exits(0).stdout();
    for word in ["no mistakes", "100 at the start", "density error", "4 a frame", "memory", "cost"] {
        assert!(check.contains(word), "{word} is missing from:\n{check}");
    }
    let object = place.run(&["check", "drop.toml", "--json"]).exits(0).objects().remove(0);
    assert_eq!(object["particles"]["at_start"], 100);
    assert!(object["memory_bytes"]["at_start"].as_u64().unwrap() > 1000);
    let info = place.run(&["info", "drop.toml"]).exits(0).stdout();
    for word in ["Drop", "0.2 s, 10 frames", "water", "liquid", "1 tank", "stages"] {
        assert!(info.contains(word), "{word} is missing from:\n{info}");
    }
    let object = place.run(&["info", "drop.toml", "--json"]).exits(0).objects().remove(0);
    assert_eq!((&object["type"], &object["materials"][0]["count"]), (&"scene".into(), &100.into()));
    assert_eq!(place.files(), ["drop.toml"], "neither writes a file");
}

#[test]
fn check_tells_where_the_missing_grid_slows_bodies() {
    let place = Place::new();
    let floats = |grid: &str, kind: &str| {
        let text = format!(
            r#"
            spacing = 0.05
            [solver]
            pressure_grid = "{grid}"
            [[liquid]]
            name = "water"
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [1.0, 0.5]
            [[tank]]
            min = [0.0, 0.0]
            max = [1.0, 1.0]
            [[body]]
            kind = "{kind}"
            position = [0.5, 0.7]
            radius = 0.1
            "#
        );
        place.write("float.toml", &text);
        place.run(&["check", "float.toml"]).exits(0).stdout()
    };
    for (grid, kind, told) in [("off", "dynamic", true), ("on", "dynamic", false), ("off", "static", false)] {
        let check = floats(grid, kind);
        assert_eq!(check.contains("bodies sink"), told, "grid {grid}, {kind} body:\n{check}");
    }
}

#[test]
fn the_schema_describes_every_table_of_a_scene() {
    let text = Place::new().run(&["schema"]).exits(0).stdout();
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in ["spacing", "solver", "liquid", "gas", "smoke", "emitter", "tank", "obstacle", "half_plane"] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
    assert_eq!(schema["additionalProperties"], false);
}

#[test]
fn check_lists_the_problems_of_a_scene_as_data() {
    let place = Place::new();
    place.write("bad.toml", "fps = 60\nduratoin = 2\nspacing = -1.0\n");
    let object = place.run(&["check", "bad.toml", "--json"]).exits(3).objects().remove(0);
    assert_eq!(object["valid"], false);
    let problems = object["problems"].as_array().unwrap();
    assert!(problems.iter().any(|problem| problem["line"] == 2 && problem["hint"].is_string()), "{object}");
    assert!(problems.iter().any(|problem| problem["line"] == 3 && problem["key"] == "spacing"), "{object}");
}
