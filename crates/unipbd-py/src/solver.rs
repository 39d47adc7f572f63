//! The simulation: what Python steps, looks at and edits.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::PyTraverseError;
use pyo3::exceptions::PyValueError;
use pyo3::gc::PyVisit;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use unipbd_cli::simulation::{Simulation, stage_names};
use unipbd_core::observe::WallOutline;
use unipbd_core::{BuildOptions, Phase};

use crate::edit::{Addition, Values};
use crate::group::{Callable, Failure, PythonGroup};
use crate::picture::Look;
use crate::state::State;
use crate::world::{World, severity};
use crate::{arrays, body, diagnostics, edit, errors, picture, scene, world_edit};

/// A simulation. One thread at a time uses it.
#[pyclass(frozen, module = "unipbd._native")]
pub struct Solver {
    world: Arc<Mutex<World>>,
    /// The functions of the groups, for the garbage collector.
    callables: Mutex<Vec<Callable>>,
}

impl Solver {
    /// The world, unless a step is under way.
    pub fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, World>> {
        match self.world.try_lock() {
            Ok(world) => Ok(world),
            // The core keeps its invariants or stops the run: what is left can be looked at.
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(errors::busy(py)),
        }
    }

    /// The world for a thread that Python knows nothing of.
    pub fn shared(&self) -> Arc<Mutex<World>> {
        Arc::clone(&self.world)
    }

    /// Reads from the run, with its rows in the order of their ids.
    fn read<T>(&self, py: Python<'_>, take: impl FnOnce(&unipbd_core::Solver, &[u32]) -> T) -> PyResult<T> {
        let mut world = self.lock(py)?;
        world.order();
        let world = &*world;
        Ok(take(&world.running.solver, world.order.as_deref().unwrap_or_default()))
    }
}

#[pymethods]
impl Solver {
    #[new]
    fn new(
        py: Python<'_>,
        description: &Bound<'_, PyDict>,
        seed: Option<u64>,
        threads: Option<usize>,
        settled: bool,
    ) -> PyResult<Self> {
        unipbd_cli::instruction_set::from_environment().map_err(PyValueError::new_err)?;
        let scene = scene::from_dict(py, description)?;
        let options = BuildOptions { threads, seed };
        let running = if settled {
            let mut build = scene.clone().into_scene();
            build.solver.settle_substeps = Some(0);
            let build = build.check().map_err(|problems| errors::other(py, &problems.to_string()))?;
            py.detach(|| Simulation::new(&build, options))
        } else {
            py.detach(|| Simulation::new(&scene, options))
        };
        let world = World {
            running,
            scene,
            unrecorded: Vec::new(),
            has_groups: false,
            failure: Failure::default(),
            order: None,
        };
        Ok(Solver { world: Arc::new(Mutex::new(world)), callables: Mutex::new(Vec::new()) })
    }

