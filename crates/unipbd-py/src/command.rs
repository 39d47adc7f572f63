use std::ffi::OsString;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Runs the `unipbd` command line with these arguments, the name of the program first, and returns
/// its exit code.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| unipbd_cli::main_with_args(arguments).code())
}

/// The number of threads that an argument or the environment asks for, by the rule of the command line.
#[pyfunction]
pub fn thread_count(threads: Option<&str>) -> PyResult<Option<usize>> {
    unipbd_cli::threads::wanted(threads).map_err(PyValueError::new_err)
}
