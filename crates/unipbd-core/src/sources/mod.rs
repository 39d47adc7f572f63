//! Where particles come from and where they go: emitters and removal rules.

mod emitter;
mod removal;

pub use emitter::EmitterSystem;
pub use removal::RemovalRules;
