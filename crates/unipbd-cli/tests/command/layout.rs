//! Layouts of viewers that fit a log.

use serde_json::Value;

use crate::support::Place;

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
    assert!(place.run(&["layout", "drop.mcap", "-o", "layout.json"]).exits(2).stderr().contains("--force"));
    let printed = place.run(&["layout", "drop.mcap"]).exits(0).stdout();
    assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), layout);
}
