use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the `unipbd` command line with these arguments, the name of the program first, and returns
/// its exit code.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| unipbd_cli::main_with_args(arguments).code())
}
