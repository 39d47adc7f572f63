//! The topics of a live run are those of its log.

use crate::client::{Heard, Run, Viewer, points};

const ALL: [&str; 8] =
    ["/bodies", "/boundary", "/diagnostics", "/log", "/particles", "/particles/columns", "/scene", "/tf"];

#[test]
fn a_viewer_gets_the_topics_it_subscribes_to_decoded_by_their_schemas() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    assert_eq!(viewer.channels.keys().map(String::as_str).collect::<Vec<_>>(), ALL);
    assert_eq!(viewer.info["name"], "unipbd: Live");
    viewer.subscribe(&["/particles", "/diagnostics"]);
    // The water, and the samples of the wheel.
    assert_eq!(points(&viewer.data("/particles").1).len(), 16 + 12);
    assert_eq!(viewer.step(3)["frame"], 3);
    let mut heard = Vec::new();
    while heard.last() != Some(&("/particles".to_owned(), 80_000_000)) {
        if heard.last() == Some(&("/particles".to_owned(), 60_000_000)) {
            viewer.step(1);
        }
        if let Heard::Data { topic, time, .. } = viewer.hear() {
            heard.push((topic, time));
        }
    }
    // Frames of a fiftieth of a second; each is whole when its particles come.
    heard.retain(|(_, time)| *time > 0);
    let frame = |number: u64| ["/diagnostics", "/particles"].map(|topic| (topic.to_owned(), 20_000_000 * number));
    assert_eq!(heard, (1..=4).flat_map(frame).collect::<Vec<_>>());
}

#[test]
fn the_clock_of_viewers_shows_simulated_time() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut viewer = Viewer::connect(&run.url);
    viewer.subscribe(&["/tf"]);
    viewer.data("/tf");
    viewer.ask_for_steps(2);
    let mut clock = Vec::new();
    while clock.len() < 2 {
        match viewer.hear() {
            Heard::Time(time) if time > 0 => clock.push(time),
            _ => {}
        }
    }
    assert_eq!(clock, [20_000_000, 40_000_000]);
}

#[test]
fn a_late_viewer_gets_walls_shapes_and_ids_though_the_run_stands_still() {
    let run = Run::start(&["--paused", "--no-record"]);
    let mut early = Viewer::connect(&run.url);
    assert_eq!(early.step(5)["frame"], 5);
    let mut late = Viewer::connect(&run.url);
    late.subscribe(&["/boundary", "/scene", "/bodies", "/particles/columns", "/particles", "/tf"]);
    let mut missing = vec!["/boundary", "/scene", "/bodies", "/particles/columns", "/particles", "/tf"];
    while !missing.is_empty() {
        let Heard::Data { topic, time, message } = late.hear() else { continue };
        missing.retain(|name| *name != topic);
        assert_eq!(time, 100_000_000);
        let count = |field: &str| message.get_field_by_name(field).unwrap().as_list().unwrap().len();
        match topic.as_str() {
            "/scene" => assert_eq!(count("entities"), 2),
            "/bodies" => assert_eq!((count("bodies"), count("shapes")), (1, 1)),
            "/particles/columns" => assert_eq!(count("id"), 28),
            "/boundary" => assert!(points(&message).len() > 80),
            _ => {}
        }
    }
}

#[test]
fn a_viewer_that_reads_nothing_holds_nothing_up() {
    // Frames of 45 kB, so that what systems keep for a socket is soon full.
    let mut run = Run::start(&["--no-record", "--speed", "0", "--duration", "60", "--set", "spacing=0.01"]);
    let mut idle = Viewer::connect(&run.url);
    idle.subscribe(&ALL);
    let mut watching = Viewer::connect(&run.url);
    watching.subscribe(&["/diagnostics"]);
    let late = |time: u64| time > 6_000_000_000;
    while !late(watching.data("/diagnostics").0) {}
    run.interrupt();
    // Neither does it hold up the end.
    assert!(run.ends());
}
