//! The scene description: plain data that can be read, edited, checked and built.
//!
//! A [`Scene`] holds no runtime state. [`Scene::validate`] lists everything that is wrong with it,
//! [`Scene::estimate`] says what it would cost, [`Scene::build`] checks it and makes a [`Solver`](crate::Solver).

mod bodies;
mod checked;
mod contacts;
mod copies;
mod description;
mod estimate;
mod expect;
mod layout;
mod legacy;
mod materials;
mod nearest;
mod points;
mod problem;
mod regions;
mod ropes;
mod settings;
mod shorthand;
mod sources;
mod substep_law;
mod validate;
mod walls;
mod waves;

pub use bodies::{
    BodyDescription, BodyKind, BodySolver, Copies, Heap, JointDescription, JointRule, MotionDescription, RotationRule,
    Station,
};
pub use checked::CheckedScene;
pub use contacts::ContactDescription;
pub use description::{Domain, Environment, Scene, View};
pub use estimate::{BYTES_PER_PARTICLE, Estimate, SECONDS_PER_PARTICLE_AND_SUBSTEP, SECONDS_WITH_COARSE_PROJECTION};
pub use expect::{BodyExpectation, Expect, MaterialExpectation};
pub use legacy::{Averaging, LegacyKernel, LegacySettings, MassDensityDescription};
pub use materials::{Gas, Liquid, LiquidSurface, MaterialRef, Smoke, Solid};
pub use nearest::nearest;
pub use points::{PointMotion, Points};
pub use problem::{KeyPath, KeySegment, Problem, Problems};
pub use regions::{Heater, Injector, Region, Sink};
pub use ropes::{Held, Link, Rope, Tethers};
pub use settings::{GradientPoint, SolverSettings, Substeps};
pub use sources::{Block, Disc, Emitter, Profile, Sheath, SmokeSource};
pub use walls::{HalfPlane, Obstacle, Side, Slip, Tank};
pub use waves::Wave;

pub(crate) use layout::{block_points, disc_points};
pub(crate) use substep_law::{COURANT, SubstepLaw};
pub(crate) use validate::FARTHEST;
