use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Substeps, Tank};
use unipbd_core::{BuildOptions, Solver};

/// A column of water, twice as high as wide, of about this many particles, in a tank 3.2 times as wide.
pub fn dam_break(particles: usize) -> Scene {
    let across = (particles as f64 / 2.0).sqrt().round();
    let spacing = 1.0 / across;
    Scene {
        spacing,
        liquid: vec![water()],
        block: vec![Block::new("water", [0.0, 0.0], [1.0, 2.0])],
        tank: vec![Tank::new([0.0, 0.0], [3.2, 4.0])],
        ..Scene::default()
    }
}

/// A square pool at rest of about this many particles, 16 substeps a frame.
pub fn pool(particles: usize) -> Scene {
    let across = (particles as f64).sqrt().round();
    Scene {
        spacing: 1.0 / across,
        liquid: vec![water()],
        block: vec![Block::new("water", [0.0, 0.0], [1.0, 1.0])],
        tank: vec![Tank::new([0.0, 0.0], [1.0, 2.0])],
        solver: SolverSettings { substeps: Substeps::Fixed(16), ..SolverSettings::default() },
        ..Scene::default()
    }
}

fn water() -> Liquid {
    Liquid { xsph: 0.01, ..Liquid::new("water", 1000.0) }
}

/// A solver of a scene on this many threads.
///
/// # Panics
/// On a faulty scene.
pub fn solver(scene: &Scene, threads: usize) -> Solver {
    let options = BuildOptions { threads: Some(threads), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}
