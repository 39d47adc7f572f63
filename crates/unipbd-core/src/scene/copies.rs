//! What a body description stands for: a shape, and one body or rows of them.

use super::{BodyDescription, Copies, Heap, Scene};
use crate::math::Vector64;
use crate::shapes::Shape;

/// More bodies than this are refused.
pub(crate) const MOST_BODIES: usize = 200_000;

impl BodyDescription {
    /// The outline; a disc without area where none is given, which [`Scene::validate`] refuses.
    pub(crate) fn shape(&self) -> Shape {
        match (&self.outline, self.size, self.radius) {
            (Some(outline), _, _) => Shape::Polygon(outline.iter().map(|&corner| corner.into()).collect()),
            (None, Some([width, height]), _) => Shape::rectangle(width, height),
            (None, None, radius) => Shape::Disc { radius: radius.unwrap_or_default() },
        }
    }

    /// Names and starting places \[m] of the body and its copies; `number` names a body without a name.
    pub(crate) fn instances(&self, number: usize) -> impl Iterator<Item = (String, Vector64)> {
        let name = if self.name.is_empty() { format!("body {number}") } else { self.name.clone() };
        let copied = self.copies.is_some();
        let named = move |copy| if copied { format!("{name} {copy}") } else { name.clone() };
        self.places().enumerate().map(move |(copy, place)| (named(copy), place))
    }

    /// Starting places of the body and its copies, row by row \[m].
    pub(crate) fn places(&self) -> impl Iterator<Item = Vector64> {
        let origin = Vector64::from(self.position);
        let alone = Copies { columns: 1, rows: 1, step: [0.0; 2], heap: Heap::Grid };
        let copies = self.copies.clone().unwrap_or(alone);
        (0..copies.rows).flat_map(move |row| {
            let (columns, shift) = match copies.heap {
                Heap::Grid => (copies.columns, 0.0),
                Heap::Brick => (copies.columns, 0.5 * f64::from(row % 2)),
                Heap::Pyramid => (copies.columns.saturating_sub(row), 0.5 * f64::from(row)),
            };
            let step = Vector64::from(copies.step);
            (0..columns).map(move |column| origin + Vector64::new(f64::from(column) + shift, f64::from(row)) * step)
        })
    }
}

impl Scene {
    /// The names of all bodies, copies included; of more bodies than a scene may have, the first.
    pub(crate) fn body_names(&self) -> Vec<String> {
        let instances = self.body.iter().enumerate().flat_map(|(number, body)| body.instances(number));
        instances.map(|(name, _)| name).take(MOST_BODIES).collect()
    }
}
