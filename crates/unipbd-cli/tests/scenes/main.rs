//! The scenes of the project, and the physics they rest on.

mod coupling;
mod effects;
mod files;
mod forces;
mod gas;
mod interface;
mod legacy;
mod ropes;
mod support;
mod surface_tension;
