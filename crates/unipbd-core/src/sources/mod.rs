//! Sources and sinks of particles: emitters and removal rules.

mod emitter;
mod injector;
mod removal;
mod saved;
mod sink;

pub use emitter::EmitterSystem;
pub use removal::RemovalRules;
