//! One warning, with where and a likely why, as soon as a material is far from its rest density for more than a frame.

use super::pool;
use unipbd_core::observe::{Event, Severity};
use unipbd_core::scene::{PointMotion, Points, Scene, Substeps};
use unipbd_core::{BuildOptions, Solver};

fn warnings(scene: &Scene, frames: u32) -> Vec<Event> {
    let mut solver: Solver = scene.build(BuildOptions { threads: Some(1), seed: None }).unwrap();
    (0..frames).for_each(|_| drop(solver.step_frame()));
    let events = solver.take_events().into_iter();
    events.filter(|event| event.severity == Severity::Warning && event.message.starts_with("the density")).collect()
}

#[test]
fn coincident_points_that_never_part_are_told_of_once() {
    let mut scene = pool();
    scene.block.clear();
    scene.points.push(Points {
        material: "water".into(),
        positions: vec![[1.0, 0.5]; 200],
        velocity: [0.0; 2],
        velocities: Vec::new(),
        temperature: 0.0,
        motion: PointMotion::Free,
    });
    let found = warnings(&scene, 20);
    assert_eq!(found.len(), 1, "{found:?}");
    let message = &found[0].message;
    assert!(message.contains("\"water\" is off by") && message.contains("at (1.0"), "{message}");
    assert!(message.contains("lie in one place"), "{message}");
    assert!(found[0].time > 0.0);
}

#[test]
fn too_few_substeps_are_named_as_the_reason() {
    let mut scene = pool();
    scene.gravity = [0.0, -3e4];
    scene.solver.substeps = Substeps::Fixed(1);
    let found = warnings(&scene, 20);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].message.contains("substeps"), "{found:?}");
}

#[test]
fn a_splash_is_no_reason_to_warn() {
    assert_eq!(warnings(&pool(), 60), []);
}
