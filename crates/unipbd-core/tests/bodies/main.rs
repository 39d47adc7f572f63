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
mod shapes;
mod sleep;
mod support;
mod ties;
mod world;
