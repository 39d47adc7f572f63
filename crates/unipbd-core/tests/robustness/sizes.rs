//! Sizes are refused before anything is allocated: these tests would take terabytes, or never end.

use super::is_refused;
use unipbd_core::scene::{BodyDescription, Copies, Heap, JointDescription, JointRule};

fn with_copies(columns: u32, rows: u32) -> BodyDescription {
    let copies = Copies { columns, rows, step: [1.0, 1.0], heap: Heap::Grid };
    BodyDescription { copies: Some(copies), ..BodyDescription::disc(0.2, [0.5, 0.5]) }
}

#[test]
fn bodies_larger_than_coordinates_can_be() {
    is_refused("body[0]", "the limit is", |scene| scene.body.push(BodyDescription::rectangle([0.6, 1e12], [0.5, 0.5])));
    is_refused("body[0]", "the limit is", |scene| scene.body.push(BodyDescription::disc(1e30, [0.5, 0.5])));
}

#[test]
fn bodies_that_hold_too_many_samples() {
    is_refused("body[0]", "samples; the limit is 1e7", |scene| scene.body.push(BodyDescription::disc(1e4, [0.5, 0.5])));
    is_refused("body[0]", "samples; the limit is 1e7", |scene| {
        scene
            .body
            .push(BodyDescription { copies: with_copies(300, 300).copies, ..BodyDescription::disc(1.0, [0.5, 0.5]) });
    });
}

#[test]
fn copies_by_the_thousand_million() {
    is_refused("body[0].copies.columns", "must be from 1 to 100000", |scene| {
        scene.body.push(with_copies(1_000_000_000, 1))
    });
    is_refused("body[0].copies", "the limit is 200000", |scene| scene.body.push(with_copies(100_000, 100_000)));
    // Other tables ask for the names of bodies.
    is_refused("joint[0].body", "there is no body", |scene| {
        scene.body.push(with_copies(4_000_000_000, 4_000_000_000));
        scene.joint.push(JointDescription::new(JointRule::Hinge, "absent", [0.0, 0.0]));
    });
}

#[test]
fn outlines_with_more_corners_than_can_be_compared() {
    is_refused("body[0].outline", "more than 4096 corners", |scene| {
        let corner = |k: u32| [f64::from(k).cos(), f64::from(k).sin()];
        scene.body.push(BodyDescription::polygon((0..50_000).map(corner).collect(), [0.5, 0.5]));
    });
}
