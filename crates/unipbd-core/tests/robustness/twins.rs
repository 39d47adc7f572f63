//! Things that are there twice.

use super::{is_refused, problems};
use unipbd_core::scene::{BodyDescription, HalfPlane, Obstacle, Tank};

#[test]
fn walls_that_are_there_twice_are_refused() {
    is_refused("tank[1]", "is where tank[0] is", |scene| scene.tank.push(scene.tank[0].clone()));
    is_refused("tank[1]", "is where tank[0] is", |scene| scene.tank.push(Tank::new([0.0, 1e-6], [2.0, 2.0])));
    is_refused("obstacle[1]", "is where obstacle[0] is", |scene| {
        scene.obstacle = vec![Obstacle::new([1.5, 0.0], [1.8, 0.5]); 2];
    });
    is_refused("half_plane[1]", "is where half_plane[0] is", |scene| {
        let plane = |normal, point| HalfPlane { normal, point, ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) };
        scene.half_plane = vec![plane([0.0, 1.0], [0.0, -1.0]), plane([0.0, 2.0], [5.0, -1.0])];
    });
}

#[test]
fn tanks_hold_all_particles() {
    is_refused("block[0]", "lies outside tank[1]", |scene| scene.tank.push(Tank::new([3.0, 0.0], [5.0, 2.0])));
    assert_eq!(problems(|scene| scene.tank.push(Tank::new([0.0, 0.0], [2.0, 2.1]))), [""; 0]);
}

#[test]
fn bodies_crowded_into_one_place_are_refused() {
    let body = |k: u32| BodyDescription::disc(0.2, [1.5 + 1e-4 * f64::from(k), 0.5]);
    is_refused("body[", "more than 16 bodies of its size", |scene| scene.body = (0..40).map(body).collect());
    assert_eq!(problems(|scene| scene.body = (0..5).map(body).collect()), [""; 0]);
    let apart = |k: u32| BodyDescription { layers: vec![3], collides_with: Some(vec![0]), ..body(k) };
    assert_eq!(problems(|scene| scene.body = (0..40).map(apart).collect()), [""; 0], "they do not push each other");
}
