//! Questions to a simulation: bodies as arrays, joints, emitters, ropes, contacts, rays, places.

use numpy::ndarray::Array2;
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_core::Vector64;
use unipbd_core::edit::EmitterReading;
use unipbd_core::rigid::contact::JointKind;
use unipbd_core::rigid::{Body, Pose};
use unipbd_core::scene::Emitter;
use unipbd_core::step::{Query, Solid};

use crate::errors;
use crate::solver::Solver;

/// Rows of three numbers that cannot be written to.
fn triples(py: Python<'_>, flat: Vec<f64>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let shape = (flat.len() / 3, 3);
    let array = Array2::from_shape_vec(shape, flat).map_err(|error| errors::other(py, &error.to_string()))?;
    let array = PyArray2::from_owned_array(py, array);
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// Numbers and names of the bodies that are there.
#[pyfunction]
pub fn body_roster(py: Python<'_>, solver: &Solver) -> PyResult<Vec<(usize, String)>> {
    let world = solver.lock(py)?;
    let there = world.running.solver.bodies().iter().enumerate().filter(|(_, body)| !body.removed);
    Ok(there.map(|(number, body)| (number, body.name.clone())).collect())
}

/// x, y and angle of each body that is there; between the last two frames where `part` is below 1.
#[pyfunction]
pub fn body_poses<'py>(py: Python<'py>, solver: &Solver, part: f64) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let world = solver.lock(py)?;
    let solver = &world.running.solver;
    let between = if part == 1.0 { Vec::new() } else { solver.interpolated_poses(part) };
    let pose = |(number, body): (usize, &Body)| {
        let Pose { position, angle } = between.get(number).copied().unwrap_or_else(|| body.pose());
        [position.x, position.y, angle]
    };
    let there = solver.bodies().iter().enumerate().filter(|(_, body)| !body.removed);
    triples(py, there.flat_map(pose).collect())
}

/// Velocity along x and y, and angular velocity, of each body that is there.
#[pyfunction]
pub fn body_velocities<'py>(py: Python<'py>, solver: &Solver) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let world = solver.lock(py)?;
    let there = world.running.solver.bodies().iter().filter(|body| !body.removed);
    triples(py, there.flat_map(|body| [body.velocity.x, body.velocity.y, body.angular_velocity]).collect())
}

/// Wakes one body with all that sleeps with it, or everything.
#[pyfunction]
pub fn wake(py: Python<'_>, solver: &Solver, body: Option<u32>) -> PyResult<()> {
    let mut world = solver.lock(py)?;
    world.order = None;
    match body {
        Some(body) => drop(world.running.solver.wake_body(body)),
        None => world.running.solver.wake(),
    }
    Ok(())
}

/// All joints as dicts, by number.
#[pyfunction]
pub fn joints<'py>(py: Python<'py>, solver: &Solver) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let world = solver.lock(py)?;
    let solver = &world.running.solver;
    let name = |body: u32| solver.bodies()[body as usize].name.clone();
    let dict = |joint: unipbd_core::rigid::contact::JointState| {
        let dict = PyDict::new(py);
        dict.set_item("name", joint.name)?;
        dict.set_item("kind", kind(&joint.joint.kind))?;
        dict.set_item("body", name(joint.joint.body))?;
        dict.set_item("other", joint.joint.other.map(name))?;
        dict.set_item("force", (joint.force.x, joint.force.y))?;
        dict.set_item("torque", joint.torque)?;
        dict.set_item("broken", joint.broken)?;
        dict.set_item("removed", joint.removed)?;
        Ok(dict)
    };
    solver.joints().into_iter().map(dict).collect()
}

/// Name, material, middle of the face, speed, temperature, whether it runs, whether it was taken away.
type EmitterRow = (String, String, (f64, f64), f64, f64, bool, bool);

/// All emitters, by number.
#[pyfunction]
pub fn emitters(py: Python<'_>, solver: &Solver) -> PyResult<Vec<EmitterRow>> {
    let readings = solver.lock(py)?.running.solver.emitters().into_iter();
    let row = |reading: EmitterReading| {
        let Emitter { name, material, position: [x, y], speed, temperature, .. } = reading.description;
        (name, material, (x, y), speed, temperature, reading.running, reading.removed)
    };
    Ok(readings.map(row).collect())
}

/// Ids of the points, pieces that are cut, whether it was taken away, of each rope.
#[pyfunction]
pub fn ropes(py: Python<'_>, solver: &Solver) -> PyResult<Vec<(Vec<u32>, Vec<u32>, bool)>> {
    let readings = solver.lock(py)?.running.solver.ropes().into_iter();
    Ok(readings.map(|rope| (rope.points.collect(), rope.cuts, rope.removed)).collect())
}

fn kind(kind: &JointKind) -> &'static str {
    match kind {
        JointKind::Hinge { .. } => "hinge",
        JointKind::Distance { .. } => "distance",
        JointKind::Weld { .. } => "weld",
        JointKind::Slider { .. } => "slider",
        JointKind::Pulley { .. } => "pulley",
    }
}

