//! Numbers and vectors. The only file that names a float type for particle columns.
//!
//! Particle columns and kernels use [`Real`] (f32, or f64 with the `f64` feature); body poses,
//! impulses and everything summed over many particles use f64.

#[cfg(not(feature = "f64"))]
mod precision {
    /// Scalar of the particle columns.
    pub type Real = f32;
    /// 2D vector of the particle columns.
    pub type Vector = glam::Vec2;
    /// Four scalars side by side.
    pub type Quad = glam::Vec4;
}
#[cfg(feature = "f64")]
mod precision {
    /// Scalar of the particle columns.
    pub type Real = f64;
    /// 2D vector of the particle columns.
    pub type Vector = glam::DVec2;
    /// Four scalars side by side.
    pub type Quad = glam::DVec4;
}
pub(crate) use precision::Quad;
pub use precision::{Real, Vector};

/// 2D vector in double precision: body poses, scene coordinates, sums.
pub type Vector64 = glam::DVec2;

/// Rounds a double-precision scalar to the particle precision.
#[inline]
pub fn real(value: f64) -> Real {
    value as Real
}

/// Rounds a double-precision vector to the particle precision.
#[inline]
pub fn vector(value: Vector64) -> Vector {
    Vector::new(value.x as Real, value.y as Real)
}

/// The larger one; `b` where `a` is not a number. (`Real::max` minds either, at three times the cost.)
#[inline(always)]
pub fn larger(a: Real, b: Real) -> Real {
    if a > b { a } else { b }
}

/// The smaller one; `b` where `a` is not a number.
#[inline(always)]
pub fn smaller(a: Real, b: Real) -> Real {
    if a < b { a } else { b }
}

/// Widens a particle vector to double precision.
#[inline]
pub fn wide(value: Vector) -> Vector64 {
    #[allow(clippy::unnecessary_cast)]
    Vector64::new(value.x as f64, value.y as f64)
}

/// The unit vector at an angle from the x axis \[rad].
///
/// The functions beyond square roots are those of the crate `libm` throughout the core: systems round theirs
/// differently, and a scene shall give the same bits on all of them.
#[inline]
pub fn direction(angle: f64) -> Vector64 {
    let (sin, cos) = libm::sincos(angle);
    Vector64::new(cos, sin)
}

/// The angle of a vector from the x axis \[rad].
#[inline]
pub fn angle_of(vector: Vector64) -> f64 {
    libm::atan2(vector.y, vector.x)
}

/// The product of two rows of three numbers: forces with torques, displacements with rotations.
pub(crate) fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
