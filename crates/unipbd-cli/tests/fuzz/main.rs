//! Scene text, overrides and logs with mistakes of every kind: read, or refused with an error.
#![allow(unsafe_code)]

#[path = "../../../../tests/fuzz/harness.rs"]
mod harness;
mod logs;
#[path = "../common/records.rs"]
mod records;
mod scenes;
