//! A contact point as the narrow phase finds it.

use super::frames::Frame;
use crate::math::Vector64;

/// The solid that the normal of a contact is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Reference {
    /// A face of the first body.
    First,
    /// A face of the second body, or of a wall.
    Second,
    /// None: the normal is the line between two points.
    Points,
}

/// A contact point of two pieces that touch or are close.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub reference: Reference,
    /// Unit normal, towards the first piece.
    pub normal: Vector64,
    /// A vertex of the first piece or a point on its face, without the radius of a disc \[m].
    pub on_a: Vector64,
    /// The same of the second piece \[m].
    pub on_b: Vector64,
    /// Radii of the discs, 0 for polygons \[m].
    pub radii: [f64; 2],
    /// The vertices of the two pieces that identify the point in the next search.
    pub feature: u32,
}

impl Touch {
    /// Distance of the surfaces along the normal, negative when they overlap \[m].
    pub fn gap(&self) -> f64 {
        (self.on_a - self.on_b).dot(self.normal) - self.radii[0] - self.radii[1]
    }

    /// The normal in the coordinates of the solid that it is fixed to.
    pub fn fixed_normal(&self, [a, b]: [Frame; 2]) -> Vector64 {
        match self.reference {
            Reference::First => a.turn_back(self.normal),
            Reference::Second | Reference::Points => b.turn_back(self.normal),
        }
    }

    /// The points of both solids, in their coordinates.
    pub fn anchors(&self, [a, b]: [Frame; 2]) -> (Vector64, Vector64) {
        (a.local(self.on_a), b.local(self.on_b))
    }

    /// The same contact with the pieces swapped.
    pub fn reversed(self) -> Touch {
        Touch {
            reference: match self.reference {
                Reference::First => Reference::Second,
                Reference::Second => Reference::First,
                Reference::Points => Reference::Points,
            },
            normal: -self.normal,
            on_a: self.on_b,
            on_b: self.on_a,
            radii: [self.radii[1], self.radii[0]],
            feature: self.feature.rotate_left(16),
        }
    }
}

/// The points of a pair in a search, with one normal: none if there were normals of several directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) struct Points {
    reference: Option<Reference>,
    features: [u32; 2],
    count: u32,
}

impl Points {
    pub fn of(touches: &[Touch]) -> Points {
        let (Some(first), 1..=2) = (touches.first(), touches.len()) else { return Points::default() };
        let last = &touches[touches.len() - 1];
        if (first.reference, first.normal) != (last.reference, last.normal) {
            return Points::default();
        }
        let features = [first.feature, last.feature];
        Points { reference: Some(first.reference), features, count: touches.len() as u32 }
    }

    /// Whether the same points touch along one normal as in another search.
    pub fn stay(&self, before: &Points) -> bool {
        self.count > 0 && self == before
    }
}

/// The feature of the vertices of both pieces.
pub(super) fn feature(of_a: usize, of_b: usize) -> u32 {
    (of_a as u32 & 0xffff) << 16 | (of_b as u32 & 0xffff)
}
