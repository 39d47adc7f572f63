//! Logs: written the same every time, read back as they were, readable after a crash.

mod damage;
mod quantities;
mod round_trip;
mod support;
