//! Every quantity of the diagnostics is in the JSON lines of a run, and in those about a log.

use std::path::Path;

use serde_json::Value as Json;
use unipbd_cli::scene_file;
use unipbd_cli::simulation::Simulation;
use unipbd_core::Phase;
use unipbd_core::observe::{Diagnostics, Entry, Table, Value};

use crate::support::{DROP, Place};

/// One that reads something in each frame, and one that never does.
const GAUGES: &str = "
[[gauge]]
name = \"front\"
kind = \"front\"
direction = [1.0, 0.0]

[[gauge]]
name = \"far\"
kind = \"level\"
at = [90.0, 0.0]
";

/// The drop in a tank whose walls are measured, and two gauges.
fn scene() -> String {
    DROP.replace("[[tank]]", "[[tank]]\nname = \"tank\"") + GAUGES
}

/// The diagnostics of the start and of each frame of the scene.
fn expected(path: &Path) -> Vec<Diagnostics> {
    let scene = scene_file::load(path, &[]).unwrap().scene;
    let mut simulation = Simulation::new(&scene, Default::default());
    let mut all = vec![simulation.solver.diagnostics()];
    while let Some(frame) = simulation.next_frame() {
        frame.unwrap();
        all.push(simulation.solver.diagnostics());
    }
    all
}

fn json(value: Value<'_>) -> Json {
    match value {
        Value::Count(count) => count.into(),
        // Null where it is not a number.
        Value::Number(number) => number.into(),
        Value::Word(word) => word.into(),
        Value::Vector(vector) => vec![vector.x, vector.y].into(),
        Value::ByPhase(counts) => Phase::ALL.map(|phase| (phase.name(), counts[phase as usize])).into_iter().collect(),
    }
}

fn check_object<T: Table>(object: &Json, table: &T) {
    for quantity in T::QUANTITIES {
        assert_eq!(object[quantity.name], json((quantity.read)(table)), "{}", quantity.name);
    }
}

fn check_objects<T: Entry>(object: &Json, entries: &[T]) {
    assert!(!entries.is_empty(), "the scene has no {}", T::LIST);
    entries.iter().for_each(|entry| check_object(&object[T::LIST][entry.name()], entry));
}

fn check_line(object: &Json, diagnostics: &Diagnostics) {
    check_object(object, diagnostics);
    check_objects(object, &diagnostics.materials);
    check_objects(object, &diagnostics.groups);
    check_objects(object, &diagnostics.walls);
    check_objects(object, &diagnostics.gauges);
}

#[test]
fn every_quantity_is_in_the_line_of_every_frame() {
    let place = Place::new();
    place.write("drop.toml", &scene());
    let objects = place.run(&["drop.toml", "--json", "--no-record"]).exits(0).objects();
    let frames: Vec<&Json> = objects.iter().filter(|object| object["type"] == "frame").collect();
    let expected = expected(&place.path("drop.toml"));
    assert_eq!(frames.len(), expected.len());
    frames.iter().zip(&expected).for_each(|(frame, expected)| check_line(frame, expected));
}

#[test]
fn every_quantity_of_the_last_frame_is_in_the_description_of_a_log() {
    let place = Place::new();
    place.write("drop.toml", &scene());
    place.run(&["drop.toml", "-q"]).exits(0);
    let object = place.run(&["info", "drop.mcap", "--json"]).exits(0).objects().remove(0);
    check_line(&object["last"], expected(&place.path("drop.toml")).last().unwrap());
    assert_eq!(object["last"]["state_hash"].as_str().map(str::len), Some(16));
}
