//! The cases, a file per family.

mod bodies;
mod drag;
mod drop;
mod flow;
mod layers;
mod pool;
mod wave;

pub use pool::{DENSITY_ERROR, LEVEL, SUBSTEPS_PER_FRAME, WORST};

use crate::case::Case;

/// All cases, in the order of the table.
pub const ALL: &[Case] = &[
    pool::COLUMN,
    layers::TWO_LAYERS,
    drop::ELLIPTICAL_DROP,
    drop::OSCILLATING_DROP,
    wave::STANDING_WAVE,
    pool::DAM_BREAK,
    flow::TAYLOR_GREEN,
    flow::TAYLOR_GREEN_WIDE,
    flow::TAYLOR_GREEN_1000,
    layers::RAYLEIGH_TAYLOR,
    flow::COUETTE,
    flow::POISEUILLE,
    pool::FLOATING_BOX,
    bodies::BLOCK_ON_INCLINE,
    bodies::DISC_ON_INCLINE,
    bodies::PENDULUM,
    bodies::ROPE,
    drag::DRAG,
    bodies::GRANULAR_COLUMN,
];

/// The case with this name.
pub fn find(name: &str) -> Option<&'static Case> {
    ALL.iter().find(|case| case.name == name)
}
