//! Diagnostics as dicts with the same keys, whether of a run or from a log.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_cli::read::DiagnosticsRecord;
use unipbd_core::Phase;
use unipbd_core::observe::Diagnostics;

/// Entries that have one name everywhere.
macro_rules! copy_entries {
    ($dict:ident, $from:ident: $($name:ident),*) => { $( $dict.set_item(stringify!($name), $from.$name)?; )* };
}

macro_rules! common {
    ($dict:ident, $from:ident) => {
        copy_entries!($dict, $from: time, frame, step, substeps, iterations, list_builds, density_error_mean,
            density_error_max, density_error_min, pressure_max, kinetic_energy, potential_energy, angular_momentum,
            speed_max);
        $dict.set_item("energy", $from.kinetic_energy + $from.potential_energy)?;
        let materials = PyDict::new($dict.py());
        for material in &$from.materials {
            let entry = PyDict::new($dict.py());
            copy_entries!(entry, material: count, density_error_mean, density_error_max, density_error_min);
            materials.set_item(&material.name, entry)?;
        }
        $dict.set_item("materials", materials)?;
        let groups = PyDict::new($dict.py());
        for group in &$from.groups {
            groups.set_item(&group.name, group.violation)?;
        }
        $dict.set_item("groups", groups)?;
    };
}

/// Those of a run.
pub fn running<'py>(py: Python<'py>, of: &Diagnostics) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    common!(dict, of);
    copy_entries!(dict, of: substeps_wanted, contact_penetration);
    dict.set_item("substeps_reason", of.substeps_reason.name())?;
    dict.set_item("momentum", (of.momentum.x, of.momentum.y))?;
    dict.set_item("walls", walls(py, of.walls.iter().map(|wall| (&wall.name, wall.force.x, wall.force.y)))?)?;
    dict.set_item("counts", counts(py, of.count_by_phase)?)?;
    Ok(dict)
}

/// Those from a log.
pub fn recorded<'py>(py: Python<'py>, of: &DiagnosticsRecord) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    common!(dict, of);
    dict.set_item("momentum", (of.momentum_x, of.momentum_y))?;
    dict.set_item("walls", walls(py, of.walls.iter().map(|wall| (&wall.name, wall.force_x, wall.force_y)))?)?;
    let by_phase = [of.count_liquid, of.count_gas, of.count_smoke, of.count_rigid, of.count_solid];
    dict.set_item("counts", counts(py, by_phase.map(u64::from))?)?;
    dict.set_item("state_hash", u64::from_str_radix(&of.state_hash, 16).ok())?;
    Ok(dict)
}

/// Forces by the names of walls.
fn walls<'py, 'a>(
    py: Python<'py>,
    forces: impl Iterator<Item = (&'a String, f64, f64)>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, x, y) in forces {
        dict.set_item(name, (x, y))?;
    }
    Ok(dict)
}

/// Particles by the name of their phase.
pub fn counts(py: Python<'_>, by_phase: [u64; Phase::ALL.len()]) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (phase, count) in Phase::ALL.into_iter().zip(by_phase) {
        dict.set_item(phase.name(), count)?;
    }
    Ok(dict)
}
