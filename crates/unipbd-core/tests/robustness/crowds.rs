//! Places with far more particles than fit.

use super::{is_refused, pool, problems};
use unipbd_core::math::Vector64;
use unipbd_core::scene::{Liquid, PointMotion, Points};
use unipbd_core::{BuildOptions, Edit, edit};

fn points(count: usize, side: f64) -> Vec<[f64; 2]> {
    (0..count).map(|k| [1.2 + side * (k % 400) as f64 / 400.0, 0.2 + side * (k / 400) as f64 / 500.0]).collect()
}

#[test]
fn points_of_a_scene_in_a_small_box_are_refused() {
    let set = |count| Points {
        material: "water".into(),
        positions: points(count, 0.05),
        velocity: [0.0; 2],
        velocities: Vec::new(),
        temperature: 0.0,
        motion: PointMotion::Free,
    };
    is_refused("points", "particles within a square of 0.300 m around", |scene| scene.points.push(set(100_000)));
    assert_eq!(problems(|scene| scene.points.push(set(200))), [""; 0], "a dense clump is allowed");
}

#[test]
fn added_particles_in_a_small_box_are_refused_before_there_is_a_list() {
    let mut solver = pool().build(BuildOptions { threads: Some(1), seed: None }).unwrap();
    let add = |count| {
        let positions = points(count, 0.05).into_iter().map(Vector64::from).collect();
        Edit::new().add_points(edit::Points::new("water", positions))
    };
    let before = (solver.ids().len(), solver.state_hash());
    let refused = solver.apply(&add(200_000)).unwrap_err().to_string();
    assert!(refused.contains("particles within a square"), "{refused}");
    assert_eq!((solver.ids().len(), solver.state_hash()), before, "nothing was added");
    solver.apply(&add(50)).unwrap();
}

#[test]
fn particles_moved_into_one_place_are_refused_too() {
    let mut scene = pool();
    scene.liquid = vec![Liquid::new("water", 1000.0)];
    scene.spacing = 0.01;
    scene.solver.settle_substeps = Some(0);
    let mut solver = scene.build(BuildOptions { threads: Some(1), seed: None }).unwrap();
    let ids = solver.ids().to_vec();
    let places = vec![Vector64::new(0.5, 0.5); ids.len()];
    let refused = solver.apply(&Edit::new().set_positions(ids, places)).unwrap_err().to_string();
    assert!(refused.contains("10000 particles within a square"), "{refused}");
}
