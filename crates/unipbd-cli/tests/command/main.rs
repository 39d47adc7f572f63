//! The command line from outside: what it prints where, and how it exits.

mod arguments;
mod crafted_logs;
mod ending;
mod escapes;
mod export;
mod gauges;
mod input_as_output;
mod instruction_sets;
mod kills;
mod layout;
mod log;
mod many_things;
mod motion;
mod odd_values;
mod output;
mod partial_logs;
mod pictures;
mod quantities;
#[path = "../common/records.rs"]
mod records;
mod recover;
mod signals;
mod support;
mod threads_rule;
