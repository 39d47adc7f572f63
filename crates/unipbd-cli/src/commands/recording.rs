//! The log of a run, from its destination to its completion.

use std::path::Path;

use unipbd_core::observe::{Diagnostics, Event};

use crate::args::LogArgs;
use crate::exit::{Exit, Failure};
use crate::record::{Destination, DestinationError, Existing, Fields, Header, RecordError, Recorder};
use crate::report::summary::LogFile;
use crate::scene_file::LoadedScene;
use crate::simulation::Simulation;

/// A log being written.
pub(super) struct Recording {
    recorder: Recorder,
    destination: Destination,
    fields: Fields,
}

impl Recording {
    /// Where the log goes; refuses before anything is run. `None` where none is wanted.
    pub fn destination(arguments: &LogArgs, scene: &Path) -> Result<Option<Destination>, Failure> {
        if arguments.no_record {
            return Ok(None);
        }
        let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
        let destination = match &arguments.output {
            Some(path) => Destination::explicit(path, existing),
            None => Destination::default_for(scene, Path::new("")),
        };
        Ok(Some(destination?))
    }

    /// Opens the log.
    pub fn start(
        destination: Destination,
        simulation: &Simulation,
        loaded: &LoadedScene,
        fields: Fields,
    ) -> Result<Self, Failure> {
        let header = Header {
            setting: simulation.setting(&loaded.scene, &loaded.path),
            scene_text: loaded.text.clone(),
            overrides: loaded.overrides.iter().map(ToString::to_string).collect(),
            seed: simulation.solver.seed(),
            fps: loaded.scene.fps,
            gravity: loaded.scene.gravity,
        };
        let recorder = Recorder::create(destination.written(), &header, fields)?;
        Ok(Recording { recorder, destination, fields })
    }

    /// Adds the state of the simulation.
    pub fn frame(
        &mut self,
        simulation: &Simulation,
        diagnostics: &Diagnostics,
        events: &[Event],
    ) -> Result<(), Failure> {
        let snapshot = simulation.snapshot(self.fields);
        let hash = simulation.solver.state_hash();
        Ok(self.recorder.record(&snapshot, Some(diagnostics), Some(hash), events)?)
    }

    /// Completes the log and puts it in its place.
    pub fn finish(self) -> Result<LogFile, Failure> {
        let summary = self.recorder.finish()?;
        Ok(LogFile { path: self.destination.commit()?, bytes: summary.bytes })
    }
}

impl From<DestinationError> for Failure {
    fn from(error: DestinationError) -> Self {
        let exit = match error {
            DestinationError::Exists(_) => Exit::Usage,
            _ => Exit::Io,
        };
        Failure::new(exit, error.to_string())
    }
}

impl From<RecordError> for Failure {
    fn from(error: RecordError) -> Self {
        Failure::io(error.to_string())
    }
}
