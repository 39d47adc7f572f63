//! Viewers of a run; none where it is not live.

use unipbd_core::observe::{Diagnostics, Event};

use super::recording::header;
use crate::args::RunArgs;
use crate::exit::Failure;
use crate::interrupt;
use crate::live::Live;
use crate::report::Console;
use crate::scene_file::LoadedScene;
use crate::simulation::Simulation;

/// The server of a live run.
pub(super) struct Viewers(Option<Live>);

impl Viewers {
    /// Starts the server where the arguments ask for it, and says where it is.
    pub fn start(
        arguments: &RunArgs,
        simulation: &Simulation,
        loaded: &LoadedScene,
        console: Console,
    ) -> Result<Self, Failure> {
        let Some(options) = arguments.live.options() else { return Ok(Viewers(None)) };
        let header = header(simulation, loaded);
        let live = Live::start(&options, &header, arguments.log.fields, simulation).map_err(Failure::io)?;
        console.note(format_args!("live at {}: in Lichtblick or Foxglove, Open connection", live.url()));
        if options.paused {
            console.note("paused: a viewer starts the run");
        }
        Ok(Viewers(Some(live)))
    }

    /// Whether the run is live.
    pub fn are_possible(&self) -> bool {
        self.0.is_some()
    }

    /// Whether the next frame is due; waits a moment where it is not.
    pub fn is_due(&mut self, simulation: &mut Simulation) -> bool {
        self.0.as_mut().is_none_or(|live| live.is_due(simulation))
    }

    /// Whether somebody wants the diagnostics of this frame.
    pub fn want_diagnostics(&self) -> bool {
        self.0.as_ref().is_some_and(Live::wants_diagnostics)
    }

    /// Changes by viewers since the last call.
    pub fn take_events(&mut self) -> Vec<Event> {
        self.0.as_mut().map(Live::take_events).unwrap_or_default()
    }

    /// Shows a frame.
    pub fn frame(&mut self, simulation: &Simulation, diagnostics: Option<&Diagnostics>, events: &[Event]) {
        if let Some(live) = &mut self.0 {
            live.frame(simulation, diagnostics, events);
        }
    }

    /// Keeps the last frame for those who watch, until they have left or somebody interrupts.
    pub fn finish(self, simulation: &mut Simulation, console: Console) {
        let Some(mut live) = self.0 else { return };
        live.end(simulation);
        if live.viewers() > 0 && interrupt::requested().is_none() {
            console.note("the last frame stays until the viewers have left, or Ctrl-C");
        }
        while live.viewers() > 0 && interrupt::requested().is_none() {
            live.hold(simulation);
        }
    }
}
