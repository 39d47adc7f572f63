//! Outlines that never move, as walls of a grid.

use super::{Form, Moment, Outlines, Spot};
use crate::math::{Real, Vector, Vector64, direction, smaller, vector, wide};
use crate::shapes::{Shape, edges};
use std::f64::consts::TAU;

/// A straight part of the surface of a fixed outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OutlineSurface {
    /// Number of the outline.
    pub outline: usize,
    /// Ends \[m].
    pub ends: [Vector; 2],
    /// Direction out, of length 1.
    pub normal: Vector,
}

impl Outlines {
    /// Advances whenever outlines come, go or are put elsewhere by an edit.
    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// The fixed outlines whose surroundings meet a box.
    pub(crate) fn fixed_within(&self, corners: [Vector; 2]) -> Vec<usize> {
        self.met(&corners, Moment::End).filter(|&outline| self.spots[outline].of.fixed).collect()
    }

    /// The distance from the nearest of some outlines, negative inside; no farther than `most` either way \[m].
    pub(crate) fn distance_from(&self, outlines: &[usize], x: Vector, most: Real) -> Real {
        let mut nearest = most;
        for spot in outlines.iter().map(|&outline| &self.spots[outline]) {
            spot.each_image(x, Moment::End, self.periodic, |x| nearest = smaller(spot.form.distance(x), nearest));
        }
        if nearest < -most { -most } else { nearest }
    }

    /// Visits the surfaces of the fixed outlines within a box; those of discs in pieces no longer than `piece` \[m].
    pub(crate) fn fixed_surfaces(&self, bounds: [Vector; 2], piece: Real, mut visit: impl FnMut(OutlineSurface)) {
        for outline in self.fixed_within(bounds) {
            let spot = &self.spots[outline];
            spot.each_side(piece, |[from, to]| {
                if let Some(ends) = within([from, to], bounds.map(wide)) {
                    let along = (to - from).normalize();
                    let normal = vector(Vector64::new(along.y, -along.x));
                    visit(OutlineSurface { outline, ends: ends.map(vector), normal });
                }
            });
        }
    }
}

impl Spot {
    /// Visits the sides in the world against which no body lies, counter-clockwise.
    fn each_side(&self, piece: Real, mut visit: impl FnMut([Vector64; 2])) {
        let place = self.places[Moment::End as usize];
        let world = |corner: Vector64| place.position + place.axis.rotate(corner);
        match &self.of.shape {
            Shape::Polygon(_) => {
                let sides =
                    edges(&self.corners).enumerate().filter(|(k, _)| !self.inner.get(*k).is_some_and(|&inner| inner));
                sides.for_each(|(_, (from, to))| visit([world(from), world(to)]));
            }
            Shape::Disc { radius } => {
                let count = (TAU * radius / f64::from(piece)).ceil().max(12.0);
                let corner = |k: f64| world(direction(TAU * k / count) * *radius);
                (0..count as u32).map(f64::from).for_each(|k| visit([corner(k), corner(k + 1.0)]));
            }
        }
    }
}

impl Form {
    /// The distance from the outline, negative inside; far away infinite.
    pub(super) fn distance(&self, x: Vector) -> Real {
        match self {
            Form::Polygon(polygon) => polygon.distance(x),
            Form::Round(round) => round.distance(x),
        }
    }
}

/// The part of a line that lies in a box.
fn within([from, to]: [Vector64; 2], [low, high]: [Vector64; 2]) -> Option<[Vector64; 2]> {
    let way = to - from;
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for axis in [0, 1] {
        if way[axis] == 0.0 {
            if from[axis] < low[axis] || from[axis] > high[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((low[axis] - from[axis]) / way[axis], (high[axis] - from[axis]) / way[axis]);
        (enters, leaves) = (enters.max(a.min(b)), leaves.min(a.max(b)));
    }
    (enters < leaves).then(|| [from + way * enters, from + way * leaves])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_at_the_box() {
        let bounds = [Vector64::ZERO, Vector64::ONE];
        let line = |from: [f64; 2], to: [f64; 2]| within([from.into(), to.into()], bounds);
        assert_eq!(line([-1.0, 0.5], [3.0, 0.5]), Some([Vector64::new(0.0, 0.5), Vector64::new(1.0, 0.5)]));
        assert_eq!(line([-1.0, 2.0], [3.0, 2.0]), None);
        assert_eq!(line([0.2, 0.2], [0.4, 0.4]), Some([Vector64::splat(0.2), Vector64::splat(0.4)]));
    }
}
