//! The parts of a grid line inside the outline of a body: exact for polygons and discs.

use crate::bytes::held;
use crate::math::Vector64;
use crate::rigid::{Body, Pose};

/// An outline in the world, ready to be cut by grid lines.
#[derive(Default)]
pub(super) struct Outline {
    centre: Vector64,
    radius: f64,
    /// Corners of a polygon; empty for a disc.
    corners: Vec<Vector64>,
    /// Lowest and highest corner of the box around it.
    pub bounds: [Vector64; 2],
    crossings: Vec<f64>,
}

impl Outline {
    /// Takes the outline of a body in this pose.
    pub fn take(&mut self, body: &Body, pose: Pose) {
        (self.centre, self.radius) = (pose.position, body.radius);
        self.corners.clear();
        self.corners.extend(body.outline.iter().map(|&corner| pose.apply(corner)));
        let reach = Vector64::splat(body.radius);
        let (mut low, mut high) = match self.corners.first() {
            Some(&first) => (first, first),
            None => (pose.position - reach, pose.position + reach),
        };
        for corner in &self.corners {
            (low, high) = (low.min(*corner), high.max(*corner));
        }
        self.bounds = [low, high];
    }

    /// The intervals inside the outline along the line on which the coordinate `across` has this value; by increasing
    /// coordinate.
    pub fn cut(&mut self, across: usize, value: f64, intervals: &mut Vec<[f64; 2]>) {
        intervals.clear();
        let along = 1 - across;
        if self.corners.is_empty() {
            let off = value - self.centre[across];
            let square = self.radius * self.radius - off * off;
            if square > 0.0 {
                let half = square.sqrt();
                intervals.push([self.centre[along] - half, self.centre[along] + half]);
            }
            return;
        }
        let crossings = &mut self.crossings;
        crossings.clear();
        let mut before = self.corners[self.corners.len() - 1];
        for &corner in &self.corners {
            // A corner on the line belongs to the edges on one side of it.
            if (before[across] > value) != (corner[across] > value) {
                let part = (value - before[across]) / (corner[across] - before[across]);
                crossings.push(before[along] + part * (corner[along] - before[along]));
            }
            before = corner;
        }
        crossings.sort_by(f64::total_cmp);
        intervals.extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
    }
}

impl Outline {
    /// Memory held \[bytes].
    pub fn memory_bytes(&self) -> usize {
        held(&self.corners) + held(&self.crossings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::{Bodies, BodyKind, BodySpec};
    use crate::shapes::Shape;

    fn outline(shape: Shape, pose: Pose) -> Outline {
        let mut bodies = Bodies::new(0.1);
        bodies.add(BodySpec { kind: BodyKind::Static, pose, ..BodySpec::new(shape) }).unwrap();
        let mut outline = Outline::default();
        outline.take(&bodies.views()[0], bodies.pose(0));
        outline
    }

    fn area(outline: &mut Outline, across: usize) -> f64 {
        let (mut sum, mut intervals, lines) = (0.0, Vec::new(), 20_000);
        let (low, high) = (outline.bounds[0][across], outline.bounds[1][across]);
        for line in 0..lines {
            outline.cut(across, low + (high - low) * (f64::from(line) + 0.5) / f64::from(lines), &mut intervals);
            sum += intervals.iter().map(|[from, to]| to - from).sum::<f64>() * (high - low) / f64::from(lines);
        }
        sum
    }

    #[test]
    fn lines_cut_the_area_along_both_axes() {
        let pose = Pose { position: Vector64::new(0.3, -0.2), angle: 0.4 };
        let star = (0..10).map(|k| {
            let radius = if k % 2 == 0 { 1.0 } else { 0.4 };
            crate::math::direction(0.2 * std::f64::consts::PI * f64::from(k)) * radius
        });
        for shape in [Shape::rectangle(2.0, 0.5), Shape::Disc { radius: 0.7 }, Shape::Polygon(star.collect())] {
            let exact = shape.moments().area;
            let mut outline = outline(shape, pose);
            for across in [0, 1] {
                let found = area(&mut outline, across);
                assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
            }
        }
    }
}
