//! Where particles come from and where they go: emitters and removal rules.

mod emitter;
mod removal;
mod saved;

pub use emitter::EmitterSystem;
pub use removal::RemovalRules;
