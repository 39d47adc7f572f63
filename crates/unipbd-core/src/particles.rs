//! Particles as columns.
