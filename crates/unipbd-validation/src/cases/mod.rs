//! The cases, a file per family.

mod bodies;
mod drag;
mod drain;
mod drop;
mod flow;
mod immersed;
mod impact;
mod layers;
mod pool;
mod solitary;
mod vortices;
mod wave;
mod work;

pub use pool::{DENSITY_ERROR, LEVEL, SUBSTEPS_PER_FRAME, WORST};

use crate::case::Case;

/// All cases, in the order of the table.
pub const ALL: &[Case] = &[
    pool::COLUMN,
    layers::TWO_LAYERS,
    drop::ELLIPTICAL_DROP,
    drop::OSCILLATING_DROP,
    wave::STANDING_WAVE,
    solitary::SOLITARY_WAVE,
    pool::DAM_BREAK,
    drain::DRAIN,
    flow::TAYLOR_GREEN,
    flow::TAYLOR_GREEN_WIDE,
    flow::TAYLOR_GREEN_1000,
    vortices::TAYLOR_GREEN_BOX,
    vortices::VORTEX_PAIR,
    vortices::VORTEX_PAIR_GAS,
    layers::RAYLEIGH_TAYLOR,
    flow::COUETTE,
    flow::POISEUILLE,
    pool::FLOATING_BOX,
    immersed::LIGHT_FLOATS,
    immersed::ADDED_MASS,
    impact::PISTON,
    impact::PRESS,
    impact::SLAB,
    bodies::BLOCK_ON_INCLINE,
    bodies::DISC_ON_INCLINE,
    bodies::PENDULUM,
    bodies::ROPE,
    drag::DRAG,
    bodies::GRANULAR_COLUMN,
    work::WORK,
];

/// The case with this name.
pub fn find(name: &str) -> Option<&'static Case> {
    ALL.iter().find(|case| case.name == name)
}
