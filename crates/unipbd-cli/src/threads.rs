//! How many threads a run uses: one rule for the command line, Python and the environment.

use unipbd_core::step::thread_count;

/// The environment variable that is read where no number is given. Empty, it is as if it were not set.
pub const VARIABLE: &str = "UNIPBD_THREADS";

/// The number that an argument or the environment asks for; `None` for all that the machine has.
///
/// # Errors
/// A sentence that names the setting at fault.
pub fn wanted(given: Option<&str>) -> Result<Option<usize>, String> {
    if let Some(text) = given {
        return thread_count(text).map(Some).map_err(|wrong| format!("threads {wrong}"));
    }
    let set = std::env::var_os(VARIABLE).unwrap_or_default();
    let text = set.to_string_lossy();
    if text.trim().is_empty() {
        return Ok(None);
    }
    thread_count(&text).map(Some).map_err(|wrong| format!("{VARIABLE} {wrong}"))
}
