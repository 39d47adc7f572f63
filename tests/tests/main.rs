//! What the solver must show, in one binary.

mod architecture;
mod conservation;
mod determinism;
mod documents;
mod emitters;
mod filled_gas;
mod grid_joints;
mod import_circles;
mod liquids;
mod loads;
mod obstacles;
mod outlines;
mod plume;
mod pressure_grid;
mod scale;
mod shape_matching;
mod smoke;
mod stages;
mod surface_tension;
mod tunnelling;
mod viscosity;
mod walls;
