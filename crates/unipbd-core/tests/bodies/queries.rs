//! Questions to a world: contacts, events, rays, places, neighbours, sensors, poses between frames.

use super::common::{ALL, build, floored, named, step};
use unipbd_core::edit::Edit;
use unipbd_core::scene::{BodyDescription, BodyKind, Obstacle, Substeps};
use unipbd_core::step::Solid;
use unipbd_core::{Solver, Vector64};

fn at(x: f64, y: f64) -> Vector64 {
    Vector64::new(x, y)
}

#[test]
fn contacts_tell_pair_points_and_load_awake_or_asleep() {
    for substeps in ALL {
        let boxes = (0..2).map(|k| BodyDescription::rectangle([0.4, 0.4], [0.0, 0.2 + 0.4 * f64::from(k)]));
        let mut solver = build(&floored(substeps, boxes.collect()));
        for seconds in [0.3, 2.0] {
            step(&mut solver, seconds);
            let contacts = solver.contacts();
            let load = |pair: (Option<u32>, Option<u32>)| {
                let of = contacts.iter().filter(|point| (point.other, point.wall) == pair);
                of.map(|point| point.normal_force).sum::<f64>()
            };
            let weight = 160.0 * 9.81;
            println!("{substeps:?} asleep {}: {:.2} N", solver.bodies()[0].asleep, load((None, Some(0))));
            assert!((load((None, Some(0))) / (2.0 * weight) - 1.0).abs() < 1e-3 && contacts.len() == 4);
            let between: f64 =
                contacts.iter().filter(|point| point.wall.is_none()).map(|point| point.normal_force).sum();
            assert!((between / weight - 1.0).abs() < 1e-3);
            for point in &contacts {
                let y = if point.wall.is_some() { 0.0 } else { 0.4 };
                assert!((point.position.y - y).abs() < 2e-3 && (point.position.x.abs() - 0.2).abs() < 2e-3);
            }
        }
        assert!(solver.bodies()[0].asleep);
    }
}

#[test]
fn events_tell_when_contacts_begin_and_end() {
    for substeps in ALL {
        let ball = BodyDescription { restitution: 0.5, ..BodyDescription::disc(0.2, [0.0, 1.2]) };
        let gate = BodyDescription {
            sensor: true,
            kind: BodyKind::Static,
            ..BodyDescription::rectangle([1.0, 0.2], [0.0, 0.8])
        };
        let mut solver = build(&floored(substeps, vec![ball, named("gate", gate)]));
        solver.watch_contacts(true);
        step(&mut solver, 1.0);
        let events = solver.take_contact_events();
        let sensor: Vec<bool> = events.iter().filter(|event| event.sensor).map(|event| event.began).collect();
        let floor: Vec<bool> = events.iter().filter(|event| event.wall == Some(0)).map(|event| event.began).collect();
        println!("{substeps:?}: {} events; gate {sensor:?}, floor {floor:?}", events.len());
        assert!(sensor[..2] == [true, false] && floor[..2] == [true, false] && events[0].body == 1);
        step(&mut solver, 6.0);
        let last = solver.take_contact_events().into_iter().rfind(|event| event.wall == Some(0));
        assert!(last.is_some_and(|event| event.began) && solver.bodies()[0].asleep, "asleep it still touches");
        let pairs = solver.contact_pairs();
        let weight = solver.bodies()[0].mass * 9.81 / 60.0;
        assert!(pairs.len() == 1 && (pairs[0].impulse.y / weight - 1.0).abs() < 1e-3, "{pairs:?}");
    }
}

#[test]
fn an_impact_gives_its_impulse() {
    for substeps in ALL {
        let ball =
            BodyDescription { restitution: 1.0, velocity: [0.0, -3.0], ..BodyDescription::disc(0.2, [0.0, 0.45]) };
        let mut scene = floored(substeps, vec![ball]);
        scene.gravity = [0.0, 0.0];
        let mut solver = build(&scene);
        solver.watch_contacts(true);
        let mut total = Vector64::ZERO;
        for _ in 0..30 {
            step(&mut solver, 1.0 / 60.0);
            total += solver.contact_pairs().iter().map(|pair| pair.impulse).sum::<Vector64>();
        }
        let exact = 6.0 * solver.bodies()[0].mass;
        println!("{substeps:?}: impulse {:.3} of {exact:.3} N s", total.y);
        assert!((total.y / exact - 1.0).abs() < 1e-3);
    }
}

