//! Shapes in the plane: outlines, their areas and moments, signed distances, lattice samples, and
//! the convex pieces used for contacts.

mod core_pieces;
mod decompose;
mod polygon;
mod sampling;

#[doc(hidden)]
pub use core_pieces::{ConvexPiece, Core};
#[doc(hidden)]
pub use decompose::convex_decomposition;
#[doc(hidden)]
pub use polygon::Moments;
pub(crate) use polygon::{edges, first_crossing, nearest as nearest_on_polygon};
#[doc(hidden)]
pub use sampling::Samples;

use crate::math::{Vector64, direction};
use std::f64::consts::{PI, TAU};

/// The outline of a solid, in its own coordinates.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Shape {
    /// A disc about the origin.
    Disc {
        /// Radius \[m].
        radius: f64,
    },
    /// A simple polygon, convex or not: corners in order, of either orientation \[m].
    Polygon(Vec<Vector64>),
}

/// Reasons why a shape is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeError {
    /// A coordinate or radius is not finite.
    NotFinite,
    /// The shape has no area.
    NoArea,
    /// A polygon has fewer than three corners.
    TooFewCorners,
    /// Two edges of a polygon cross or touch.
    SelfIntersecting,
}

impl std::fmt::Display for ShapeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            ShapeError::NotFinite => "a coordinate of the shape is not a finite number",
            ShapeError::NoArea => "the shape has no area",
            ShapeError::TooFewCorners => "a polygon needs at least three corners",
            ShapeError::SelfIntersecting => "edges of the polygon cross or touch each other",
        })
    }
}

impl std::error::Error for ShapeError {}

/// The nearest point of a boundary to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance to the boundary, negative inside the solid \[m].
    pub distance: f64,
    /// Unit gradient of the distance: out of the solid.
    pub normal: Vector64,
}

impl Shape {
    /// A rectangle centred on the origin.
    pub fn rectangle(width: f64, height: f64) -> Shape {
        let half = Vector64::new(width, height) * 0.5;
        let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        Shape::Polygon(signs.iter().map(|&(x, y)| Vector64::new(x, y) * half).collect())
    }

    /// A regular polygon centred on the origin, the first corner on the x axis.
    pub fn regular(corners: usize, circumradius: f64) -> Shape {
        let corner = |k: usize| direction(TAU * k as f64 / corners as f64) * circumradius;
        Shape::Polygon((0..corners).map(corner).collect())
    }

    /// Returns an error if the shape is invalid.
    pub fn check(&self) -> Result<(), ShapeError> {
        match self {
            Shape::Disc { radius } if !radius.is_finite() => Err(ShapeError::NotFinite),
            Shape::Disc { radius } if *radius <= 0.0 => Err(ShapeError::NoArea),
            Shape::Disc { .. } => Ok(()),
            Shape::Polygon(corners) => polygon::check(corners),
        }
    }

    /// The same shape with a polygon counter-clockwise and without repeated or straight corners.
    pub fn tidied(&self) -> Shape {
        match self {
            Shape::Disc { radius } => Shape::Disc { radius: *radius },
            Shape::Polygon(corners) => Shape::Polygon(polygon::tidied(corners)),
        }
    }

    /// Area, centroid and second moment.
    pub fn moments(&self) -> Moments {
        match self {
            Shape::Disc { radius } => {
                let square = radius * radius;
                Moments { area: PI * square, centroid: Vector64::ZERO, second: 0.5 * PI * square * square }
            }
            Shape::Polygon(corners) => polygon::moments(corners),
        }
    }

    /// Twice the area over the perimeter: the thickness of a long shape, the radius of a disc \[m].
    pub fn thickness(&self) -> f64 {
        let perimeter = match self {
            Shape::Disc { radius } => TAU * radius,
            Shape::Polygon(corners) => edges(corners).map(|(from, to)| (to - from).length()).sum(),
        };
        2.0 * self.moments().area / perimeter
    }

    /// The shape moved by `offset`; a disc stays about the origin.
    pub fn translated(&self, offset: Vector64) -> Shape {
        match self {
            Shape::Disc { radius } => Shape::Disc { radius: *radius },
            Shape::Polygon(corners) => Shape::Polygon(corners.iter().map(|&c| c + offset).collect()),
        }
    }

    /// Radius of the smallest disc about the origin that contains the shape \[m].
    pub fn bounding_radius(&self) -> f64 {
        match self {
            Shape::Disc { radius } => *radius,
            Shape::Polygon(corners) => corners.iter().map(|c| c.length()).fold(0.0, f64::max),
        }
    }

    /// Signed distance and outward normal at a point in the coordinates of the shape.
    pub fn nearest(&self, point: Vector64) -> Nearest {
        match self {
            Shape::Disc { radius } => {
                let length = point.length();
                let normal = if length > 0.0 { point / length } else { Vector64::Y };
                Nearest { distance: length - radius, normal }
            }
            Shape::Polygon(corners) => polygon::nearest(corners, point),
        }
    }

    /// Whether a point lies inside.
    pub fn contains(&self, point: Vector64) -> bool {
        match self {
            Shape::Disc { radius } => point.length_squared() < radius * radius,
            Shape::Polygon(corners) => polygon::contains(corners, point),
        }
    }

    /// Lattice samples that fill the shape, for the density of a fluid around it.
    pub fn samples(&self, spacing: f64) -> Samples {
        sampling::fill(self, spacing)
    }

    /// The convex pieces used for contacts.
    pub fn core(&self) -> Core {
        core_pieces::core(self)
    }
}
