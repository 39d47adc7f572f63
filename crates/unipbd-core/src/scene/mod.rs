//! The scene description: plain data that can be read, edited, checked and built.
//!
//! A [`Scene`] holds no runtime state. [`Scene::validate`] lists everything that is wrong with it,
//! [`Scene::estimate`] says what it would cost, [`Scene::build`] checks it and makes a [`Solver`](crate::Solver).

mod bodies;
mod checked;
mod contacts;
mod copies;
mod crowding;
mod description;
mod estimate;
mod expect;
mod gauges;
mod joints;
mod layout;
mod legacy;
mod materials;
mod motion;
mod nearest;
mod points;
mod pressure_grid;
mod problem;
mod regions;
mod ropes;
mod settings;
mod shorthand;
mod sources;
mod substep_law;
mod tension_law;
mod validate;
mod walls;
mod waves;

pub use bodies::*;
pub use checked::*;
pub use contacts::*;
pub use description::*;
pub use estimate::*;
pub use expect::*;
pub use gauges::*;
pub use joints::*;
pub use legacy::*;
pub use materials::*;
pub use motion::*;
pub use nearest::nearest;
pub use points::*;
pub use pressure_grid::*;
pub use problem::*;
pub use regions::*;
pub use ropes::*;
pub use settings::*;
pub use sources::*;
pub use walls::*;
pub use waves::*;

pub(crate) use contacts::{OVER_RELAXATION, SLEEP_SPEED};
pub(crate) use copies::MOST_BODIES;
pub(crate) use crowding::crowd;
pub(crate) use layout::{block_points, disc_points};
pub(crate) use substep_law::{COURANT, Drive, SubstepLaw};
pub(crate) use tension_law::{TENSION_RADIUS, TensionLaw};
pub(crate) use validate::FARTHEST;
pub use validate::{FRAME_RATES, LONGEST_DURATION};
pub(crate) use walls::body_friction;
