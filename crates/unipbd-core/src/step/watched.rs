//! Density errors of a material, and what is known about them from frame to frame.

use crate::math::Real;

/// History of the density errors of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Watched {
    /// Frames in a row that it was far off.
    pub frames: u32,
    pub warned: bool,
}

/// Density errors of a material.
#[derive(Clone, Copy, Default)]
pub(super) struct Errors {
    pub count: u64,
    pub sum: f64,
    pub size: f64,
    /// Row of the largest |C|.
    pub worst: usize,
    pub largest: Real,
}
