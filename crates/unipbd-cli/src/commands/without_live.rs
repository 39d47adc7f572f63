//! A build without the feature `live`: nobody watches.

use unipbd_core::observe::{Diagnostics, Event};

use crate::args::RunArgs;
use crate::exit::Failure;
use crate::report::Console;
use crate::scene_file::LoadedScene;
use crate::simulation::Simulation;

/// No viewers.
pub(super) struct Viewers;

impl Viewers {
    pub fn start(_: &RunArgs, _: &Simulation, _: &LoadedScene, _: Console) -> Result<Self, Failure> {
        Ok(Viewers)
    }

    pub fn are_possible(&self) -> bool {
        false
    }

    pub fn is_due(&mut self, _: &mut Simulation) -> bool {
        true
    }

    pub fn want_diagnostics(&self) -> bool {
        false
    }

    pub fn take_events(&mut self) -> Vec<Event> {
        Vec::new()
    }

    pub fn frame(&mut self, _: &Simulation, _: Option<&Diagnostics>, _: &[Event]) {}

    pub fn finish(self, _: &mut Simulation, _: Console) {}
}
