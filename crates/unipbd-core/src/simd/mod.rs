//! The passes over all pairs of neighbours: where a step spends its time.
//!
//! Each pass is one function over plain columns. It picks the widest instruction set of the machine
//! once per chunk of rows and works on eight rows at a time, straight from the blocks of the
//! [`NeighborList`]. Beside its lane form every pass has a scalar form, which is what it computes:
//! all forms give the same bits, because none of them fuses or reorders an operation, and square
//! roots and quotients are exact everywhere. With the `f64` feature only the scalar forms exist.
//!
//! In the formulas x_ij = x_i - x_j (the shortest image of it), W is the kernel and grad W = g x_ij
//! its gradient at x_i. A row's own contribution W(0) is left out.

pub(crate) mod near;
mod passes;
mod records;
mod shapes;
pub(crate) mod space;
pub(crate) mod weigh;

#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
mod avx512;
#[cfg(not(feature = "f64"))]
mod lanes;
#[cfg(not(feature = "f64"))]
mod portable;
#[cfg(not(feature = "f64"))]
mod run;
#[cfg(all(target_arch = "x86_64", not(feature = "f64")))]
mod x86;

pub use passes::{
    DensityInput, DensityOutput, Pairs, Reach, Weights, correction, density, difference_gradient, laplacian, repulsion,
    vorticity, xsph, xsph_mixed,
};
pub use records::Records;
pub use shapes::{Alternative, CubicSpline, Mixed, Number, Poly6, Shape, SlopeAsValue, Spiky, Tensile, WendlandC2};

/// An instruction set that passes are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One row at a time: the oracle of the others.
    Scalar,
    /// Arrays of eight, in whatever instructions the target has.
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
