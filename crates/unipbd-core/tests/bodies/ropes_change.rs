//! Ropes come, are cut and go while a run goes on.

use super::common::{ALL, build, floored, free, go_on_after_each, named, step};
use unipbd_core::Solver;
use unipbd_core::edit::Edit;
use unipbd_core::scene::{Block, BodyDescription, Held, Link, Liquid, Rope, Scene, Solid, Substeps, Tank, Tethers};

/// A rope from a nail in the world.
fn line(from: [f64; 2], to: [f64; 2], body: Option<&str>) -> Rope {
    Rope {
        material: "hemp".into(),
        from,
        to,
        length: None,
        compliance: 0.0,
        held: Held::From,
        link: Link::Rope,
        tethers: Tethers::All,
        body: body.map(str::to_owned),
        from_body: None,
    }
}

fn ball(name: &str, position: [f64; 2]) -> BodyDescription {
    named(name, BodyDescription::disc(0.15, position))
}

fn with_hemp(scene: Scene) -> Scene {
    Scene { solid: vec![Solid { name: "hemp".into(), ..Solid::default() }], ..scene }
}

fn lowest(solver: &Solver, rope: usize) -> f64 {
    let points = &solver.ropes()[rope].points;
    let rows = (0..solver.ids().len()).filter(|&row| points.contains(&solver.ids()[row]));
    rows.map(|row| f64::from(solver.positions()[row].y)).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_rope_catches_a_ball_holds_it_and_lets_it_fall_when_it_is_cut() {
    for substeps in ALL {
        let mut solver = build(&with_hemp(free(substeps, vec![ball("ball", [0.0, -0.5])])));
        step(&mut solver, 0.2);
        let at = solver.bodies()[0].position;
        let slack = Rope { length: Some(1.0), ..line([0.0, at.y + 0.7], [at.x, at.y], Some("ball")) };
        solver.apply(&Edit::new().add_rope(slack)).expect("there is a ball");
        assert_eq!(solver.ropes()[0].points.len(), 21);
        step(&mut solver, 3.0);
        let hangs = at.y + 0.7 - solver.bodies()[0].position.y;
        println!("{substeps:?}: hangs {hangs:.4} m below the nail");
        assert!((hangs - 1.0).abs() < 0.01 && solver.bodies()[0].velocity.length() < 0.05);
        solver.apply(&Edit::new().cut_rope(0, 10)).expect("it is whole");
        step(&mut solver, 0.5);
        assert!((solver.bodies()[0].velocity.y + 0.5 * 9.81).abs() < 0.3, "it falls");
        let (ids, lost) = (solver.ids().len(), solver.ropes()[0].points.len());
        solver.apply(&Edit::new().remove_rope(0)).expect("it is there");
        assert!(solver.ropes()[0].removed && solver.ids().len() == ids - lost);
        step(&mut solver, 0.2);
        assert!(solver.apply(&Edit::new().cut_rope(0, 3)).is_err());
    }
}

#[test]
fn half_of_a_rope_that_is_cut_falls_and_half_hangs_on() {
    let mut solver = build(&with_hemp(floored(Substeps::Auto, vec![ball("ball", [9.0, 0.15])])));
    solver.apply(&Edit::new().add_rope(line([0.0, 4.0], [0.0, 3.0], None))).expect("it fits");
    step(&mut solver, 1.0);
    assert!((lowest(&solver, 0) - 3.0).abs() < 0.02);
    solver.apply(&Edit::new().cut_rope(0, 9).add_body(ball("new", [5.0, 1.0]))).expect("it is whole");
    step(&mut solver, 1.5);
    let heights: Vec<f32> = solver.positions().iter().map(|position| position.y).collect();
    let above = heights.iter().filter(|&&y| y > 3.4).count();
    assert!(above == 10 && lowest(&solver, 0) < 0.1, "ten points hang, {above}; the others lie on the floor");
}

#[test]
fn a_rope_of_an_edit_is_that_of_the_scene() {
    let bodies = vec![ball("a", [0.0, 0.0]), ball("b", [1.0, 0.2])];
    let without = with_hemp(free(Substeps::Auto, bodies));
    let ropes = vec![
        line([0.5, 1.0], [0.0, 0.1], Some("a")),
        Rope { from_body: Some("a".into()), ..line([0.1, 0.0], [0.9, 0.2], Some("b")) },
    ];
    let mut of_scene = build(&Scene { rope: ropes.clone(), ..without.clone() });
    let mut of_edit = build(&without);
    let edit = ropes.into_iter().fold(Edit::new(), Edit::add_rope);
    of_edit.apply(&edit).expect("there are bodies");
    for _ in 0..60 {
        assert_eq!(of_scene.step_frame(), of_edit.step_frame());
        assert_eq!(of_scene.state_hash(), of_edit.state_hash());
    }
    assert_eq!((of_scene.ropes(), of_scene.joints()), (of_edit.ropes(), of_edit.joints()));
}

#[test]
fn changed_ropes_are_saved_and_restored_bit_for_bit() {
    let dry = with_hemp(floored(Substeps::Auto, vec![ball("ball", [0.0, 1.0])]));
    let roped = Scene { rope: vec![line([2.0, 2.0], [2.5, 1.5], None)], ..dry.clone() };
    let mut wet = with_hemp(free(Substeps::Auto, Vec::new()));
    (wet.spacing, wet.tank) = (0.08, vec![Tank::new([-1.0, 0.0], [1.0, 3.0])]);
    wet.liquid = vec![Liquid::new("water", 1000.0)];
    wet.block = vec![Block::new("water", [-1.0, 0.0], [1.0, 0.8])];
    for scene in [dry, roped, wet] {
        let mut solver = build(&scene);
        step(&mut solver, 0.1);
        let number = solver.ropes().len() as u32;
        let rod = Rope { link: Link::Rod, tethers: Tethers::None, ..line([0.3, 2.6], [0.6, 1.9], Some("new")) };
        let edits = [
            Edit::new().add_body(ball("new", [0.6, 1.8])).add_rope(rod),
            Edit::new().add_rope(Rope { held: Held::Both, ..line([-0.8, 2.0], [-0.2, 2.0], None) }),
            Edit::new().cut_rope(number, 2),
            Edit::new().cut_rope(number + 1, 3).remove_rope(number),
            Edit::new().remove_body(solver.bodies().len() as u32).remove_rope(number + 1),
        ];
        go_on_after_each(&scene, &mut solver, edits);
    }
}

#[test]
fn a_faulty_change_of_ropes_changes_nothing() {
    let scene = with_hemp(free(Substeps::Auto, vec![ball("ball", [0.0, 0.0])]));
    let mut solver = build(&Scene { rope: vec![line([2.0, 2.0], [2.5, 1.5], None)], ..scene });
    step(&mut solver, 0.1);
    let (hash, ropes) = (solver.state_hash(), solver.ropes());
    let good = || Edit::new().add_rope(line([0.0, 1.0], [0.0, 0.1], Some("ball"))).cut_rope(0, 1);
    let nowhere = [f64::NAN, 0.0];
    let cases = [
        (good().add_rope(line([0.0, 1.0], [0.0, 0.1], Some("nobody"))), "no body \"nobody\""),
        (good().add_rope(Rope { material: "silk".into(), ..line([0.0, 1.0], [0.0, 0.1], None) }), "silk"),
        (good().add_rope(line(nowhere, [0.0, 0.1], None)), "finite"),
        (good().add_rope(Rope { length: Some(0.5), ..line([0.0, 1.0], [0.0, 0.0], None) }), "shorter"),
        (good().add_rope(Rope { length: Some(1e9), ..line([0.0, 1.0], [0.0, 0.0], None) }), "the new rope"),
        (good().cut_rope(0, 1), "cut already"),
        (good().cut_rope(0, 99), "no piece 99"),
        (good().cut_rope(3, 0), "no rope 3"),
        (good().remove_rope(1).remove_rope(1), "taken away"),
        (good().remove([999_999]), "no particle"),
    ];
    for (edit, expected) in cases {
        let error = solver.apply(&edit).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error} without {expected}");
        assert_eq!((solver.state_hash(), solver.ropes()), (hash, ropes.clone()), "nothing has changed");
    }
    solver.apply(&good()).expect("the good part alone is fine");
}
