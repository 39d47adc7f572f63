//! Lattice samples that fill a shape.

use super::Shape;
use crate::math::Vector64;

/// Points that represent equal parts of a shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Points, in the coordinates of the shape \[m]; their mean is the centroid.
    pub points: Vec<Vector64>,
    /// Area of each [m^2]: together exactly the area of the shape, close to the spacing squared.
    pub area: f64,
}

/// Cell centres of a lattice in the bounding box that lie inside the shape.
pub(super) fn fill(shape: &Shape, spacing: f64) -> Samples {
    let moments = shape.moments();
    let (low, high) = shape.bounds();
    let counts = ((high - low) / spacing).round().max(Vector64::ONE);
    // For a box the lattice fits exactly; for a disc it has the true spacing and a node at the centre.
    let cell = if matches!(shape, Shape::Polygon(_)) { (high - low) / counts } else { Vector64::splat(spacing) };
    let start = (low + high - cell * (counts - Vector64::ONE)) * 0.5;
    let mut points = Vec::new();
    for row in 0..counts.y as usize {
        for column in 0..counts.x as usize {
            let point = start + cell * Vector64::new(column as f64, row as f64);
            // On the outline itself the result would depend on rounding, and differ between two sides.
            if shape.contains(point) && shape.nearest(point).distance < -1e-6 * spacing {
                points.push(point);
            }
        }
    }
    if points.is_empty() {
        points.push(moments.centroid);
    }
    let count = points.len() as f64;
    let shift = moments.centroid - points.iter().sum::<Vector64>() / count;
    points.iter_mut().for_each(|point| *point += shift);
    Samples { points, area: moments.area / count }
}

impl Shape {
    /// Lower left and upper right corner of the box around the shape \[m].
    pub(crate) fn bounds(&self) -> (Vector64, Vector64) {
        match self {
            Shape::Disc { radius } => (Vector64::splat(-radius), Vector64::splat(*radius)),
            Shape::Polygon(corners) => {
                let wide = (Vector64::INFINITY, Vector64::NEG_INFINITY);
                corners.iter().fold(wide, |(low, high), &c| (low.min(c), high.max(c)))
            }
        }
    }
}
