//! Sources and sinks of particles: emitters and removal rules.

mod change;
mod columns;
mod emitter;
mod injector;
mod removal;
mod saved;
mod sink;

pub use change::{EmitterChange, EmitterReading};
pub(crate) use change::{RestoredEmitter, problem_of};
pub use emitter::EmitterSystem;
pub use removal::RemovalRules;
