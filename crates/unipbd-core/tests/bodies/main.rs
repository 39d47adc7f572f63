//! Rigid bodies and their contacts, against exact results and measured bars.

mod answers;
mod common;
mod contact_options;
mod friction;
mod impacts;
mod joints;
mod piles;
mod shapes;
mod sleep;
mod support;
mod ties;
mod world;
