#![doc = include_str!("../README.md")]

mod answer;
mod columns;
mod describe;
mod exports;
mod hand;
mod pour;
mod session;

pub use columns::{Column, Values};
pub use session::{Changed, Session};
