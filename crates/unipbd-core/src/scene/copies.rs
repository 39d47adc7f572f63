//! What a body description stands for: a shape, and one body or rows of them.

use super::{BodyDescription, Heap, Scene};
use crate::math::Vector64;
use crate::shapes::Shape;

impl BodyDescription {
    /// The outline; a disc without area where none is given, which [`Scene::validate`] refuses.
    pub(crate) fn shape(&self) -> Shape {
        match (&self.outline, self.size, self.radius) {
            (Some(outline), _, _) => Shape::Polygon(outline.iter().map(|&corner| corner.into()).collect()),
            (None, Some([width, height]), _) => Shape::rectangle(width, height),
            (None, None, radius) => Shape::Disc { radius: radius.unwrap_or_default() },
        }
    }

    /// Names and starting places [m] of the body and its copies; `number` names a body without a name.
    pub(crate) fn instances(&self, number: usize) -> Vec<(String, Vector64)> {
        let name = if self.name.is_empty() { format!("body {number}") } else { self.name.clone() };
        let origin = Vector64::from(self.position);
        if self.copies.is_none() {
            return vec![(name, origin)];
        }
        let named = |(copy, offset)| (format!("{name} {copy}"), origin + offset);
        self.offsets().into_iter().enumerate().map(named).collect()
    }

    /// From the body to each of its copies, row by row, itself included [m].
    fn offsets(&self) -> Vec<Vector64> {
        let Some(copies) = &self.copies else { return vec![Vector64::ZERO] };
        let mut offsets = Vec::new();
        for row in 0..copies.rows {
            let (columns, shift) = match copies.heap {
                Heap::Grid => (copies.columns, 0.0),
                Heap::Brick => (copies.columns, 0.5 * f64::from(row % 2)),
                Heap::Pyramid => (copies.columns.saturating_sub(row), 0.5 * f64::from(row)),
            };
            let place = |column| Vector64::new(f64::from(column) + shift, f64::from(row)) * Vector64::from(copies.step);
            offsets.extend((0..columns).map(place));
        }
        offsets
    }
}

impl Scene {
    /// The names of all bodies, copies included.
    pub(crate) fn body_names(&self) -> Vec<String> {
        let instances = self.body.iter().enumerate().flat_map(|(number, body)| body.instances(number));
        instances.map(|(name, _)| name).collect()
    }
}
