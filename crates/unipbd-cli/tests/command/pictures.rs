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
    let ended = place.run(&["render", "drop.mcap", "-o", "a.png", "--color", "density"]).exits(2);
    assert!(ended.stderr().contains("--fields density"), "{}", ended.stderr());
}

#[test]
fn speeds_come_from_positions_where_a_log_has_no_velocities() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let drawn = |name: &str, color: &str| {
        place.run(&["render", "drop.mcap", "-o", name, "--time", "0.2", "--color", color, "--range", "0..3"]).exits(0);
        std::fs::read(place.path(name)).unwrap()
    };
    assert!(drawn("speed.png", "speed") != drawn("material.png", "material"));
}

#[test]
fn axes_scale_bar_and_legend_change_a_picture_outside_the_scene() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let size = |name: &str, flags: &[&str]| {
        place.run(&[&["render", "drop.mcap", "-o", name, "--json"], flags].concat()).exits(0).object()["size"].clone()
    };
    let plain = size("plain.png", &[]);
    let axes = size("axes.png", &["--axes"]);
    assert!(axes[0].as_u64() > plain[0].as_u64() && axes[1].as_u64() > plain[1].as_u64());
    for flag in ["--scale-bar", "--legend"] {
        let name = format!("{}.png", &flag[2..]);
        assert_eq!(size(&name, &[flag]), plain);
        assert!(std::fs::read(place.path(&name)).unwrap() != std::fs::read(place.path("plain.png")).unwrap(), "{flag}");
    }
}

#[test]
fn stills_of_vectors_have_a_disc_per_particle() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    place.run(&["render", "drop.mcap", "-o", "end.svg", "--axes", "--legend", "--scale-bar"]).exits(0);
    let svg = std::fs::read_to_string(place.path("end.svg")).unwrap();
    assert_eq!(svg.matches("<circle").count(), 100);
    assert!(
        svg.starts_with("<svg")
            && svg.ends_with("</svg>\n")
            && svg.matches("<g").count() == svg.matches("</g>").count()
    );
    place.run(&["render", "drop.mcap", "-o", "end.pdf", "--color", "speed"]).exits(0);
    let pdf = std::fs::read(place.path("end.pdf")).unwrap();
    assert!(pdf.starts_with(b"%PDF-1.7") && pdf.ends_with(b"%%EOF"));
    place.run(&["render", "drop.mcap", "-o", "again.pdf", "--color", "speed"]).exits(0);
    assert!(std::fs::read(place.path("again.pdf")).unwrap() == pdf, "the same bytes");
}

#[test]
fn a_page_plays_a_scene_or_a_log() {
    let place = Place::new();
    place.run(&["render", "drop.toml", "-o", "scene.html", "-q"]).exits(0);
    place.run(&["drop.toml", "-q"]).exits(0);
    place.run(&["render", "drop.mcap", "-o", "log.html", "-q"]).exits(0);
    let [scene, log] = ["scene.html", "log.html"].map(|name| std::fs::read_to_string(place.path(name)).unwrap());
    assert!(scene.contains("\"name\":\"Drop\"") && !scene.contains("http"), "one file, no server");
    assert_eq!(scene.len(), log.len());
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

#[test]
fn a_picture_of_the_same_run_is_made_anew_without_force_and_one_of_another_is_kept() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    place.run(&["drop.toml", "-q", "--seed", "5", "--set", "gravity=[0, -1]", "-o", "other.mcap"]).exits(0);
    for name in ["a.png", "a.svg", "a.pdf", "a.gif", "a.html"] {
        place.run(&["render", "drop.mcap", "-o", name, "--width", "200"]).exits(0);
        let first = std::fs::read(place.path(name)).unwrap();
        let refused = place.run(&["render", "other.mcap", "-o", name]).exits(2);
        assert!(refused.stderr().contains("not made from this run"), "{}", refused.stderr());
        assert_eq!(std::fs::read(place.path(name)).unwrap(), first);
        // The scene gives the run of the log.
        place.run(&["render", "drop.toml", "-o", name, "--width", "240", "--background", "light"]).exits(0);
        assert_ne!(std::fs::read(place.path(name)).unwrap(), first);
    }
    place.run(&["render", "drop.mcap", "-o", "f_%02d.png", "--every", "5", "--width", "100"]).exits(0);
    place.run(&["render", "drop.mcap", "-o", "f_%02d.png", "--every", "5", "--width", "120"]).exits(0);
}

#[test]
fn arrows_show_velocities_and_forces_in_pictures_and_films() {
    let place = Place::new();
    let with_body =
        format!("{}\n[[body]]\nradius = 0.2\nposition = [1.5, 0.5]\ndensity = 500.0\n", crate::support::DROP);
    place.write("body.toml", &with_body);
    place.run(&["body.toml", "-q"]).exits(0);
    for name in ["v.png", "v.svg", "v.pdf", "v.gif"] {
        for vectors in ["velocity", "force"] {
            let [plain, arrows] = [format!("plain_{name}"), format!("{vectors}_{name}")];
            place.run(&["render", "body.mcap", "-o", &plain, "--width", "200"]).exits(0);
            place.run(&["render", "body.mcap", "-o", &arrows, "--width", "200", "--vectors", vectors]).exits(0);
            let [plain, arrows] = [plain, arrows].map(|name| std::fs::read(place.path(&name)).unwrap());
            assert_ne!(plain, arrows, "{name} {vectors}");
        }
    }
    let refused = place.run(&["render", "body.mcap", "-o", "a.html", "--vectors", "velocity"]).exits(2);
    assert!(refused.stderr().contains("draws no arrows"), "{}", refused.stderr());
}
