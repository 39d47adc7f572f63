//! Runs a scene frame by frame and counts what it costs.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use unipbd_core::math::{Vector64, vector, wide};
use unipbd_core::scene::Scene;
use unipbd_core::{BuildOptions, Edit, MaterialIndex, Solver, SolverError};

/// Why a case gave nothing.
#[derive(Clone, Debug)]
pub struct Failure(pub String);

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.0)
    }
}

impl std::error::Error for Failure {}

/// Cost of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// Wall-clock time of the steps, on one thread.
    pub wall: Duration,
    /// Processor time of the steps: what else the machine does is not in it.
    pub processor: Duration,
    /// Pairs of particles visited: two passes per iteration over pi (h/dx)^2 neighbours each.
    pub pair_visits: f64,
    /// Particles at the end.
    pub particles: usize,
    /// Substeps in all.
    pub substeps: u64,
}

impl Cost {
    /// The sum of two runs.
    pub fn and(self, other: Cost) -> Cost {
        Cost {
            wall: self.wall + other.wall,
            processor: self.processor + other.processor,
            pair_visits: self.pair_visits + other.pair_visits,
            particles: self.particles.max(other.particles),
            substeps: self.substeps + other.substeps,
        }
    }
}

/// A running case.
pub struct Runner {
    /// The solver.
    pub solver: Solver,
    /// So far.
    pub cost: Cost,
    /// Most frames of a stretch.
    pub most: u32,
    neighbors: f64,
}

impl Runner {
    /// Builds a scene on one thread.
    ///
    /// # Errors
    /// When the scene is refused.
    pub fn new(scene: &Scene) -> Result<Runner, Failure> {
        let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
        let solver = scene.build(options).map_err(|problems| Failure(problems.to_string()))?;
        let radius = scene.solver.kernel_radius;
        let neighbors = std::f64::consts::PI * radius * radius;
        Ok(Runner { solver, cost: Cost::default(), most: u32::MAX, neighbors })
    }

    /// Advances by one frame.
    ///
    /// # Errors
    /// When the run diverges.
    pub fn frame(&mut self) -> Result<(), Failure> {
        self.frame_under(None)
    }

    /// Advances by one frame under an acceleration that depends on the place [m/s^2].
    fn frame_under(&mut self, field: Option<&dyn Fn(Vector64) -> Vector64>) -> Result<(), Failure> {
        let (start, processor) = (Instant::now(), ProcessTime::now());
        let report = match field {
            None => self.solver.step_frame(),
            Some(field) => self.solver.step_frame_with(|substep| -> Result<(), SolverError> {
                for row in 0..substep.positions().len() {
                    let pull = field(wide(substep.positions()[row]));
                    substep.add_acceleration(row, vector(pull));
                }
                Ok(())
            }),
        }
        .map_err(|error| Failure(error.to_string()))?;
        self.cost.wall += start.elapsed();
        self.cost.processor += processor.elapsed();
        self.cost.substeps += u64::from(report.substeps);
        self.cost.particles = self.solver.positions().len();
        let iterations = f64::from(self.solver.iterations());
        self.cost.pair_visits += 2.0 * iterations * self.neighbors * self.solver.particles().dense() as f64;
        Ok(())
    }

    /// Advances by a stretch of this many frames, or as many as are allowed, and looks after each.
    ///
    /// # Errors
    /// When the run diverges.
    pub fn frames(&mut self, count: u32, mut look: impl FnMut(&Solver)) -> Result<(), Failure> {
        for _ in 0..count.min(self.most) {
            self.frame()?;
            look(&self.solver);
        }
        Ok(())
    }

    /// Advances by a stretch of frames under an acceleration that depends on the place [m/s^2], as
    /// [`frames`](Self::frames) does without.
    ///
    /// # Errors
    /// When the run diverges.
    pub fn frames_under(
        &mut self,
        count: u32,
        field: impl Fn(Vector64) -> Vector64,
        mut look: impl FnMut(&Solver),
    ) -> Result<(), Failure> {
        for _ in 0..count.min(self.most) {
            self.frame_under(Some(&field))?;
            look(&self.solver);
        }
        Ok(())
    }

    /// Moves every particle of the start by a field \[m].
    ///
    /// # Errors
    /// When the solver refuses the positions.
    pub fn displace(&mut self, field: impl Fn(Vector64) -> Vector64) -> Result<(), Failure> {
        let positions: Vec<Vector64> = points(&self.solver).map(|x| x + field(x)).collect();
        self.edit(|edit, ids| edit.set_positions(ids, positions))
    }

    /// Gives every particle the velocity of a field [m/s].
    ///
    /// # Errors
    /// When the solver refuses the velocities.
    pub fn stir(&mut self, field: impl Fn(Vector64) -> Vector64) -> Result<(), Failure> {
        let velocities: Vec<Vector64> = points(&self.solver).map(field).collect();
        self.edit(|edit, ids| edit.set_velocities(ids, velocities))
    }

    fn edit(&mut self, change: impl FnOnce(Edit, Vec<u32>) -> Edit) -> Result<(), Failure> {
        let ids = self.solver.ids().to_vec();
        let edit = change(Edit::new(), ids);
        self.solver.apply(&edit).map(|_| ()).map_err(|error| Failure(error.to_string()))
    }
}

/// All positions \[m].
pub fn points(solver: &Solver) -> impl Iterator<Item = Vector64> + '_ {
    solver.positions().iter().map(|position| wide(*position))
}

/// All velocities [m/s].
pub fn velocities(solver: &Solver) -> impl Iterator<Item = Vector64> + '_ {
    solver.velocities().iter().map(|velocity| wide(*velocity))
}

/// Positions of one material \[m].
pub fn points_of(solver: &Solver, material: MaterialIndex) -> impl Iterator<Item = Vector64> + '_ {
    points(solver).zip(solver.material_indices()).filter(move |(_, of)| **of == material).map(|(x, _)| x)
}

/// Kinetic and potential energy \[J].
pub fn energy(solver: &Solver) -> f64 {
    let diagnostics = solver.diagnostics();
    diagnostics.kinetic_energy + diagnostics.potential_energy
}