    /// A simulation is often in the closure of its own group.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        let Ok(callables) = self.callables.try_lock() else { return Ok(()) };
        callables.iter().try_for_each(|callable| callable.traverse(&visit))
    }

    fn __clear__(&self) {
        let callables = self.callables.try_lock().map(|mut callables| std::mem::take(&mut *callables));
        callables.unwrap_or_default().iter().for_each(Callable::clear);
    }

    /// Advances by this many frames.
    fn step(&self, py: Python<'_>, frames: u64, hooks: Vec<Py<PyAny>>) -> PyResult<()> {
        let mut world = self.lock(py)?;
        world.frames(py, frames, &hooks)
    }

    /// What happened since the last call: (time, severity, message).
    fn take_events(&self, py: Python<'_>) -> PyResult<Vec<(f64, &'static str, String)>> {
        let mut world = self.lock(py)?;
        let events = world.running.solver.take_events();
        world.unrecorded.extend(events.iter().cloned());
        Ok(events.into_iter().map(|event| (event.time, severity(event.severity), event.message)).collect())
    }

    /// The most time per frame [s], if there is one.
    #[getter]
    fn budget(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        Ok(self.lock(py)?.running.solver.budget().map(|most| most.as_secs_f64()))
    }

    fn set_budget(&self, py: Python<'_>, seconds: Option<f64>) -> PyResult<()> {
        let most = seconds.map(Duration::try_from_secs_f64).transpose();
        let most = most.map_err(|error| PyValueError::new_err(error.to_string()))?;
        self.lock(py)?.running.solver.set_budget(most);
        Ok(())
    }

    fn add_group(&self, py: Python<'_>, name: String, project: Py<PyAny>) -> PyResult<()> {
        let mut world = self.lock(py)?;
        let failure = world.failure.clone();
        let project = Callable::new(project);
        self.callables.lock().unwrap_or_else(PoisonError::into_inner).push(project.clone());
        let speed_limit = world.running.solver.speed_limit();
        world.running.solver.add_group(Box::new(PythonGroup { name, project, failure, speed_limit }));
        world.has_groups = true;
        Ok(())
    }

    fn apply(
        &self,
        py: Python<'_>,
        changes: Vec<(String, Vec<u32>, Values<'_>)>,
        removals: Vec<u32>,
        additions: Vec<Addition<'_>>,
        bodies: Vec<(u32, [f64; 2], f64)>,
        changed: Vec<Bound<'_, PyDict>>,
    ) -> PyResult<(u32, u32)> {
        let mut world = self.lock(py)?;
        let edit = edit::edit(py, changes, removals, additions, bodies)?;
        let edit = world_edit::with_changes(py, edit, changed)?;
        world.order = None;
        let solver = &mut world.running.solver;
        let added = py.detach(|| solver.apply(&edit)).map_err(|error| errors::edit(py, &error))?;
        Ok((added.start, added.end))
    }

    fn save(&self, py: Python<'_>) -> PyResult<State> {
        let world = self.lock(py)?;
        let solver = &world.running.solver;
        Ok(State { state: py.detach(|| solver.save()) })
    }

    fn restore(&self, py: Python<'_>, state: &State) -> PyResult<()> {
        let mut world = self.lock(py)?;
        world.order = None;
        let solver = &mut world.running.solver;
        py.detach(|| solver.restore(&state.state)).map_err(|error| errors::state(py, &error))
    }

    fn state_hash(&self, py: Python<'_>) -> PyResult<u64> {
        let world = self.lock(py)?;
        let solver = &world.running.solver;
        Ok(py.detach(|| solver.state_hash()))
    }

    fn diagnostics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let world = self.lock(py)?;
        let solver = &world.running.solver;
        let found = py.detach(|| solver.diagnostics());
        diagnostics::running(py, &found)
    }

    /// Readings of the gauges by name.
    fn gauges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let world = self.lock(py)?;
        let solver = &world.running.solver;
        let dict = PyDict::new(py);
        for gauge in py.detach(|| solver.gauges()) {
            dict.set_item(gauge.name, gauge.value)?;
        }
        Ok(dict)
    }

    /// Wall-clock time by stage since the start [s].
    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (stage, spent) in self.lock(py)?.running.solver.timings() {
            dict.set_item(stage, spent.as_secs_f64())?;
        }
        Ok(dict)
    }

    fn stages(&self, py: Python<'_>) -> PyResult<Vec<&'static str>> {
        Ok(stage_names(&self.lock(py)?.running.solver))
    }

    fn groups(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let groups = self.lock(py)?.running.solver.diagnostics().groups;
        Ok(groups.into_iter().map(|group| group.name).collect())
    }

    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.lock(py)?.running.solver.time())
    }

    #[getter]
    fn frame(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.lock(py)?.running.solver.frame())
    }

    /// Frames the scene lasts.
    #[getter]
    fn frames(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.lock(py)?.running.frames)
    }

    #[getter]
    fn substeps_done(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.lock(py)?.running.solver.step())
    }

    #[getter]
    fn frame_time(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.lock(py)?.running.solver.frame_time())
    }

    #[getter]
    fn spacing(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.lock(py)?.running.solver.spacing())
    }

    #[getter]
    fn seed(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.lock(py)?.running.solver.seed())
    }

    #[getter]
    fn threads(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.lock(py)?.running.solver.threads())
    }

    fn set_threads(&self, py: Python<'_>, threads: usize) -> PyResult<()> {
        self.lock(py)?.running.solver.set_threads(threads);
        Ok(())
    }

    #[getter]
    fn memory_bytes(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.lock(py)?.running.solver.memory_bytes())
    }

    /// Number of particles.
    #[getter]
    fn count(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.lock(py)?.running.solver.ids().len())
    }

    /// Particles by the name of their phase.
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut by_phase = [0; Phase::ALL.len()];
        for phase in self.lock(py)?.running.solver.phases() {
            by_phase[*phase as usize] += 1;
        }
        diagnostics::counts(py, by_phase)
    }

    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.read(py, |solver, rows| arrays::vectors(py, solver.positions(), rows))?
    }

    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.read(py, |solver, rows| arrays::vectors(py, solver.velocities(), rows))?
    }

    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        self.read(py, |solver, rows| arrays::gathered(py, solver.ids(), rows, |id| id))
    }

    fn phases<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u8>>> {
        self.read(py, |solver, rows| arrays::gathered(py, solver.phases(), rows, |phase| phase as u8))
    }

    fn material_indices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u16>>> {
        self.read(py, |solver, rows| arrays::gathered(py, solver.material_indices(), rows, |material| material))
    }

    fn inverse_masses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.read(py, |solver, rows| arrays::gathered(py, solver.particles().inverse_masses(), rows, arrays::single))
    }

    fn density_errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.read(py, |solver, rows| {
            let errors = py.detach(|| solver.density_errors());
            arrays::gathered(py, errors, rows, arrays::single)
        })
    }

    fn pressures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.read(py, |solver, rows| {
            let pressures = py.detach(|| solver.pressures());
            arrays::gathered(py, pressures, rows, f64::from)
        })
    }

    /// None where the scene has no temperatures.
    fn temperatures<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        let gas = !self.lock(py)?.scene.gas.is_empty();
        self.read(py, |solver, rows| {
            let temperatures = solver.temperatures();
            (gas || !temperatures.is_empty()).then(|| arrays::gathered(py, temperatures, rows, arrays::single))
        })
    }

    /// Name, phase, density and colour of each material, by index.
    fn materials(&self, py: Python<'_>) -> PyResult<Vec<(String, u8, f64, String)>> {
        let world = self.lock(py)?;
        let shown = |material: &unipbd_core::observe::Material| {
            let [red, green, blue] = material.color;
            let color = format!("#{red:02x}{green:02x}{blue:02x}");
            (material.name.clone(), material.phase as u8, material.density, color)
        };
        Ok(world.running.solver.materials().iter().map(shown).collect())
    }

    /// Walls as lines to draw; a closed one ends where it begins.
    fn walls<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let world = self.lock(py)?;
        let line = |wall: &WallOutline| {
            let last = wall.points.first().filter(|_| wall.closed);
            let points: Vec<_> = wall.points.iter().chain(last).copied().collect();
            body::points(py, &points)
        };
        world.running.solver.wall_outlines().iter().map(line).collect()
    }

    #[getter]
    fn gravity(&self, py: Python<'_>) -> PyResult<(f64, f64)> {
        let gravity = self.lock(py)?.running.solver.gravity();
        Ok((gravity.x, gravity.y))
    }

    /// A quantity of a body, by name.
    fn body_quantity<'py>(&self, py: Python<'py>, index: usize, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let world = self.lock(py)?;
        let body = world.running.solver.bodies().get(index).ok_or_else(|| errors::other(py, "no such body"))?;
        body::quantity(py, body, name)
    }

    /// The present frame as the bytes of a PNG file.
    fn png<'py>(&self, py: Python<'py>, look: Look) -> PyResult<Bound<'py, PyBytes>> {
        let world = self.lock(py)?;
        Ok(PyBytes::new(py, &picture::png(py, &world, &look)?))
    }

    /// The present frame as an array (height, width, 3).
    fn pixels<'py>(&self, py: Python<'py>, look: Look) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let world = self.lock(py)?;
        picture::pixels(py, &world, &look)
    }

    /// The scene as TOML text.
    fn scene_text(&self, py: Python<'_>) -> PyResult<String> {
        self.lock(py)?.scene_text(py)
    }
}
