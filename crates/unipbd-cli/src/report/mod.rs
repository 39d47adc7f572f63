//! Output for the user: messages, progress, JSON lines, summaries.

pub mod clean;
mod console;
mod counter;
pub mod format;
pub mod json;
mod progress;
mod statistics;
pub mod summary;

pub use console::{Console, Form, Verbosity};
pub use counter::Counter;
pub use progress::Progress;
pub use statistics::{Outcome, Statistics};
