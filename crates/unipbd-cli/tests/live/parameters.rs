//! Viewers change parameters; each change is an edit of the run.

use serde_json::json;

use crate::client::{Run, Viewer, command, points};

#[test]
fn a_change_of_gravity_shows_in_the_motion() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    viewer.subscribe(&["/particles"]);
    let start = points(&viewer.data("/particles").1);
    assert_eq!(viewer.set("gravity", json!([5, 0])), json!([5.0, 0.0]));
    viewer.step(10);
    let end = loop {
        let (time, cloud) = viewer.data("/particles");
        if time == 200_000_000 {
            break points(&cloud);
        }
    };
    // s = a t^2/2 = 0.1 m to the right, where the scene has the water fall.
    let water: Vec<_> = start.iter().zip(&end).filter(|(from, _)| from[0] < 1.0).collect();
    let mean = |axis: usize| water.iter().map(|(from, to)| to[axis] - from[axis]).sum::<f32>() / water.len() as f32;
    assert_eq!(water.len(), 16);
    assert!((mean(0) - 0.1).abs() < 0.01 && mean(1).abs() < 0.01, "{} {}", mean(0), mean(1));
}

#[test]
fn a_motor_is_a_parameter_and_turns_as_it_is_told() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    assert!((viewer.parameters()["motor_speed/axle"].as_f64().unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    assert_eq!(viewer.set("motor_speed/axle", json!(-3)), json!(-3.0));
    viewer.subscribe(&["/bodies"]);
    viewer.step(5);
    let speed = loop {
        let (time, message) = viewer.data("/bodies");
        if time == 100_000_000 {
            let bodies = message.get_field_by_name("bodies").unwrap().into_owned();
            let wheel = bodies.as_list().unwrap()[0].as_message().unwrap().clone();
            break wheel.get_field_by_name("angular_velocity").unwrap().as_f64().unwrap();
        }
    };
    assert!((speed + 3.0).abs() < 0.01, "{speed}");
}

#[test]
fn what_cannot_be_set_stays_and_the_viewer_is_told_why() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    for (name, value, reason) in [
        ("gravity", json!([1]), "two numbers"),
        ("gravity", json!("down"), "two numbers"),
        ("speed", json!(-1), "from 0"),
        ("paused", json!(3), "true or false"),
        ("scene", json!("x"), "cannot be changed"),
        ("motor_speed/nobody", json!(1), "no motor"),
        ("viscosity", json!(1), "no parameter"),
    ] {
        viewer.say(json!({ "op": "setParameters", "parameters": [{ "name": name, "value": value }] }));
        let status = viewer.text("status");
        assert!(status["message"].as_str().unwrap().contains(reason), "{status}");
    }
    assert_eq!(viewer.parameters()["gravity"], json!([0.0, -9.81]));
}

#[test]
fn the_log_of_a_run_tells_what_a_viewer_has_changed() {
    let run = Run::start(&["--paused", "--duration", "0.2"]);
    let mut viewer = Viewer::connect(&run.url);
    viewer.set("gravity", json!([0, -1.62]));
    viewer.set("speed", json!(0));
    viewer.step(10);
    viewer.set("paused", json!(false));
    while !matches!(viewer.hear(), crate::client::Heard::Playback { status: 3, .. }) {}
    let info = command(&run, &["info", "live.mcap", "--json"]);
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!((&info["frames"], &info["events"]), (&json!(11), &json!(1)));
}
