//! Sides on which still bodies lie against each other: they are no surfaces, and no fluid presses on them.

use super::{Form, Moment, Outlines, Place, Polygon, Spot};
use crate::math::Vector64;
use crate::shapes::{Shape, edges};

/// Sides nearer to each other than this part of the kernel radius touch.
const TOUCHING: f64 = 1e-3;

/// A side in the world.
#[derive(Clone, Copy)]
struct Side {
    outline: usize,
    ends: [Vector64; 2],
}

impl Outlines {
    /// Finds the sides on which still outlines touch. Call it where the outlines have been placed.
    pub fn find_touching(&mut self) {
        let tolerance = TOUCHING * f64::from(self.kernel.radius());
        let sides: Vec<Side> = (0..self.spots.len()).flat_map(|outline| self.sides(outline)).collect();
        for outline in 0..self.spots.len() {
            let spot = &self.spots[outline];
            let Shape::Polygon(corners) = &spot.of.shape else { continue };
            let place = spot.places[Moment::End as usize];
            let others = || sides.iter().filter(|side| side.outline != outline && spot.of.still);
            let (mut all, mut inner) = (Vec::new(), Vec::new());
            for (from, to) in edges(corners) {
                let ends = [world(place, from), world(place, to)];
                let mut covered: Vec<[f64; 2]> =
                    others().filter_map(|side| overlap(ends, side.ends, tolerance)).collect();
                covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
                cut([from, to], &covered, tolerance, (&mut all, &mut inner));
            }
            let spot = &mut self.spots[outline];
            if (&spot.corners, &spot.inner) != (&all, &inner) && (inner.contains(&true) || !spot.inner.is_empty()) {
                spot.form = Form::Polygon(Polygon::new(&all, &inner, f64::from(self.kernel.radius())));
                (spot.corners, spot.inner) = (all, inner);
            }
        }
    }

    fn sides(&self, outline: usize) -> Vec<Side> {
        let Spot { of, places, .. } = &self.spots[outline];
        match &of.shape {
            Shape::Polygon(corners) if of.still => {
                let place = places[Moment::End as usize];
                let side = |(from, to)| Side { outline, ends: [world(place, from), world(place, to)] };
                edges(corners).map(side).collect()
            }
            _ => Vec::new(),
        }
    }
}

fn world(place: Place, corner: Vector64) -> Vector64 {
    place.position + place.axis.rotate(corner)
}

/// The part of a side along which another one lies against it, from its first end \[m].
fn overlap([from, to]: [Vector64; 2], other: [Vector64; 2], tolerance: f64) -> Option<[f64; 2]> {
    let length = (to - from).length();
    let along = (to - from) / length;
    let apart = other.map(|end| end - from);
    if apart.iter().any(|end| along.perp_dot(*end).abs() > tolerance) {
        return None;
    }
    let [high, low] = apart.map(|end| end.dot(along));
    let (low, high) = (low.max(0.0), high.min(length));
    (high - low > tolerance).then_some([low, high])
}

/// Cuts an edge where covered parts begin and end.
fn cut(
    [from, to]: [Vector64; 2],
    covered: &[[f64; 2]],
    tolerance: f64,
    (corners, inner): (&mut Vec<Vector64>, &mut Vec<bool>),
) {
    let length = (to - from).length();
    let mut at = 0.0;
    let mut add = |begin: f64, end: f64, is_inner: bool| {
        if end - begin > tolerance {
            corners.push(from.lerp(to, begin / length));
            inner.push(is_inner);
        }
    };
    for &[begin, end] in covered {
        add(at, begin, false);
        add(begin.max(at), end, true);
        at = end.max(at);
    }
    add(at, length, false);
}
