//! The instruction set that the environment asks for.

use unipbd_core::simd;

/// The environment variable that names one. Empty, it is as if it were not set.
pub const VARIABLE: &str = "UNIPBD_SIMD";

/// Uses the instruction set that the environment asks for, from now on in this process.
///
/// # Errors
/// A sentence, where this machine does not have it or another one is in use.
pub fn from_environment() -> Result<(), String> {
    let word = std::env::var_os(VARIABLE).unwrap_or_default();
    match word.to_string_lossy().trim() {
        "" => Ok(()),
        word => simd::choose(word).map_err(|wrong| format!("{VARIABLE} {wrong}")),
    }
}
