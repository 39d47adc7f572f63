//! What the solver must show, in one binary.

mod architecture;
mod conservation;
mod determinism;
mod documents;
mod drum;
mod emitters;
mod filled_gas;
mod grid_joints;
mod import_circles;
mod liquids;
mod loads;
mod lock_exchange;
mod obstacles;
mod outlines;
mod plume;
mod pressure_grid;
mod scale;
mod scale_of_bodies;
mod shape_matching;
mod smoke;
mod stages;
mod starts;
mod surface_tension;
mod tunnelling;
mod viscosity;
mod walls;
