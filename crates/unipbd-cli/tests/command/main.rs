//! The command line from outside: what it prints where, and how it exits.

mod arguments;
mod ending;
mod log;
mod output;
mod pictures;
mod quantities;
mod support;
