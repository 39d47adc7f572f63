//! A contact point as the narrow phase finds it.

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

/// The feature of the vertices of both pieces.
pub(super) fn feature(of_a: usize, of_b: usize) -> u32 {
    (of_a as u32 & 0xffff) << 16 | (of_b as u32 & 0xffff)
}
