//! Small scenes of every kind.

use unipbd_core::scene::{
    Block, BodyDescription, Disc, Emitter, Environment, Gas, LegacyKernel, LegacySettings, Liquid, PointMotion, Points,
    PressureGridUse, Profile, Scene, Sheath, Smoke, SmokeSource, Solid, SolverSettings, Substeps, Tank,
};
use unipbd_core::{BuildOptions, Solver};

pub fn block(material: &str, min: [f64; 2], max: [f64; 2]) -> Block {
    Block { material: material.into(), min, max, velocity: [0.0; 2], jitter: 0.0, temperature: 0.0 }
}

pub fn points(material: &str, positions: &[[f64; 2]]) -> Points {
    Points {
        material: material.into(),
        positions: positions.to_vec(),
        velocity: [0.0; 2],
        velocities: Vec::new(),
        temperature: 0.0,
        motion: PointMotion::Free,
    }
}

fn tank(width: f64) -> Tank {
    Tank { open: Vec::new(), friction: Some(0.1), ..Tank::new([0.0, 0.0], [width, 4.0]) }
}

/// A column of water collapses.
pub fn liquid() -> Scene {
    Scene {
        liquid: vec![Liquid { name: "water".into(), xsph: 0.01, ..Liquid::default() }],
        block: vec![block("water", [0.0, 0.0], [1.0, 2.0])],
        tank: vec![tank(2.5)],
        ..Scene::default()
    }
}

/// A hot jet of gas with smoke, in gusts; gas and smoke are removed again.
pub fn plume() -> Scene {
    let emitter = Emitter {
        name: "nozzle".into(),
        profile: Profile::Uniform,
        temperature: 1.0,
        sheath: Some(Sheath { thickness: 0.15, speed: None, temperature: 0.0 }),
        smoke: Some(SmokeSource { material: "soot".into(), per_particle: 2 }),
        ..Emitter::new("air", [0.0, 0.0], 0.2, 1.2)
    };
    let air = Gas { drag: 30.0, vorticity: 2.0, lifetime: Some(0.6), keep_radius: Some(0.3), ..Gas::default() };
    Scene {
        spacing: 0.04,
        seed: 3,
        environment: Environment { gusts: 0.3, ..Environment::default() },
        gas: vec![Gas { name: "air".into(), conductivity: 1e-3, ..air }],
        smoke: vec![Smoke { name: "soot".into(), lifetime: Some(0.7), ..Smoke::default() }],
        emitter: vec![emitter],
        ..Scene::default()
    }
}

/// Two liquids, gas above them, solid points, a kinematic particle.
pub fn mixed() -> Scene {
    let kinematic = Points { velocity: [0.2, 0.0], motion: PointMotion::Kinematic, ..points("oil", &[[1.0, 1.6]]) };
    Scene {
        solver: SolverSettings { substeps: Substeps::Fixed(6), settle_substeps: Some(5), ..SolverSettings::default() },
        liquid: vec![
            Liquid { name: "water".into(), ..Liquid::default() },
            Liquid { name: "oil".into(), density: 800.0, xsph: 0.05, ..Liquid::default() },
        ],
        gas: vec![Gas { name: "air".into(), ..Gas::default() }],
        solid: vec![Solid { name: "beads".into(), ..Solid::default() }],
        block: vec![
            Block { jitter: 0.1, ..block("water", [0.0, 0.0], [2.0, 1.0]) },
            Block { temperature: 0.5, ..block("air", [0.0, 2.0], [2.0, 3.0]) },
        ],
        disc: vec![Disc {
            material: "oil".into(),
            center: [0.5, 1.5],
            radius: 0.3,
            velocity: [0.5, 0.0],
            jitter: 0.0,
            temperature: 0.0,
        }],
        points: vec![points("beads", &[[1.0, 3.5], [1.2, 3.5]]), kinematic],
        tank: vec![tank(2.0)],
        ..Scene::default()
    }
}

/// Boxes and a disc fall into a pool, and onto each other.
pub fn bodies() -> Scene {
    let raft = BodyDescription { density: 400.0, ..BodyDescription::rectangle([0.6, 0.3], [0.6, 1.3]) };
    let stone = BodyDescription { density: 2500.0, ..BodyDescription::disc(0.2, [0.7, 1.8]) };
    let boxes = BodyDescription::rectangle([0.3, 0.3], [1.7, 1.4]);
    Scene {
        liquid: vec![Liquid { name: "water".into(), ..Liquid::default() }],
        block: vec![block("water", [0.0, 0.0], [2.5, 1.0])],
        body: vec![raft, stone, boxes],
        tank: vec![tank(2.5)],
        ..Scene::default()
    }
}

/// The same column with the pressure grid.
pub fn grid() -> Scene {
    let solver = SolverSettings {
        pressure_grid: PressureGridUse::On,
        substeps: Substeps::Fixed(4),
        ..SolverSettings::default()
    };
    Scene { solver, ..liquid() }
}

/// The same bodies and pool with the options that are there for comparison.
pub fn legacy() -> Scene {
    let legacy = LegacySettings {
        kernel: LegacyKernel::CubicSpline,
        constraint_mixing: 0.5,
        artificial_pressure: 0.02,
        mass_density: None,
        averaged_contacts: Some(1.0),
        mass_scaling: 1.0,
    };
    Scene { legacy, ..bodies() }
}

pub fn all() -> [(&'static str, Scene); 6] {
    [
        ("liquid", liquid()),
        ("plume", plume()),
        ("mixed", mixed()),
        ("bodies", bodies()),
        ("grid", grid()),
        ("legacy", legacy()),
    ]
}

pub fn build(scene: &Scene) -> Solver {
    build_on(scene, 1)
}

pub fn build_on(scene: &Scene, threads: usize) -> Solver {
    let options = BuildOptions { threads: Some(threads), ..BuildOptions::default() };
    scene.build(options).unwrap_or_else(|problems| panic!("{problems}"))
}

pub fn run(solver: &mut Solver, frames: usize) {
    for _ in 0..frames {
        solver.step_frame().expect("the run is tame");
    }
}
