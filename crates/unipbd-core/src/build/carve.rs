//! Room for bodies: the initial fill of a scene stays outside of them.

use crate::math::{Vector64, direction};
use crate::rigid::Pose;
use crate::shapes::Shape;

/// Centres at least this many spacings outside a body are kept: its own samples begin half a spacing inside.
const CLEARANCE: f64 = 0.25;

/// A body where it starts.
pub(super) struct Solid {
    pub shape: Shape,
    pub pose: Pose,
}

/// The points that lie outside all solids.
pub(super) fn outside(points: Vec<Vector64>, solids: &[Solid], spacing: f64) -> Vec<Vector64> {
    if solids.is_empty() {
        return points;
    }
    let free = |point: &Vector64| !solids.iter().any(|solid| solid.covers(*point, CLEARANCE * spacing));
    points.into_iter().filter(free).collect()
}

impl Solid {
    fn covers(&self, point: Vector64, clearance: f64) -> bool {
        let arm = point - self.pose.position;
        let reach = self.shape.bounding_radius() + clearance;
        arm.length_squared() < reach * reach
            && self.shape.nearest(direction(-self.pose.angle).rotate(arm)).distance < clearance
    }
}
