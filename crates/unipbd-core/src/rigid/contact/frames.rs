//! Poses of bodies at the start of a substep, with their rotations evaluated.

use super::contact_block::Exact;
use crate::math::{Vector64, direction};
use crate::rigid::Bodies;

/// The coordinates of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Centre of mass \[m].
    pub position: Vector64,
    /// Cosine and sine of the angle.
    pub rotation: Vector64,
}

/// The row of the world.
const WORLD: Exact = [0.0, 0.0, 1.0, 0.0];

impl Frame {
    /// The coordinates of the world, for walls.
    pub const WORLD: Frame = Frame { position: Vector64::ZERO, rotation: Vector64::X };

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
pub(super) struct Frames {
    /// Centre of mass, cosine and sine of the angle; the last row is the world.
    pub places: Vec<Exact>,
    angles: Vec<f64>,
}

impl Frames {
    /// Evaluates all poses.
    pub fn update(&mut self, bodies: &Bodies) {
        self.places.resize(bodies.len() + 1, WORLD);
        self.angles.resize(bodies.len(), f64::NAN);
        for ((place, angle), pose) in self.places.iter_mut().zip(&mut self.angles).zip(&bodies.poses) {
            (place[0], place[1]) = (pose.position.x, pose.position.y);
            if *angle != pose.angle {
                let rotation = direction(pose.angle);
                (*angle, place[2], place[3]) = (pose.angle, rotation.x, rotation.y);
            }
        }
        self.places[bodies.len()] = WORLD;
    }

    /// The coordinates of a body, or of the world for a wall.
    #[inline]
    pub fn of(&self, body: u32) -> Frame {
        let [x, y, cosine, sine] = self.places[(body as usize).min(self.angles.len())];
        Frame { position: Vector64::new(x, y), rotation: Vector64::new(cosine, sine) }
    }

    /// The angle of a body; 0 for a wall \[rad].
    #[inline]
    pub fn angle(&self, body: u32) -> f64 {
        self.angles.get(body as usize).copied().unwrap_or(0.0)
    }

    /// Those of both bodies of a contact.
    #[inline]
    pub fn both(&self, (a, b): (u32, u32)) -> [Frame; 2] {
        [self.of(a), self.of(b)]
    }
}
