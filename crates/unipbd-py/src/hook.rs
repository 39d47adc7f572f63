//! The argument of a hook: the simulation at the start of a substep.

use std::sync::{Mutex, PoisonError};

use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use unipbd_core::SubstepView;
use unipbd_core::math::{Vector64, vector};
use unipbd_core::rigid::{BodyKind, Pose, Twist};

use crate::particles::{Particles, checked};
use crate::{arrays, body, errors};

/// The simulation at the start of a substep.
#[pyclass(frozen, extends = Particles, module = "unipbd._native")]
pub struct Substep {
    step: u64,
    /// Name of the hook, for messages.
    hook: String,
    /// From this speed on a run counts as diverged [m/s].
    speed_limit: f64,
    bodies: Vec<Seen>,
    /// What the hook asks for; `None` once the hook has returned.
    wishes: Mutex<Option<Wishes>>,
}

/// A body at the start of a substep.
struct Seen {
    name: String,
    kind: BodyKind,
    pose: Pose,
    velocity: Twist,
}

/// Requests of a hook.
#[derive(Default)]
struct Wishes {
    /// In the order of ids.
    accelerations: Vec<Vector64>,
    velocities: Vec<(u32, Vector64)>,
    loads: Vec<(u32, Twist)>,
    drives: Vec<(u32, Twist)>,
}

/// Calls a hook and carries out what it asks for.
pub fn call(py: Python<'_>, hook: &Py<PyAny>, view: &mut SubstepView<'_>) -> PyResult<()> {
    let particles = Particles::new(view.time(), view.dt(), view.particles());
    let substep = Bound::new(py, (Substep::new(view, name_of(py, hook)), particles))?;
    hook.call1(py, (&substep,))?;
    let wishes = substep.get().wishes.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(wishes) = wishes {
        wishes.carry_out(substep.as_super().get(), view);
    }
    Ok(())
}

/// Name of a function.
pub fn name_of(py: Python<'_>, function: &Py<PyAny>) -> String {
    let named = function.getattr(py, "__qualname__").and_then(|name| name.extract(py));
    named.unwrap_or_else(|_| "a hook".to_owned())
}

impl Wishes {
    fn carry_out(self, particles: &Particles, view: &mut SubstepView<'_>) {
        if !self.accelerations.is_empty() {
            let accelerations = view.accelerations_mut();
            particles.scatter(&self.accelerations, |row, wanted| accelerations[row] += wanted);
        }
        for (row, velocity) in self.velocities {
            view.set_velocity(row as usize, vector(velocity));
        }
        for (body, velocity) in self.drives {
            view.set_body_velocity(body, velocity);
        }
        for (body, load) in self.loads {
            view.push_body(body, load.linear, load.angular);
        }
    }

    fn accelerate(&mut self, count: usize, wanted: impl Iterator<Item = Vector64>) {
        self.accelerations.resize(count, Vector64::ZERO);
        self.accelerations.iter_mut().zip(wanted).for_each(|(sum, wanted)| *sum += wanted);
    }
}

impl Substep {
    fn new(view: &SubstepView<'_>, hook: String) -> Self {
        let seen = |(body, number): (&unipbd_core::rigid::Body, u32)| Seen {
            name: if body.removed { String::new() } else { body.name.clone() },
            kind: body.kind,
            pose: view.body_pose(number),
            velocity: view.body_velocity(number),
        };
        let bodies = view.bodies().iter().zip(0..).map(seen).collect();
        let wishes = Mutex::new(Some(Wishes::default()));
        Substep { step: view.step(), hook, speed_limit: view.speed_limit(), bodies, wishes }
    }

    fn with_wishes<T>(&self, py: Python<'_>, change: impl FnOnce(&mut Wishes) -> T) -> PyResult<T> {
        let mut wishes = self.wishes.lock().unwrap_or_else(PoisonError::into_inner);
        match &mut *wishes {
            Some(wishes) => Ok(change(wishes)),
            None => Err(errors::other(py, "the substep is over: use it within the hook only")),
        }
    }

    /// Refuses what would make a run diverge at once: a value that, times `duration`, is beyond the speed limit.
    fn check_speed(&self, values: &[Vector64], does: &str, duration: f64, unit: &str) -> PyResult<()> {
        let limit = self.speed_limit / duration;
        let Some(row) = values.iter().position(|value| value.length() >= limit) else { return Ok(()) };
        let Vector64 { x, y } = values[row];
        let message = format!(
            "the hook {} {does} by ({x:e}, {y:e}) {unit} in row {row}; the limit is {limit:.3e} {unit}",
            self.hook
        );
        Err(PyValueError::new_err(message))
    }

