//! An output that is the input is refused, by any name.

use crate::support::{DROP, Place};

fn is_refused(place: &Place, arguments: &[&str], input: &str, before: &[u8]) {
    let ended = place.run(arguments).exits(2);
    assert!(ended.stderr().contains("is the input itself"), "{}", ended.stderr());
    assert_eq!(std::fs::read(place.path(input)).unwrap(), before, "{arguments:?}");
}

#[test]
fn a_scene_is_never_replaced_by_its_log() {
    let place = Place::new();
    std::fs::hard_link(place.path("drop.toml"), place.path("hard.mcap")).unwrap();
    let mut names = vec!["drop.toml", "./drop.toml", "hard.mcap"];
    if cfg!(unix) {
        #[cfg(unix)]
        std::os::unix::fs::symlink(place.path("drop.toml"), place.path("soft.mcap")).unwrap();
        names.push("soft.mcap");
    }
    for name in names {
        is_refused(&place, &["run", "drop.toml", "-o", name, "--force"], "drop.toml", DROP.as_bytes());
    }
}

#[test]
fn a_log_is_never_replaced_by_its_picture() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let before = std::fs::read(place.path("drop.mcap")).unwrap();
    std::fs::hard_link(place.path("drop.mcap"), place.path("drop.png")).unwrap();
    is_refused(&place, &["render", "drop.mcap", "-o", "drop.png", "--force"], "drop.mcap", &before);
}
