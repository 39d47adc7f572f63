//! Instruction sets: eight lanes of f32 in the vectors of each of them, and the choice at run time.
//!
//! All implementations give the same bits: none of them fuses or reorders an operation, and square roots and
//! quotients are exactly rounded everywhere. With the `f64` feature only scalars exist.

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
pub(crate) mod avx512;
#[cfg(not(feature = "f64"))]
pub(crate) mod lanes;
mod number;
#[cfg(all(
    not(feature = "f64"),
    any(miri, not(any(target_arch = "x86_64", all(target_arch = "wasm32", target_feature = "simd128"))))
))]
pub(crate) mod portable;
pub(crate) mod space;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128", not(feature = "f64")))]
pub(crate) mod wasm;
pub(crate) mod wide;
#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
pub(crate) mod x86;

pub use number::Number;

use crate::math::Vector;
use std::sync::OnceLock;

/// Rows in a block.
pub const LANES: usize = 8;

/// The level that was chosen for this process: the first choice stays.
static CHOSEN: OnceLock<Level> = OnceLock::new();

/// Chooses the level of this name for all that follows in this process, for tests and comparisons: results never depend
/// on it.
///
/// # Errors
/// A sentence, where the word names no level that this machine can run, or another level is in use.
pub fn choose(word: &str) -> Result<(), String> {
    let levels = Level::available();
    let names: Vec<&str> = levels.iter().map(|level| level.name()).collect();
    let found = levels.iter().copied().find(|level| level.name() == word);
    let level = found
        .ok_or_else(|| format!("must be an instruction set of this machine ({}), found {word:?}", names.join(", ")))?;
    let used = *CHOSEN.get_or_init(|| level);
    if used == level { Ok(()) } else { Err(format!("is {word:?}, but {} is in use already", used.name())) }
}

/// Two vectors of one row, read by one load.
pub(crate) type Record = [Vector; 2];

/// An instruction set that passes are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One row at a time: the reference for the others.
    Scalar,
    /// Arrays of eight, compiled to the instructions of the target; only where there is no set with registers below, and
    /// under Miri.
    Portable,
    /// Two vectors of four lanes; every x86-64 has it.
    Sse2,
    /// Two vectors of four lanes, in WebAssembly that was built with them.
    Simd128,
    /// One vector of eight lanes.
    Avx2,
    /// One vector of sixteen lanes: eight rows by two columns of the list.
    Avx512,
}

impl Level {
    /// The levels this machine can run, slowest first.
    pub fn available() -> Vec<Level> {
        let all = [Level::Scalar, Level::Portable, Level::Simd128, Level::Sse2, Level::Avx2, Level::Avx512];
        all.into_iter().filter(|level| level.runs_here()).collect()
    }

    /// The level in use: the fastest of this machine, or that of [`choose`].
    pub fn best() -> Level {
        *CHOSEN.get_or_init(Level::fastest)
    }

    fn fastest() -> Level {
        let fastest_first = [Level::Avx512, Level::Avx2, Level::Sse2, Level::Simd128, Level::Portable];
        fastest_first.into_iter().find(|level| level.runs_here()).unwrap_or(Level::Scalar)
    }

    /// The name of the level.
    pub fn name(self) -> &'static str {
        match self {
            Level::Scalar => "scalar",
            Level::Portable => "portable",
            Level::Sse2 => "sse2",
            Level::Simd128 => "simd128",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        }
    }

    fn runs_here(self) -> bool {
        match self {
            Level::Scalar => true,
            // Arrays compile to ten times the code of registers: they are left out where there are registers.
            Level::Portable => cfg!(all(
                not(feature = "f64"),
                any(miri, not(any(target_arch = "x86_64", all(target_arch = "wasm32", target_feature = "simd128"))))
            )),
            // A module is checked as a whole before it runs: the instructions it was built with are there.
            Level::Simd128 => {
                cfg!(all(target_arch = "wasm32", target_feature = "simd128", not(feature = "f64")))
            }
            #[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
            Level::Sse2 => true,
            #[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
            Level::Avx2 => std::arch::is_x86_feature_detected!("avx2"),
            #[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
            Level::Avx512 => {
                std::arch::is_x86_feature_detected!("avx2")
                    && std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(all(target_arch = "x86_64", not(feature = "f64"))))]
            Level::Sse2 | Level::Avx2 | Level::Avx512 => false,
        }
    }
}
