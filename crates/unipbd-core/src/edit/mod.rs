//! Changes between two frames, checked as a whole before any of them is made.
//!
//! ```no_run
//! # use unipbd_core::{Edit, Solver, Vector64, edit::Points};
//! # fn drop_in(solver: &mut Solver) -> Result<(), Box<dyn std::error::Error>> {
//! let falling = Points { velocity: Vector64::new(0.0, -1.0), ..Points::new("water", vec![Vector64::new(0.5, 2.0)]) };
//! let edit = Edit::new().remove([3, 4]).set_velocities([7], [Vector64::ZERO]).add_points(falling);
//! let ids = solver.apply(&edit)?;
//! # Ok(())
//! # }
//! ```

mod apply;
mod bodies;
mod check;
mod check_bodies;
mod emitters;
mod error;
mod ropes;
mod world;

pub use crate::coupling::RopeReading;
pub use crate::rigid::BodyChange;
pub use crate::sources::{EmitterChange, EmitterReading};
pub use error::EditError;

use world::WorldChange;

use crate::math::Vector64;
use crate::rigid::Twist;
use crate::scene::PointMotion;

/// Changes to make at once with [`Solver::apply`](crate::Solver::apply). Values are set first, then
/// particles are removed, then new ones are added, then bodies, joints and gravity change in the order given; ids of
/// particles are those before the edit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edit {
    changes: Vec<Change>,
    bodies: Vec<(u32, Twist)>,
    removals: Vec<u32>,
    additions: Vec<Points>,
    world: Vec<WorldChange>,
}

/// Values for some particles: one for each id.
#[derive(Clone, Debug, PartialEq)]
struct Change {
    ids: Vec<u32>,
    values: Values,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    Positions(Vec<Vector64>),
    Velocities(Vec<Vector64>),
    Temperatures(Vec<f64>),
    Motion(PointMotion),
}

/// Particles to add.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Name of their material.
    pub material: String,
    /// Where they are \[m].
    pub positions: Vec<Vector64>,
    /// Velocity of all of them where `velocities` is empty [m/s].
    pub velocity: Vector64,
    /// Velocity of each, or empty [m/s].
    pub velocities: Vec<Vector64>,
    /// Temperature, for gas.
    pub temperature: f64,
    /// Whether forces move them.
    pub motion: PointMotion,
}

impl Points {
    /// Particles at rest.
    pub fn new(material: &str, positions: Vec<Vector64>) -> Self {
        Points {
            material: material.to_owned(),
            positions,
            velocity: Vector64::ZERO,
            velocities: Vec::new(),
            temperature: 0.0,
            motion: PointMotion::Free,
        }
    }
}

impl Edit {
    /// No changes yet.
    pub fn new() -> Self {
        Edit::default()
    }

    /// Moves particles to these places \[m]. They keep their velocity.
    #[must_use]
    pub fn set_positions(self, ids: impl Into<Vec<u32>>, positions: impl Into<Vec<Vector64>>) -> Self {
        self.change(ids, Values::Positions(positions.into()))
    }

    /// Gives particles these velocities [m/s].
    #[must_use]
    pub fn set_velocities(self, ids: impl Into<Vec<u32>>, velocities: impl Into<Vec<Vector64>>) -> Self {
        self.change(ids, Values::Velocities(velocities.into()))
    }

    /// Gives particles these temperatures.
    #[must_use]
    pub fn set_temperatures(self, ids: impl Into<Vec<u32>>, temperatures: impl Into<Vec<f64>>) -> Self {
        self.change(ids, Values::Temperatures(temperatures.into()))
    }

    /// Makes particles kinematic, or dynamic again.
    #[must_use]
    pub fn set_motion(self, ids: impl Into<Vec<u32>>, motion: PointMotion) -> Self {
        self.change(ids, Values::Motion(motion))
    }

    /// Gives a body this velocity of its centre of mass [m/s] and angular velocity [rad/s]. A dynamic body
    /// goes on from there; a kinematic one keeps it, overriding its script, until it is given another.
    /// Bodies are named by their place in [`Solver::bodies`](crate::Solver::bodies).
    #[must_use]
    pub fn set_body_velocity(mut self, body: u32, velocity: Vector64, angular_velocity: f64) -> Self {
        self.bodies.push((body, Twist { linear: velocity, angular: angular_velocity }));
        self
    }

    /// Removes particles.
    #[must_use]
    pub fn remove(mut self, ids: impl IntoIterator<Item = u32>) -> Self {
        self.removals.extend(ids);
        self
    }

    /// Adds particles.
    #[must_use]
    pub fn add_points(mut self, points: Points) -> Self {
        self.additions.push(points);
        self
    }

    /// Whether the edit is empty.
    pub fn is_empty(&self) -> bool {
        let particles = self.changes.is_empty() && self.removals.is_empty() && self.additions.is_empty();
        particles && self.bodies.is_empty() && self.world.is_empty()
    }

    /// The particles that it changes or removes.
    fn touched(&self) -> impl Iterator<Item = u32> {
        self.changes.iter().flat_map(|change| change.ids.iter().copied()).chain(self.removals.iter().copied())
    }

    fn change(mut self, ids: impl Into<Vec<u32>>, values: Values) -> Self {
        self.changes.push(Change { ids: ids.into(), values });
        self
    }
}
