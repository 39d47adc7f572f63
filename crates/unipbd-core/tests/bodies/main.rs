//! Rigid bodies and their contacts, against exact results and measured bars.

mod answers;
mod common;
mod constraints;
mod contact_options;
mod edits;
mod friction;
mod impacts;
mod joints;
mod piles;
mod queries;
mod ropes_change;
mod shapes;
mod shapes_change;
mod sleep;
mod support;
mod ties;
mod world;
