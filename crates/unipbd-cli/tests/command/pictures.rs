//! Pictures of logs and scenes.

use crate::support::Place;

#[test]
fn a_log_becomes_png_frames_and_a_gif() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    place.run(&["render", "drop.mcap", "-o", "drop_%03d.png", "--every", "5", "--width", "200"]).exits(0);
    let frames = place.files().into_iter().filter(|name| name.ends_with(".png")).count();
    assert_eq!(frames, 3, "{:?}", place.files());
    place.run(&["render", "drop.mcap", "-o", "drop.gif", "--width", "200"]).exits(0);
    assert!(std::fs::read(place.path("drop.gif")).unwrap().starts_with(b"GIF89a"));
}

#[test]
fn a_scene_is_run_for_its_pictures_without_a_log() {
    let place = Place::new();
    place.run(&["render", "drop.toml", "-o", "end.png", "--time", "0.2", "--color", "speed"]).exits(0);
    assert!(std::fs::read(place.path("end.png")).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(place.files(), ["drop.toml", "end.png"]);
}

#[test]
fn a_log_without_the_column_says_which_flag_records_it() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let ended = place.run(&["render", "drop.mcap", "-o", "a.png", "--color", "speed"]).exits(2);
    assert!(ended.stderr().contains("--fields velocity"), "{}", ended.stderr());
}

#[test]
fn an_existing_picture_needs_force() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    place.write("a.png", "precious");
    let ended = place.run(&["render", "drop.mcap", "-o", "a.png", "--time", "0.1"]).exits(2);
    assert!(ended.stderr().contains("--force"), "{}", ended.stderr());
    place.run(&["render", "drop.mcap", "-o", "a.png", "--time", "0.1", "--force"]).exits(0);
}

#[test]
fn help_of_render_names_every_option() {
    let help = Place::new().run(&["render", "--help"]).exits(0).stdout();
    for word in ["--output", "--color", "--width", "--time", "--from", "--to", "--every", "--force", "[s]"] {
        assert!(help.contains(word), "{word} is missing from:\n{help}");
    }
}
