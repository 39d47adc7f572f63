//! Boxes of pieces, and the values for "none".

use crate::math::Vector64;

/// Index value for "none".
pub(super) const NONE: u32 = u32::MAX;

/// The exposed part of an edge that is no surface.
pub(super) const HIDDEN: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Bounds {
    pub low: Vector64,
    pub high: Vector64,
}

impl Bounds {
    pub const EMPTY: Bounds = Bounds { low: Vector64::INFINITY, high: Vector64::NEG_INFINITY };

    /// The longer side \[m].
    pub fn extent(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    pub fn grown(&self, by: f64) -> Bounds {
        Bounds { low: self.low - Vector64::splat(by), high: self.high + Vector64::splat(by) }
    }

    pub fn overlaps(&self, other: &Bounds) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Separation of two boxes along the axis of largest separation; negative if they overlap \[m].
    pub fn distance(&self, other: &Bounds) -> f64 {
        (self.low - other.high).max(other.low - self.high).max_element()
    }

    pub fn holds(&self, other: &Bounds) -> bool {
        self.low.x <= other.low.x
            && self.low.y <= other.low.y
            && self.high.x >= other.high.x
            && self.high.y >= other.high.y
    }
}