fn hall() -> Solver {
    let bodies = vec![
        named("box", BodyDescription::rectangle([0.4, 0.4], [1.0, 0.2])),
        named("ball", BodyDescription { layers: vec![2], ..BodyDescription::disc(0.3, [3.0, 0.3]) }),
        named(
            "gate",
            BodyDescription {
                sensor: true,
                kind: BodyKind::Static,
                ..BodyDescription::rectangle([0.2, 2.0], [2.0, 1.0])
            },
        ),
    ];
    let mut scene = floored(Substeps::Auto, bodies);
    scene.obstacle = vec![Obstacle::new([4.0, 0.0], [5.0, 1.0])];
    build(&scene)
}

#[test]
fn rays_meet_what_is_in_their_way() {
    let solver = hall();
    let ray = |from: [f64; 2], to: [f64; 2]| solver.query().ray_cast(from.into(), to.into());
    let hit = ray([0.0, 0.3], [6.0, 0.3]).expect("the box is in the way");
    assert_eq!((hit.solid, hit.point, hit.normal), (Solid::Body(0), at(0.8, 0.3), at(-1.0, 0.0)));
    let all = solver.query().with_sensors().ray_cast_all(at(0.0, 0.3), at(6.0, 0.3));
    let solids: Vec<Solid> = all.iter().map(|hit| hit.solid).collect();
    assert_eq!(solids, [Solid::Body(0), Solid::Body(2), Solid::Body(1), Solid::Wall(1)]);
    let hit = solver.query().in_layers(1 << 2).without_walls().ray_cast(at(0.0, 0.3), at(6.0, 0.3));
    assert!(hit.is_some_and(|hit| hit.solid == Solid::Body(1) && (hit.point.x - 2.7).abs() < 1e-12));
    let down = ray([0.0, 5.0], [0.0, -5.0]).expect("the floor");
    assert!(down.solid == Solid::Wall(0) && (down.fraction - 0.5).abs() < 1e-12);
    assert_eq!(ray([0.0, 2.0], [6.0, 2.0]), None);
}

#[test]
fn places_boxes_and_neighbours_are_found() {
    let mut solver = hall();
    let query = || solver.query().without_walls();
    assert_eq!(query().at(at(1.1, 0.3)), [Solid::Body(0)]);
    assert_eq!(query().at(at(2.0, 0.3)), [], "sensors are left out");
    assert_eq!(query().in_box(at(1.1, 0.1), at(2.8, 0.5)), [Solid::Body(0), Solid::Body(1)]);
    assert_eq!(query().with_sensors().in_box(at(1.9, 1.9), at(2.5, 2.5)), [Solid::Body(2)]);
    let near = query().nearest(at(1.6, 0.3), 0.5).expect("the box is near");
    assert!(
        near.solid == Solid::Body(0)
            && (near.distance - 0.4).abs() < 1e-12
            && (near.point - at(1.2, 0.3)).length() < 1e-12
    );
    assert_eq!(query().nearest(at(1.6, 3.0), 0.5), None);
    assert_eq!(solver.query().nearest(at(1.9, 0.1), 1.0).map(|near| near.solid), Some(Solid::Wall(0)));
    solver.apply(&Edit::new().move_body(1, at(2.0, 0.5), 0.0)).expect("it is there");
    assert_eq!(solver.query().without_walls().overlapping(2), [Solid::Body(1)]);
    solver.apply(&Edit::new().remove_body(1)).expect("it is there");
    assert_eq!(solver.query().without_walls().overlapping(2), []);
}

#[test]
fn poses_between_frames_lie_on_the_way() {
    let body =
        BodyDescription { velocity: [3.0, 0.0], spin_deg: 90.0, ..BodyDescription::rectangle([0.4, 0.4], [0.0, 5.0]) };
    let mut solver = build(&floored(Substeps::Auto, vec![body]));
    step(&mut solver, 0.1);
    let before = solver.bodies()[0].clone();
    step(&mut solver, 1.0 / 60.0);
    let after = &solver.bodies()[0];
    for part in [0.0, 0.25, 1.0] {
        let pose = solver.interpolated_poses(part)[0];
        assert!((pose.position - before.position.lerp(after.position, part)).length() < 1e-12);
        assert!((pose.angle - (before.angle + (after.angle - before.angle) * part)).abs() < 1e-12);
    }
}
