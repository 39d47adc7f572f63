//! Poses of bodies at the start of a substep, with their rotations evaluated.

use super::bounds::NONE;
use crate::math::{Vector64, direction};
use crate::rigid::Bodies;

/// The coordinates of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Centre of mass \[m].
    pub position: Vector64,
    angle: f64,
    /// Cosine and sine of the angle.
    pub rotation: Vector64,
    /// Acceleration by gravity [m/s^2].
    pub pull: Vector64,
}

/// The coordinates of the world, for walls.
pub(super) const WORLD: Frame =
    Frame { position: Vector64::ZERO, angle: 0.0, rotation: Vector64::X, pull: Vector64::ZERO };

impl Frame {
    /// A direction of the world in the coordinates of the body.
    pub fn turn_back(&self, direction: Vector64) -> Vector64 {
        Vector64::new(self.rotation.dot(direction), self.rotation.perp_dot(direction))
    }

    /// A point of the world in the coordinates of the body.
    pub fn local(&self, point: Vector64) -> Vector64 {
        self.turn_back(point - self.position)
    }
}

/// The coordinates of all bodies.
#[derive(Clone, Default)]
pub(super) struct Frames(Vec<Frame>);

impl Frames {
    /// Evaluates all poses.
    pub fn update(&mut self, bodies: &Bodies, gravity: Vector64) {
        self.0.resize(bodies.len(), WORLD);
        for (id, frame) in self.0.iter_mut().enumerate() {
            let pose = &bodies.poses[id];
            if frame.angle != pose.angle {
                (frame.angle, frame.rotation) = (pose.angle, direction(pose.angle));
            }
            frame.position = pose.position;
            frame.pull = if bodies.is_active(id) { bodies.pull(id, gravity) } else { Vector64::ZERO };
        }
    }

    /// The coordinates of a body, or of the world for a wall.
    #[inline]
    pub fn of(&self, body: u32) -> &Frame {
        if body == NONE { &WORLD } else { &self.0[body as usize] }
    }

    /// Those of both bodies of a contact.
    #[inline]
    pub fn both(&self, (a, b): (u32, u32)) -> [&Frame; 2] {
        [self.of(a), self.of(b)]
    }
}
