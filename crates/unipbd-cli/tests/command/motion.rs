//! Scenes whose motions come from files.

use crate::support::Place;

const SHAKEN: &str = r#"
spacing = 0.1
duration = 0.2
fps = 50

[shaking]
file = "tables/shake.csv"

[[body]]
name = "maker"
kind = "kinematic"
size = [0.2, 1.0]
position = [0.0, 1.0]
motion = { file = "tables/maker.csv" }
"#;

fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("tables")).unwrap();
    place.write("tables/shake.csv", "# measured\ntime,ay\n0,0\n0.1,1.0\n0.2,0\n");
    place.write("tables/maker.csv", "time, x, angle_deg\r\n0.0, 0.0, 0.0\r\n0.1, 0.05, 3.0\r\n0.2, 0.2, 0.0\r\n");
    place.write("shaken.toml", SHAKEN);
    place
}

#[test]
fn a_log_holds_the_samples_of_its_files_and_the_run_is_the_same_without_them() {
    let place = place();
    place.run(&["shaken.toml", "-q"]).exits(0);
    let hash = |log: &str| place.run(&["info", log, "--json"]).exits(0).object()["last"]["state_hash"].clone();
    let log = std::fs::read(place.path("shaken.mcap")).unwrap();
    let summary = mcap::Summary::read(&log).unwrap().unwrap();
    let scene = mcap::read::attachment(&log, &summary.attachment_indexes[0]).unwrap();
    let text = String::from_utf8(scene.data.into_owned()).unwrap();
    assert!(!text.contains(".csv") && text.contains("angle_deg"), "{text}");
    place.write("whole.toml", &text);
    std::fs::remove_dir_all(place.path("tables")).unwrap();
    place.run(&["whole.toml", "-q"]).exits(0);
    assert_eq!(hash("shaken.mcap"), hash("whole.mcap"));
}

#[test]
fn a_file_can_be_changed_on_the_command_line_and_its_mistakes_are_named() {
    let place = place();
    place.write("tables/still.csv", "time,x\n0,0\n1,0\n");
    place.run(&["check", "shaken.toml", "--set", "body.maker.motion.file=tables/still.csv"]).exits(0);
    let said = place.run(&["check", "shaken.toml", "--set", "shaking.file=nothing.csv"]).exits(3).stderr();
    assert!(said.contains("shaking.file") && said.contains("there is no file nothing.csv"), "{said}");
    place.write("tables/maker.csv", "time,x\n0,0\n0.1,far\n");
    let said = place.run(&["shaken.toml", "--no-record"]).exits(3).stderr();
    assert!(
        said.contains("tables/maker.csv, line 3: \"far\" is no number") && said.contains("shaken.toml:14"),
        "{said}"
    );
    // Nothing is read without bound, and nothing waited for.
    let said = place.run(&["check", "shaken.toml", "--set", "shaking.file=/dev/zero"]).exits(3).stderr();
    assert!(said.contains("is no file") || said.contains("cannot read"), "{said}");
    place.write(
        "tables/shake.csv",
        &("time,ax\n".to_owned() + &(0..100_001).map(|k| format!("{k},0\n")).collect::<String>()),
    );
    let said = place.run(&["check", "shaken.toml"]).exits(3).stderr();
    assert!(said.contains("more than 100000 samples"), "{said}");
}
