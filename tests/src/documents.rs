//! The Rust code of the documents, run as doctests: `cargo test -p unipbd-tests --doc`.

#[doc = include_str!("../../README.md")]
pub struct Readme;

#[doc = include_str!("../../docs/tutorials/constraints_rust.md")]
pub struct ConstraintsOfYourOwn;

#[doc = include_str!("../../docs/howto/game_loop.md")]
pub struct GameLoop;

#[doc = include_str!("../../docs/reference/rust.md")]
pub struct RustReference;
