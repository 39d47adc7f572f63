//! Instruction sets: eight lanes of f32 in the vectors of each of them, and the choice at run time.
//!
//! All implementations give the same bits: none of them fuses or reorders an operation, and square roots and
//! quotients are exactly rounded everywhere. With the `f64` feature only scalars exist.

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
pub(crate) mod avx512;
#[cfg(not(feature = "f64"))]
pub(crate) mod lanes;
mod number;
#[cfg(not(feature = "f64"))]
pub(crate) mod portable;
pub(crate) mod space;
#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
pub(crate) mod x86;

pub use number::Number;

use crate::math::Vector;

/// Rows in a block.
pub const LANES: usize = 8;

/// Two vectors of one row, read by one load.
pub(crate) type Record = [Vector; 2];

/// An instruction set that passes are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One row at a time: the reference for the others.
    Scalar,
    /// Arrays of eight, compiled to the instructions of the target.
    Portable,
    /// Two vectors of four lanes; every x86-64 has it.
    Sse2,
    /// One vector of eight lanes.
    Avx2,
    /// One vector of sixteen lanes: eight rows by two columns of the list.
    Avx512,
}

impl Level {
    /// The levels this machine can run, slowest first.
    pub fn available() -> Vec<Level> {
        let all = [Level::Scalar, Level::Portable, Level::Sse2, Level::Avx2, Level::Avx512];
        all.into_iter().filter(|level| level.runs_here()).collect()
    }

    /// The fastest level of this machine.
    pub fn best() -> Level {
        let fastest_first = [Level::Avx512, Level::Avx2, Level::Sse2, Level::Portable];
        fastest_first.into_iter().find(|level| level.runs_here()).unwrap_or(Level::Scalar)
    }

    fn runs_here(self) -> bool {
        match self {
            Level::Scalar => true,
            Level::Portable => cfg!(not(feature = "f64")),
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
