//! Scenes of bodies, built and stepped.

use unipbd_core::scene::{BodyDescription, HalfPlane, Scene, SolverSettings, Substeps};
use unipbd_core::{BuildOptions, Solver};

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
