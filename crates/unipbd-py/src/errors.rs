//! Errors as the exceptions of `unipbd._errors`, with their fields.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use unipbd_cli::read::LogError;
use unipbd_cli::record::RecordError;
use unipbd_cli::scene_file::{Diagnostic, Origin, SceneFileError};
use unipbd_core::{EditError, SolverError, StateError};

/// An exception of the package, made from keyword arguments.
fn exception(py: Python<'_>, class: &str, fields: &Bound<'_, PyDict>) -> PyErr {
    let made = py
        .import("unipbd._errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call((), Some(fields)));
    made.map_or_else(|error| error, PyErr::from_value)
}

fn plain(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let fields = PyDict::new(py);
    match fields.set_item("message", message) {
        Ok(()) => exception(py, class, &fields),
        Err(error) => error,
    }
}

/// `StateError`.
pub fn state(py: Python<'_>, error: &StateError) -> PyErr {
    plain(py, "StateError", &error.to_string())
}

/// `EditError`.
pub fn edit(py: Python<'_>, error: &EditError) -> PyErr {
    plain(py, "EditError", &error.to_string())
}

/// `EditError` with words of our own.
pub fn edit_message(py: Python<'_>, message: &str) -> PyErr {
    plain(py, "EditError", message)
}

/// `RecordingError`.
pub fn record(py: Python<'_>, error: &RecordError) -> PyErr {
    plain(py, "RecordingError", &error.to_string())
}

/// `RecordingError` for a log that cannot be read.
pub fn log(py: Python<'_>, error: &LogError) -> PyErr {
    plain(py, "RecordingError", &error.to_string())
}

/// `UnipbdError` for what has no class of its own.
pub fn other(py: Python<'_>, message: &str) -> PyErr {
    plain(py, "UnipbdError", message)
}

/// The simulation is in use: by a hook of its own, or by another thread.
pub fn busy(py: Python<'_>) -> PyErr {
    let message = "the simulation is being stepped; in a hook, use what the hook is given";
    plain(py, "BusyError", message)
}

/// `SolverError`.
pub fn solver(py: Python<'_>, error: &SolverError) -> PyErr {
    let fields = PyDict::new(py);
    let filled = (|| {
        fields.set_item("message", error.to_string())?;
        if let SolverError::Hook { step, time, particle, material, .. } = error {
            fields.set_item("stage", "hook")?;
            fields.set_item("step", step)?;
            fields.set_item("time", time)?;
            fields.set_item("particle", particle)?;
            fields.set_item("material", material)?;
        }
        if let SolverError::Body { step, time, .. } = error {
            fields.set_item("stage", "end_of_frame")?;
            fields.set_item("step", step)?;
            fields.set_item("time", time)?;
        }
        if let SolverError::Diverged { stage, step, time, particle, material, .. } = error {
            fields.set_item("stage", stage)?;
            fields.set_item("step", step)?;
            fields.set_item("time", time)?;
            fields.set_item("particle", particle)?;
            fields.set_item("material", material)?;
        }
        Ok(())
    })();
    filled.map_or_else(|error| error, |()| exception(py, "SolverError", &fields))
}

/// Whether a scene came from a file, so that lines and columns mean something to its author.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Written {
    /// By its author.
    InFile,
    /// By this package, from a dict.
    FromDict,
}

/// `SceneError` with all its problems; `FileNotFoundError` and the like for a file that cannot be read.
pub fn scene(py: Python<'_>, error: SceneFileError, written: Written) -> PyErr {
    match error {
        SceneFileError::Io { path, error } => {
            let kind = std::io::Error::new(error.kind(), format!("cannot read the scene {}: {error}", path.display()));
            kind.into()
        }
        SceneFileError::Invalid { ref file, ref problems } => {
            scene_error(py, &error, file, problems, written).unwrap_or_else(|error| error)
        }
    }
}

fn scene_error(
    py: Python<'_>,
    error: &SceneFileError,
    file: &str,
    problems: &[Diagnostic],
    written: Written,
) -> PyResult<PyErr> {
    let entries = problems.iter().map(|problem| entry(py, problem, written)).collect::<PyResult<Vec<_>>>()?;
    let fields = PyDict::new(py);
    let message = match written {
        Written::InFile => error.to_string().trim_end().to_owned(),
        Written::FromDict => problems.iter().map(in_words).collect::<Vec<_>>().join("\n"),
    };
    fields.set_item("message", message)?;
    fields.set_item("path", (written == Written::InFile).then_some(file))?;
    fields.set_item("problems", entries)?;
    Ok(exception(py, "SceneError", &fields))
}

fn in_words(problem: &Diagnostic) -> String {
    let key = if problem.key.is_empty() { "scene" } else { &problem.key };
    match &problem.hint {
        Some(hint) => format!("{key}: {} ({hint})", problem.message),
        None => format!("{key}: {}", problem.message),
    }
}

fn entry<'py>(py: Python<'py>, problem: &Diagnostic, written: Written) -> PyResult<Bound<'py, PyDict>> {
    let entry = PyDict::new(py);
    let in_file = written == Written::InFile && matches!(problem.origin, Origin::File(_));
    entry.set_item("line", in_file.then_some(problem.line))?;
    entry.set_item("column", in_file.then_some(problem.column))?;
    entry.set_item("key", &problem.key)?;
    entry.set_item("message", &problem.message)?;
    entry.set_item("hint", problem.hint.as_deref())?;
    Ok(entry)
}