    /// Whether this can be asked of a body.
    fn check(&self, number: u32, asked: Twist, works: impl Fn(BodyKind) -> bool) -> PyResult<()> {
        let body = self.bodies.get(number as usize).ok_or_else(|| PyValueError::new_err("there is no such body"))?;
        if !works(body.kind) {
            let (name, kind) = (&body.name, body::kind(body.kind));
            return Err(PyValueError::new_err(format!("the body \"{name}\" is {kind}: that does not move it")));
        }
        let single = asked.angular as f32;
        match checked(&[asked.linear], 1) {
            Ok(_) if single.is_finite() => Ok(()),
            _ => Err(PyValueError::new_err(format!("what is asked of the body \"{}\" is not finite", body.name))),
        }
    }
}

#[pymethods]
impl Substep {
    #[getter]
    fn step(&self) -> u64 {
        self.step
    }

    /// Name, position, angle, velocity and angular velocity of each body.
    fn bodies(&self) -> Vec<(String, [f64; 2], f64, [f64; 2], f64)> {
        let seen = |body: &Seen| {
            let (pose, velocity) = (body.pose, body.velocity);
            let (position, linear) = (pose.position.into(), velocity.linear.into());
            (body.name.clone(), position, pose.angle, linear, velocity.angular)
        };
        self.bodies.iter().map(seen).collect()
    }

    /// Adds one acceleration for each particle.
    fn add_accelerations(slf: &Bound<'_, Self>, accelerations: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let count = slf.as_super().get().count();
        let wanted = checked(&arrays::rows(&accelerations), count)?;
        slf.get().check_speed(&wanted, "accelerates particles", slf.as_super().get().dt, "m/s^2")?;
        slf.get().with_wishes(slf.py(), |wishes| wishes.accelerate(count, wanted.into_iter()))
    }

    /// Adds the same acceleration for every particle.
    fn add_uniform_acceleration(slf: &Bound<'_, Self>, x: f64, y: f64) -> PyResult<()> {
        let count = slf.as_super().get().count();
        let wanted = checked(&[Vector64::new(x, y)], 1)?[0];
        slf.get().check_speed(&[wanted], "accelerates particles", slf.as_super().get().dt, "m/s^2")?;
        slf.get().with_wishes(slf.py(), |wishes| wishes.accelerate(count, std::iter::repeat_n(wanted, count)))
    }

    /// Sets the velocities of these particles: how kinematic ones are moved.
    fn set_velocities(slf: &Bound<'_, Self>, ids: Vec<u32>, velocities: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let velocities = checked(&arrays::rows(&velocities), ids.len())?;
        slf.get().check_speed(&velocities, "moves particles", 1.0, "m/s")?;
        let particles = slf.as_super().get();
        let mut wanted = Vec::with_capacity(ids.len());
        for (id, velocity) in ids.into_iter().zip(velocities) {
            let unknown = || PyValueError::new_err(format!("there is no particle with id {id}"));
            wanted.push((particles.row(id).ok_or_else(unknown)?, velocity));
        }
        slf.get().with_wishes(slf.py(), |wishes| wishes.velocities.extend(wanted))
    }

    /// Lets a force and a torque act on a dynamic body.
    fn push_body(&self, py: Python<'_>, body: u32, force: [f64; 2], torque: f64) -> PyResult<()> {
        let load = Twist { linear: force.into(), angular: torque };
        self.check(body, load, |kind| kind == BodyKind::Dynamic)?;
        self.with_wishes(py, |wishes| wishes.loads.push((body, load)))
    }

    /// Sets the velocity of a body.
    fn drive_body(&self, py: Python<'_>, body: u32, velocity: [f64; 2], angular_velocity: f64) -> PyResult<()> {
        let velocity = Twist { linear: velocity.into(), angular: angular_velocity };
        self.check(body, velocity, |kind| kind != BodyKind::Static)?;
        self.check_speed(&[velocity.linear], "drives a body", 1.0, "m/s")?;
        self.with_wishes(py, |wishes| wishes.drives.push((body, velocity)))
    }
}
