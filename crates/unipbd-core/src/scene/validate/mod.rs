//! Semantic checks: values that parse but make no sense.
//!
//! One file per kind of thing; each lists only causes, never what follows from them: a comparison
//! with a value that is itself at fault is left out.

mod bodies;
mod checker;
mod environment;
mod extremes;
mod finite;
mod gauges;
mod geometry;
mod joints;
mod legacy;
mod materials;
mod motion;
mod names;
mod overlap;
mod placement;
mod pressure_grid;
mod regions;
mod ropes;
mod settings;
mod size;
mod sources;
mod twins;
mod walls;

use super::{Problems, Scene};
use checker::Checker;
pub use settings::{FRAME_RATES, LONGEST_DURATION};
pub(crate) use size::FARTHEST;

impl Scene {
    /// Lists everything that is wrong with the scene; empty when it can be built.
    pub fn validate(&self) -> Problems {
        let mut checker = Checker::new(self);
        finite::check(&mut checker);
        settings::check(&mut checker);
        legacy::check(&mut checker);
        pressure_grid::check(&mut checker);
        environment::check(&mut checker);
        motion::check_shaking(&mut checker);
        materials::check(&mut checker);
        sources::check(&mut checker);
        walls::check(&mut checker);
        bodies::check(&mut checker);
        joints::check(&mut checker);
        regions::check(&mut checker);
        ropes::check(&mut checker);
        gauges::check(&mut checker);
        extremes::check(&mut checker);
        twins::check(&mut checker);
        size::check(&mut checker);
        if checker.size_is_sane {
            twins::check_bodies(&mut checker);
            overlap::check(&mut checker);
            placement::check(&mut checker);
        }
        checker.problems
    }
}
