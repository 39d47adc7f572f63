//! Changes of bodies, joints and gravity.

use super::{BodyChange, Edit, Points};
use crate::math::Vector64;
use crate::rigid::contact::Motor;
use crate::scene::{BodyDescription, Emitter, JointDescription, Rope};
use crate::sources::EmitterChange;

/// One change of the world.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum WorldChange {
    Gravity(Vector64),
    AddBody(Box<BodyDescription>),
    RemoveBody(u32),
    MoveBody { body: u32, position: Vector64, angle: f64 },
    ChangeBody { body: u32, change: Box<BodyChange> },
    Strike { body: u32, impulse: Vector64, point: Vector64 },
    AddJoint(Box<JointDescription>),
    RemoveJoint(u32),
    Motor { joint: u32, motor: Option<Motor> },
    AddEmitter(Box<Emitter>),
    ChangeEmitter { emitter: u32, change: EmitterChange },
    RemoveEmitter(u32),
    AddRope(Box<Rope>),
    CutRope { rope: u32, piece: u32 },
    RemoveRope(u32),
}

impl Edit {
    /// Changes gravity [m/s^2].
    #[must_use]
    pub fn set_gravity(self, gravity: Vector64) -> Self {
        self.with(WorldChange::Gravity(gravity))
    }

    /// Adds a body, or rows of them, as a `[[body]]` of a scene describes it; they get the next numbers of
    /// [`Solver::bodies`](crate::Solver::bodies). Bodies that are particles cannot be added.
    #[must_use]
    pub fn add_body(self, body: BodyDescription) -> Self {
        self.with(WorldChange::AddBody(Box::new(body)))
    }

    /// Takes a body away with its joints. Its number is not given to another: its entry stays, marked as removed.
    #[must_use]
    pub fn remove_body(self, body: u32) -> Self {
        self.with(WorldChange::RemoveBody(body))
    }

    /// Puts the centre of mass of a body somewhere else \[m], at this angle \[rad]. It keeps its velocity; a kinematic body
    /// goes on from there.
    #[must_use]
    pub fn move_body(self, body: u32, position: Vector64, angle: f64) -> Self {
        self.with(WorldChange::MoveBody { body, position, angle })
    }

    /// Changes properties of a body: mass, friction, kind...
    #[must_use]
    pub fn change_body(self, body: u32, change: BodyChange) -> Self {
        self.with(WorldChange::ChangeBody { body, change: Box::new(change) })
    }

    /// Pushes a dynamic body by an impulse [N s] at a point of the world \[m].
    #[must_use]
    pub fn push_body(self, body: u32, impulse: Vector64, point: Vector64) -> Self {
        self.with(WorldChange::Strike { body, impulse, point })
    }

    /// Adds a joint, as a `[[joint]]` of a scene describes it, between the bodies where they are then: those that the
    /// same edit adds before it too. It gets the next number of [`Solver::joints`](crate::Solver::joints).
    #[must_use]
    pub fn add_joint(self, joint: JointDescription) -> Self {
        self.with(WorldChange::AddJoint(Box::new(joint)))
    }

    /// Takes a joint away, by its number in [`Solver::joints`](crate::Solver::joints).
    #[must_use]
    pub fn remove_joint(self, joint: u32) -> Self {
        self.with(WorldChange::RemoveJoint(joint))
    }

    /// Changes the motor of a hinge ([rad/s], [N m]) or slider ([m/s], \[N]), or takes it away.
    #[must_use]
    pub fn set_motor(self, joint: u32, motor: Option<Motor>) -> Self {
        self.with(WorldChange::Motor { joint, motor })
    }

    /// Adds an emitter, as an `[[emitter]]` of a scene describes it; `start` and `stop` are times of the run \[s]. It gets
    /// the next number of [`Solver::emitters`](crate::Solver::emitters). Leave room for three rows behind its face.
    #[must_use]
    pub fn add_emitter(self, emitter: Emitter) -> Self {
        self.with(WorldChange::AddEmitter(Box::new(emitter)))
    }

    /// Changes the speed or temperature of an emitter, or switches it on or off.
    #[must_use]
    pub fn change_emitter(self, emitter: u32, change: EmitterChange) -> Self {
        self.with(WorldChange::ChangeEmitter { emitter, change })
    }

    /// Takes an emitter away; the particles behind its face are let go. Its number is not given to another.
    #[must_use]
    pub fn remove_emitter(self, emitter: u32) -> Self {
        self.with(WorldChange::RemoveEmitter(emitter))
    }

    /// Lays a rope, as a `[[rope]]` of a scene describes it, between the bodies where they are then: those that the same
    /// edit adds before it too. It gets the next number of [`Solver::ropes`](crate::Solver::ropes).
    #[must_use]
    pub fn add_rope(self, rope: Rope) -> Self {
        self.with(WorldChange::AddRope(Box::new(rope)))
    }

    /// Cuts a piece of a rope, between its points `piece` and `piece + 1`.
    #[must_use]
    pub fn cut_rope(self, rope: u32, piece: u32) -> Self {
        self.with(WorldChange::CutRope { rope, piece })
    }

    /// Takes a rope away with its points. Its number is not given to another.
    #[must_use]
    pub fn remove_rope(self, rope: u32) -> Self {
        self.with(WorldChange::RemoveRope(rope))
    }

    /// Fills a rectangle with particles of a material, as a `[[block]]` of a scene does, from its lower left to its upper
    /// right corner \[m]; `spacing` is that of the run.
    #[must_use]
    pub fn add_block(self, material: &str, min: Vector64, max: Vector64, spacing: f64) -> Self {
        let count = |from: f64, to: f64| ((to - from) / spacing).round().clamp(0.0, 1e5) as u32;
        let (columns, rows) = (count(min.x, max.x), count(min.y, max.y));
        let at = |row: u32, column: u32| min + Vector64::new(f64::from(column) + 0.5, f64::from(row) + 0.5) * spacing;
        let positions = (0..rows).flat_map(|row| (0..columns).map(move |column| at(row, column)));
        self.add_points(Points::new(material, positions.collect()))
    }

    fn with(mut self, change: WorldChange) -> Self {
        self.world.push(change);
        self
    }
}
