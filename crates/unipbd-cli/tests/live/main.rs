//! A live run, as a viewer sees it over its socket.
#![cfg(feature = "live")]

mod client;
mod controls;
mod parameters;
mod runs;
mod topics;
