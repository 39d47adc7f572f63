//! Emitters come, change and go at run time.

use crate::scenes::{build, build_on, grid, liquid, plume, run};
use unipbd_core::edit::{Edit, EmitterChange};
use unipbd_core::scene::{Emitter, Profile, Scene, Sheath, SmokeSource};
use unipbd_core::{Solver, State};

fn tap() -> Emitter {
    Emitter {
        name: "tap".into(),
        direction: [1.0, 0.0],
        profile: Profile::Parabolic,
        ..Emitter::new("water", [0.5, 3.0], 0.4, 2.0)
    }
}

fn chimney() -> Emitter {
    Emitter {
        name: "chimney".into(),
        temperature: 1.0,
        sheath: Some(Sheath { thickness: 0.12, speed: Some(0.6), temperature: 0.2 }),
        smoke: Some(SmokeSource { material: "soot".into(), per_particle: 2 }),
        ..Emitter::new("air", [1.0, 0.0], 0.2, 1.0)
    }
}

fn go_on(one: &mut Solver, other: &mut Solver, frames: u32) {
    for _ in 0..frames {
        assert_eq!(one.step_frame(), other.step_frame());
        assert_eq!(one.state_hash(), other.state_hash());
    }
    assert_eq!(one.emitters(), other.emitters());
}

fn speed(speed: f64) -> EmitterChange {
    EmitterChange { speed: Some(speed), ..EmitterChange::default() }
}

fn switch(on: bool) -> EmitterChange {
    EmitterChange { on: Some(on), ..EmitterChange::default() }
}

/// Particles that the next frames bring.
fn emitted(solver: &mut Solver, frames: u32) -> u64 {
    (0..frames).map(|_| solver.step_frame().expect("the run is tame").emitted).sum()
}

#[test]
fn a_tap_is_opened_turned_up_closed_and_taken_away() {
    let mut solver = build(&liquid());
    run(&mut solver, 20);
    assert!(solver.emitters().is_empty());
    let off = Edit::new().add_emitter(Emitter { throttle: false, ..tap() }).change_emitter(0, switch(false));
    solver.apply(&off).expect("it fits");
    assert_eq!(emitted(&mut solver, 3), 0);
    solver.apply(&Edit::new().change_emitter(0, switch(true))).expect("it is there");
    let slow = emitted(&mut solver, 30);
    solver.apply(&Edit::new().change_emitter(0, speed(4.0))).expect("it is there");
    let fast = emitted(&mut solver, 30);
    // Four columns at 2 m/s in the middle, 5/6 of it in the mean of a parabola to a half, for half a second; 12 behind.
    println!("{slow} particles, then {fast}");
    assert!((28..=52).contains(&slow) && (60..=76).contains(&fast), "twice as many at twice the speed");
    let kinematic = |solver: &Solver| {
        let free = |row: &usize| solver.particles().inverse_masses()[*row] == 0.0;
        (0..solver.ids().len()).filter(free).count()
    };
    assert_eq!(kinematic(&solver), 12, "three rows behind the face");
    solver.apply(&Edit::new().change_emitter(0, switch(false))).expect("it is there");
    assert_eq!((emitted(&mut solver, 20), kinematic(&solver)), (0, 0));
    assert!(!solver.emitters()[0].running);
    solver.apply(&Edit::new().change_emitter(0, switch(true))).expect("it is there");
    assert!(emitted(&mut solver, 20) > 40 && solver.emitters()[0].running);
    solver.apply(&Edit::new().remove_emitter(0)).expect("it is there");
    assert_eq!(kinematic(&solver), 0, "they are let go");
    assert_eq!(emitted(&mut solver, 20), 0);
    assert!(solver.emitters()[0].removed);
    assert!(solver.apply(&Edit::new().remove_emitter(0)).is_err());
}

#[test]
fn changed_emitters_are_saved_and_restored_bit_for_bit() {
    for (scene, new) in [(liquid(), tap()), (grid(), tap()), (plume(), chimney())] {
        let mut solver = build(&scene);
        run(&mut solver, 3);
        let early = solver.save();
        let number = solver.emitters().len() as u32;
        solver.apply(&Edit::new().add_emitter(new)).expect("it fits");
        for edit in [
            Edit::new().change_emitter(number, speed(0.7)),
            Edit::new().change_emitter(number, switch(false)),
            Edit::new().change_emitter(0, switch(true)),
            Edit::new().remove_emitter(number),
        ] {
            run(&mut solver, 5);
            let state = State::from_bytes(&solver.save().to_bytes()).expect("it is whole");
            let mut fresh = build_on(&scene, 3);
            fresh.restore(&state).expect("it is a state of this scene");
            go_on(&mut fresh, &mut solver, 3);
            for solver in [&mut solver, &mut fresh] {
                solver.apply(&edit).expect("it is there");
            }
            go_on(&mut fresh, &mut solver, 3);
        }
        let mut fresh = build(&scene);
        fresh.restore(&early).expect("it is a state of this scene");
        solver.restore(&early).expect("it is a state of this scene");
        assert_eq!((solver.emitters().len() as u32, solver.stages()), (number, fresh.stages()));
        go_on(&mut fresh, &mut solver, 5);
    }
}

#[test]
fn a_faulty_change_of_emitters_changes_nothing() {
    let mut solver = build(&plume());
    run(&mut solver, 5);
    let hash = solver.state_hash();
    let good = || Edit::new().change_emitter(0, speed(0.5)).add_emitter(chimney()).remove_emitter(0);
    let cases = [
        (good().add_emitter(chimney()), "already"),
        (good().add_emitter(Emitter { name: String::new(), material: "wine".into(), ..chimney() }), "wine"),
        (good().add_emitter(Emitter { name: String::new(), speed: -1.0, ..chimney() }), "speed"),
        (good().add_emitter(Emitter { name: String::new(), width: f64::NAN, ..chimney() }), "width"),
        (good().add_emitter(Emitter { name: String::new(), width: 1e12, ..chimney() }), "particles"),
        (good().change_emitter(1, speed(f64::INFINITY)), "speed"),
        (good().change_emitter(0, speed(1.0)), "taken away"),
        (good().change_emitter(7, speed(1.0)), "no emitter 7"),
        (good().remove_emitter(0), "taken away"),
    ];
    for (edit, expected) in cases {
        let error = solver.apply(&edit).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error} without {expected}");
        assert_eq!((solver.state_hash(), solver.emitters().len()), (hash, 1));
    }
    solver.apply(&good()).expect("the good part alone is fine");
    run(&mut solver, 5);
}

#[test]
fn an_emitter_of_a_scene_is_that_of_an_edit_at_the_start() {
    let with = Scene { emitter: vec![tap()], ..liquid() };
    let (mut of_scene, mut of_edit) = (build(&with), build(&liquid()));
    of_edit.apply(&Edit::new().add_emitter(tap())).expect("it fits");
    for _ in 0..30 {
        assert_eq!(of_scene.step_frame().map(|report| report.emitted), of_edit.step_frame().map(|r| r.emitted));
    }
    assert_eq!(of_scene.ids().len(), of_edit.ids().len());
}
