//! Constraints between particles and bodies.

pub mod contact;