/// Contact points as dicts.
#[pyfunction]
pub fn contacts<'py>(py: Python<'py>, solver: &Solver) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let world = solver.lock(py)?;
    let dict = |point: unipbd_core::rigid::contact::ContactPoint| {
        let dict = PyDict::new(py);
        dict.set_item("body", point.body)?;
        dict.set_item("other", point.other)?;
        dict.set_item("wall", point.wall)?;
        dict.set_item("position", (point.position.x, point.position.y))?;
        dict.set_item("normal", (point.normal.x, point.normal.y))?;
        dict.set_item("gap", point.gap)?;
        dict.set_item("normal_force", point.normal_force)?;
        dict.set_item("friction_force", point.friction_force)?;
        Ok(dict)
    };
    world.running.solver.contacts().into_iter().map(dict).collect()
}

#[pyfunction]
pub fn watch_contacts(py: Python<'_>, solver: &Solver, watch: bool) -> PyResult<()> {
    solver.lock(py)?.running.solver.watch_contacts(watch);
    Ok(())
}

/// First body, second body or wall, impulse.
type Pair = (u32, Option<u32>, Option<u32>, (f64, f64));

/// Pairs that touched in the last frame.
#[pyfunction]
pub fn contact_pairs(py: Python<'_>, solver: &Solver) -> PyResult<Vec<Pair>> {
    let pairs = solver.lock(py)?.running.solver.contact_pairs().into_iter();
    Ok(pairs.map(|pair| (pair.body, pair.other, pair.wall, (pair.impulse.x, pair.impulse.y))).collect())
}

/// Frame, whether it began, first body, second body or wall, whether the first is a sensor.
type Event = (u64, bool, u32, Option<u32>, Option<u32>, bool);

/// Takes the contacts that began and ended.
#[pyfunction]
pub fn take_contact_events(py: Python<'_>, solver: &Solver) -> PyResult<Vec<Event>> {
    let events = solver.lock(py)?.running.solver.take_contact_events().into_iter();
    Ok(events.map(|event| (event.frame, event.began, event.body, event.other, event.wall, event.sensor)).collect())
}

fn chosen<'a>(query: Query<'a>, layers: u32, sensors: bool, walls: bool) -> Query<'a> {
    let query = query.in_layers(layers);
    let query = if sensors { query.with_sensors() } else { query };
    if walls { query } else { query.without_walls() }
}

fn numbers(solid: Solid) -> (Option<u32>, Option<u32>) {
    match solid {
        Solid::Body(body) => (Some(body), None),
        Solid::Wall(wall) => (None, Some(wall)),
    }
}

/// Body or wall, point, normal, part of the way.
type Hit = ((Option<u32>, Option<u32>), (f64, f64), (f64, f64), f64);

/// What a ray meets, the nearest first.
#[pyfunction]
pub fn ray_cast(
    py: Python<'_>,
    solver: &Solver,
    ends: ([f64; 2], [f64; 2]),
    layers: u32,
    sensors: bool,
    walls: bool,
) -> PyResult<Vec<Hit>> {
    let world = solver.lock(py)?;
    let query = chosen(world.running.solver.query(), layers, sensors, walls);
    let hits = query.ray_cast_all(ends.0.into(), ends.1.into()).into_iter();
    let pair = |vector: Vector64| (vector.x, vector.y);
    Ok(hits.map(|hit| (numbers(hit.solid), pair(hit.point), pair(hit.normal), hit.fraction)).collect())
}

/// Bodies that overlap a box, or hold a point where its corners are the same.
#[pyfunction]
pub fn bodies_in(
    py: Python<'_>,
    solver: &Solver,
    corners: ([f64; 2], [f64; 2]),
    layers: u32,
    sensors: bool,
) -> PyResult<Vec<u32>> {
    let world = solver.lock(py)?;
    let query = chosen(world.running.solver.query(), layers, sensors, false);
    let (low, high) = (Vector64::from(corners.0), Vector64::from(corners.1));
    let found = if low == high { query.at(low) } else { query.in_box(low, high) };
    Ok(found.into_iter().filter_map(|solid| numbers(solid).0).collect())
}

/// Body or wall, distance, point, normal of the nearest outline.
type Near = ((Option<u32>, Option<u32>), f64, (f64, f64), (f64, f64));

#[pyfunction]
pub fn nearest(
    py: Python<'_>,
    solver: &Solver,
    point: [f64; 2],
    within: f64,
    layers: u32,
    sensors: bool,
    walls: bool,
) -> PyResult<Option<Near>> {
    let world = solver.lock(py)?;
    let query = chosen(world.running.solver.query(), layers, sensors, walls);
    let pair = |vector: Vector64| (vector.x, vector.y);
    let found = query.nearest(point.into(), within);
    Ok(found.map(|near| (numbers(near.solid), near.distance, pair(near.point), pair(near.normal))))
}
