//! unipbd on a setup of bodies.

use unipbd_core::scene::{BodyDescription, ContactDescription, HalfPlane, Scene, SolverSettings, Substeps, Tank};
use unipbd_core::{BuildOptions, Solver};

use super::{DENSITY, Engine, FPS, FRICTION, GRAVITY, Kind, Pose, SIZE, Setup};
use crate::readback::ReadBack;

struct Unipbd {
    solver: Solver,
    substeps: u32,
    iterations: u32,
}

/// unipbd by this many substeps of so many iterations.
pub fn engine(setup: &Setup, (substeps, iterations): (u32, u32)) -> Result<Box<dyn Engine>, String> {
    let scene = scene(setup, substeps, iterations);
    let build = || {
        let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
        scene.build(options).map_err(|problems| problems.to_string())
    };
    check(setup, &mut build()?, substeps)?;
    Ok(Box::new(Unipbd { solver: build()?, substeps, iterations }))
}

fn scene(setup: &Setup, substeps: u32, iterations: u32) -> Scene {
    let tank = |width: f64| Tank { friction: Some(FRICTION), ..Tank::new([0.0, 0.0], [width, 1000.0]) };
    let floor = HalfPlane { friction: Some(FRICTION), ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) };
    Scene {
        spacing: SIZE / 10.0,
        gravity: [0.0, -GRAVITY],
        fps: FPS,
        body: setup.places.iter().map(|&place| body(setup.kind, place)).collect(),
        tank: setup.width.map(tank).into_iter().collect(),
        half_plane: if setup.width.is_none() { vec![floor] } else { Vec::new() },
        solver: SolverSettings { substeps: Substeps::Fixed(substeps), ..SolverSettings::default() },
        contacts: ContactDescription { iterations, sleep: false, ..ContactDescription::default() },
        ..Scene::default()
    }
}

fn body(kind: Kind, position: [f64; 2]) -> BodyDescription {
    let square =
        BodyDescription { friction: FRICTION, density: DENSITY, ..BodyDescription::rectangle([SIZE, SIZE], position) };
    match kind {
        Kind::Boxes => square,
        Kind::Discs => BodyDescription { radius: Some(SIZE / 2.0), size: None, ..square },
    }
}

/// Compares a solver, after a frame, with what was asked for.
fn check(setup: &Setup, solver: &mut Solver, substeps: u32) -> Result<(), String> {
    let report = solver.step_frame().map_err(|error| error.to_string())?;
    let body = &solver.bodies()[0];
    ReadBack::default()
        .number("frame", 1.0 / FPS, solver.frame_time())
        .same("substeps", substeps, report.substeps)
        .same("threads", 1, solver.threads())
        .same("bodies", setup.places.len(), solver.bodies().len())
        .number("mass", setup.kind.mass(), body.mass)
        .number("friction", FRICTION, body.surface.kinetic_friction)
        .done()
}

impl Engine for Unipbd {
    fn name(&self) -> String {
        format!("unipbd, {} x {}", self.substeps, self.iterations)
    }

    fn step(&mut self) {
        self.solver.step_frame().expect("the bodies do not diverge");
    }

    fn pose(&self, body: usize) -> Pose {
        let body = &self.solver.bodies()[body];
        Pose { place: body.position.into(), angle: body.angle }
    }
}
