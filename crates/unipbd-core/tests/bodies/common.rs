//! Scenes of bodies, built and stepped.

use unipbd_core::scene::{BodyDescription, HalfPlane, Scene, SolverSettings, Substeps};
use unipbd_core::{BuildOptions, Edit, Solver, State};

pub const ALL: [Substeps; 4] = [Substeps::Auto, Substeps::Fixed(1), Substeps::Fixed(4), Substeps::Fixed(16)];

/// Spacing 0.05 m, gravity, no floor.
pub fn free(substeps: Substeps, body: Vec<BodyDescription>) -> Scene {
    Scene {
        spacing: 0.05,
        gravity: [0.0, -9.81],
        body,
        solver: SolverSettings { substeps, ..SolverSettings::default() },
        ..Scene::default()
    }
}

/// The same on a floor with the default friction.
pub fn floored(substeps: Substeps, body: Vec<BodyDescription>) -> Scene {
    Scene { half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])], ..free(substeps, body) }
}

pub fn named(name: &str, body: BodyDescription) -> BodyDescription {
    BodyDescription { name: name.to_owned(), ..body }
}

pub fn build(scene: &Scene) -> Solver {
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

pub fn step(solver: &mut Solver, seconds: f64) {
    for _ in 0..(seconds * 60.0).round() as u32 {
        solver.step_frame().expect("no body diverges");
    }
}

pub fn run(scene: &Scene, seconds: f64) -> Solver {
    let mut solver = build(scene);
    step(&mut solver, seconds);
    solver
}

/// Makes one edit after the other. After each of them, and from the state before all of them, a run that is restored goes
/// on bit for bit.
pub fn go_on_after_each(scene: &Scene, solver: &mut Solver, edits: impl IntoIterator<Item = Edit>) {
    let early = solver.save();
    for edit in edits {
        solver.apply(&edit).expect("it is sound");
        step(solver, 0.05);
        let state = State::from_bytes(&solver.save().to_bytes()).expect("it is whole");
        let options = BuildOptions { threads: Some(3), ..BuildOptions::default() };
        let mut fresh = scene.build(options).expect("it is sound");
        fresh.restore(&state).expect("it is a state of this scene");
        go_on(&mut fresh, solver);
    }
    solver.restore(&early).expect("it is a state of this scene");
    let mut fresh = build(scene);
    fresh.restore(&early).expect("it is a state of this scene");
    go_on(&mut fresh, solver);
}

fn go_on(one: &mut Solver, other: &mut Solver) {
    for _ in 0..4 {
        assert_eq!(one.step_frame(), other.step_frame());
        assert_eq!(one.state_hash(), other.state_hash());
    }
    assert_eq!(one.bodies(), other.bodies());
    assert_eq!((one.ropes(), one.joints(), one.stages()), (other.ropes(), other.joints(), other.stages()));
}
