//! Rigid bodies and their contacts, against exact results and measured bars.

mod answers;
mod contact_options;
mod friction;
mod impacts;
mod joints;
mod piles;
mod shapes;
mod sleep;
mod world;
