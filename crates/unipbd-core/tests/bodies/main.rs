//! Rigid bodies and their contacts, against exact results and measured bars.

mod friction;
mod impacts;
mod piles;
mod world;
