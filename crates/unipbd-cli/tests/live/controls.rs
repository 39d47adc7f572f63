//! Viewers pause a run, move it by single frames and change its pace.

use serde_json::json;

use crate::client::{Heard, Run, Viewer};

#[test]
fn a_paused_run_stands_still_and_a_step_moves_it_by_a_frame() {
    let run = Run::start(&["--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    viewer.subscribe(&["/particles"]);
    let start = viewer.data("/particles").0;
    while viewer.data("/particles").0 <= start {}
    assert_eq!(viewer.set("paused", json!(true)), json!(true));
    let first = viewer.step(1);
    let second = viewer.step(1);
    assert_eq!(second["frame"].as_u64(), first["frame"].as_u64().map(|frame| frame + 1));
    assert!((second["time"].as_f64().unwrap() - first["time"].as_f64().unwrap() - 0.02).abs() < 1e-9);
    // What is heard in a quarter of a second at rest: nothing new.
    std::thread::sleep(std::time::Duration::from_millis(250));
    assert_eq!(viewer.step(1)["frame"].as_u64(), second["frame"].as_u64().map(|frame| frame + 1));
}

#[test]
fn the_bar_of_a_viewer_pauses_plays_and_sets_the_pace() {
    let run = Run::start(&["--no-record", "--paused"]);
    let mut viewer = Viewer::connect(&run.url);
    let offered = viewer.info["capabilities"].as_array().unwrap().clone();
    for capability in ["time", "parameters", "parametersSubscribe", "services", "playbackControl"] {
        assert!(offered.contains(&json!(capability)), "{offered:?}");
    }
    let mut other = Viewer::connect(&run.url);
    other.say(json!({ "op": "subscribeParameterUpdates", "parameterNames": ["paused", "speed"] }));
    // An answer to this comes after the subscription.
    assert_eq!(other.parameters()["paused"], json!(true));
    viewer.control(0, 4.0);
    assert_eq!(viewer.playback(), (0, 4.0));
    let told = other.text("parameterValues")["parameters"].clone();
    assert_eq!((&told[0]["value"], &told[1]["value"]), (&json!(false), &json!(4.0)));
    assert_ne!(viewer.parameters()["scene"]["spacing"], json!(null));
    viewer.control(1, 4.0);
    assert_eq!(viewer.playback(), (1, 4.0));
}

#[test]
fn steps_out_of_range_and_after_the_end_are_refused() {
    let run = Run::start(&["--no-record", "--paused", "--duration", "0.1"]);
    let mut viewer = Viewer::connect(&run.url);
    assert!(viewer.step(0)["message"].as_str().unwrap().contains("from 1 to"));
    assert_eq!(viewer.step(5)["frame"], 5);
    viewer.control(0, 1.0);
    while !matches!(viewer.hear(), Heard::Playback { status: 3, .. }) {}
    assert!(viewer.step(1)["message"].as_str().unwrap().contains("has ended"));
}
