//! The scenes of the project, and the physics they rest on.

mod coupling;
mod effects;
mod files;
mod interface;
mod seed;
mod support;
