//! A scene in motion: a solver that knows when its scene is over.

use std::path::Path;

use unipbd_core::math::{Real, Vector};
use unipbd_core::scene::{CheckedScene, Scene};
use unipbd_core::{BuildOptions, FrameReport, Solver, SolverError};

use crate::record::Fields;
use crate::snapshot::{Setting, Snapshot};

/// A solver and the number of frames its scene lasts.
pub struct Simulation {
    /// The solver.
    pub solver: Solver,
    /// Frames from start to end.
    pub frames: u64,
}

impl Simulation {
    /// Builds the solver of a scene.
    pub fn new(scene: &CheckedScene, options: BuildOptions) -> Self {
        Simulation { solver: scene.build(options), frames: frame_count(scene) }
    }

    /// Advances by a frame; `None` at the end of the scene.
    pub fn next_frame(&mut self) -> Option<Result<FrameReport, SolverError>> {
        (self.solver.frame() < self.frames).then(|| self.solver.step_frame())
    }

    /// The state as plain arrays with the columns asked for.
    pub fn snapshot(&self, fields: Fields) -> Snapshot {
        let solver = &self.solver;
        Snapshot {
            time: solver.time(),
            positions: solver.positions().iter().map(pair).collect(),
            ids: solver.ids().to_vec(),
            phases: solver.phases().to_vec(),
            materials: solver.material_indices().to_vec(),
            velocities: fields.velocity.then(|| solver.velocities().iter().map(pair).collect()),
            density_errors: fields.density.then(|| single(solver.density_errors())),
            temperatures: (fields.temperature && !solver.temperatures().is_empty())
                .then(|| single(solver.temperatures())),
            bodies: solver.bodies().to_vec(),
        }
    }

    /// Constant data of the run.
    pub fn setting(&self, scene: &Scene, path: &Path) -> Setting {
        Setting {
            name: title(scene, path),
            spacing: self.solver.spacing(),
            materials: self.solver.materials().to_vec(),
            walls: self.solver.wall_outlines().to_vec(),
            view: scene.view.min.zip(scene.view.max),
        }
    }
}

/// Names of the stages of a substep, in order.
pub fn stage_names(solver: &Solver) -> Vec<&'static str> {
    solver.stages().iter().map(|stage| stage.name()).collect()
}

/// Frames of a scene: the last one ends at or after its duration.
pub fn frame_count(scene: &Scene) -> u64 {
    (scene.duration * scene.fps * (1.0 - 1e-12)).ceil() as u64
}

/// The name of a scene, or that of its file where it has none.
pub fn title(scene: &Scene, path: &Path) -> String {
    if scene.name.is_empty() {
        path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    } else {
        scene.name.clone()
    }
}

#[allow(clippy::unnecessary_cast)]
fn pair(vector: &Vector) -> [f32; 2] {
    [vector.x as f32, vector.y as f32]
}

#[allow(clippy::unnecessary_cast)]
fn single(values: &[Real]) -> Vec<f32> {
    values.iter().map(|value| *value as f32).collect()
}
