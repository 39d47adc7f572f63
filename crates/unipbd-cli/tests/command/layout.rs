//! Layouts of viewers that fit a log.

use serde_json::{Value, json};
use unipbd_cli::read::Log;
use unipbd_cli::snapshot::Setting;

use crate::support::Place;

/// Width of the view over its height, and its height [pixels], in the window that layouts are made for.
const ASPECT: f64 = 1.2;
const HEIGHT: f64 = 850.0;

#[test]
fn a_layout_frames_the_scene_of_its_log() {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    place.run(&["layout", "drop.mcap", "-o", "layout.json"]).exits(0);
    let text = std::fs::read_to_string(place.path("layout.json")).unwrap();
    let layout: Value = serde_json::from_str(&text).unwrap();
    let panel = &layout["configById"]["3D!unipbd"];
    let camera = &panel["cameraState"];
    // The tank is 2 m wide and high.
    let (distance, target) = (camera["distance"].as_f64().unwrap(), &camera["targetOffset"]);
    assert!((2.0..3.0).contains(&distance), "{distance}");
    assert!((target[0].as_f64().unwrap() - 1.0).abs() < 0.2 && (target[1].as_f64().unwrap() - 1.0).abs() < 0.2);
    let topics: Vec<&String> = panel["topics"].as_object().unwrap().keys().collect();
    assert_eq!(topics, ["/boundary", "/particles", "/scene"]);
    // A layout of ours is written anew, another file is kept.
    place.run(&["layout", "drop.mcap", "-o", "layout.json"]).exits(0);
    place.write("mine.json", "{\"configById\": {}}");
    assert!(place.run(&["layout", "drop.mcap", "-o", "mine.json"]).exits(2).stderr().contains("--force"));
    let printed = place.run(&["layout", "drop.mcap"]).exits(0).stdout();
    assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), layout);
}

#[test]
fn a_run_writes_the_layout_beside_its_log_and_says_how_to_open_them() {
    let place = Place::new();
    let ended = place.run(&["drop.toml", "--layout", "drop.json"]).exits(0);
    assert!(ended.stdout().contains("Lichtblick, layout: drop.json"), "{}", ended.stdout());
    let written = std::fs::read_to_string(place.path("drop.json")).unwrap();
    assert_eq!(place.run(&["layout", "drop.mcap"]).exits(0).stdout(), written);
    let ended = place.run(&["drop.toml"]).exits(0);
    assert!(ended.stdout().contains("unipbd layout drop.mcap -o drop.json"), "{}", ended.stdout());
    place.write("notes.json", "notes");
    for (refused, reason) in [
        (&["drop.toml", "--layout", "notes.json"][..], "no layout of unipbd"),
        (&["drop.toml", "--layout", "drop.toml"], "the scene or the log"),
        (&["drop.toml", "-o", "x.mcap", "--layout", "x.mcap"], "the scene or the log"),
        (&["drop.toml", "-o", "-", "--layout", "a.json"], "a log in a file"),
        (&["drop.toml", "--no-record", "--layout", "a.json"], "--no-record"),
    ] {
        let message = place.run(refused).exits(2).stderr();
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn layouts_of_shipped_scenes_frame_what_their_logs_hold() {
    layouts_frame(&["--duration", "0.05"]);
}

#[test]
#[ignore = "minutes: whole scenes"]
fn layouts_of_shipped_scenes_frame_what_their_whole_logs_hold() {
    layouts_frame(&[]);
}

#[track_caller]
fn layouts_frame(changes: &[&str]) {
    for scene in ["dam_break", "floating_bodies", "everything", "pyramid", "open_gas"] {
        let place = Place::new();
        let file = format!("{}/../../scenes/{scene}.toml", env!("CARGO_MANIFEST_DIR"));
        let wanted = ["run", &file, "-q", "-o", "run.mcap", "--layout", "run.json"];
        place.run(&[&wanted[..], changes].concat()).exits(0);
        let layout: Value = serde_json::from_slice(&std::fs::read(place.path("run.json")).unwrap()).unwrap();
        let log = Log::open(&place.path("run.mcap")).unwrap();
        let panels = layout["configById"].as_object().unwrap();
        for (name, panel) in panels.iter().filter(|(name, _)| !name.starts_with("RosOut")) {
            assert!(panel["foxglovePanelTitle"].is_string(), "{name}");
            assert_eq!(panel["foxglovePanelTitle"], panel["lichtblickPanelTitle"], "{name}");
        }
        let panel = &panels["3D!unipbd"];
        let transforms = &panel["scene"]["transforms"];
        let found = ["axisScale", "lineWidth", "enablePreloading"].map(|key| &transforms[key]);
        assert_eq!(found, [&json!(0), &json!(0), &json!(true)]);
        let distance = panel["cameraState"]["distance"].as_f64().unwrap();
        let size = panel["topics"]["/particles"]["pointSize"].as_f64().unwrap();
        assert!((size * distance / HEIGHT / log.setting().spacing - 1.0).abs() < 0.1, "{scene}: {size} pixels");
        let target = [0, 1].map(|axis| panel["cameraState"]["targetOffset"][axis].as_f64().unwrap());
        is_framed(scene, &log, target, [distance * ASPECT, distance]);
    }
}

/// Checks that all but a few stray particles, and the walls, are in sight, and that they fill most of it.
#[track_caller]
fn is_framed(scene: &str, log: &Log, target: [f64; 2], seen: [f64; 2]) {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for frame in log.frames().unwrap() {
        let snapshot = frame.unwrap().snapshot;
        points.extend(snapshot.positions.iter().map(|point| point.map(f64::from)));
        points.extend(snapshot.bodies.iter().map(|body| body.position.to_array()));
    }
    let inside = |point: &&[f64; 2]| (0..2).all(|axis| (point[axis] - target[axis]).abs() <= 0.5 * seen[axis]);
    let share = points.iter().filter(inside).count() as f64 / points.len() as f64;
    let (corners, region) = corners(log.setting());
    assert!(share > 0.98, "{scene}: {share} of particles and bodies");
    // A scene that names a region shows that alone.
    assert!(region || corners.iter().all(|point| inside(&point)), "{scene}: {corners:?} not in {target:?} {seen:?}");
    points.extend(corners);
    let span = |axis: usize| {
        let along = || points.iter().filter(inside).map(|point| point[axis]);
        (along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)) / seen[axis]
    };
    assert!(span(0).max(span(1)) > 0.7, "{scene}: fills {} by {}", span(0), span(1));
}

/// Corners of the region that a scene names, or of its walls.
fn corners(setting: &Setting) -> (Vec<[f64; 2]>, bool) {
    let walls = setting.walls.iter().filter(|wall| !wall.endless).flat_map(|wall| wall.points.iter());
    match setting.view {
        Some((min, max)) => (vec![min, max], true),
        None => (walls.map(|point| point.to_array()).collect(), false),
    }
}
