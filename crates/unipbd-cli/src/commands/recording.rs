//! The log of a run, from its destination to its completion.

use std::io::IsTerminal;
use std::path::Path;

use unipbd_core::observe::{Diagnostics, Event};

use super::layout::check_free;
use crate::args::LogArgs;
use crate::exit::{Exit, Failure};
use crate::record::{Destination, DestinationError, Existing, Fields, Header, RecordError, Recorder, same_file};
use crate::report::summary::LogFile;
use crate::report::{Console, Form};
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
    pub fn destination(arguments: &LogArgs, scene: &Path, console: Console) -> Result<Option<Destination>, Failure> {
        if arguments.no_record {
            return Ok(None);
        }
        if let Some(layout) = &arguments.layout {
            check_layout(layout, arguments, scene)?;
        }
        if arguments.output.as_deref() == Some(Path::new("-")) {
            return to_standard_output(console).map(Some);
        }
        let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
        let destination = match &arguments.output {
            Some(path) => Destination::explicit(path, existing),
            None => Destination::default_for(scene, Path::new("")),
        };
        Ok(Some(destination?.sparing(scene)?))
    }

    /// Opens the log.
    pub fn start(
        destination: Destination,
        simulation: &Simulation,
        loaded: &LoadedScene,
        fields: Fields,
        console: Console,
    ) -> Result<Self, Failure> {
        if is_pipe(destination.written()) {
            console.note(format_args!("waiting for somebody to read {}", destination.written().display()));
        }
        let header = header(simulation, loaded);
        let recorder = match destination.is_standard_output() {
            true => Recorder::to_writer(std::io::stdout(), "standard output".as_ref(), &header, fields),
            false => Recorder::create(destination.written(), &header, fields),
        }?;
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

    /// Closes the log and puts it in its place: that of an older log only where the run is `whole`.
    pub fn finish(self, whole: bool, console: Console) -> Result<LogFile, Failure> {
        let summary = self.recorder.finish()?;
        let older = self.destination.target().to_owned();
        let path = if whole { self.destination.commit()? } else { self.destination.leave()? };
        if path != older {
            console.note(format_args!("{} stays; the log of this run is {}", older.display(), path.display()));
        }
        Ok(LogFile { path, bytes: summary.bytes, layout: None })
    }
}

/// The layout is made of the log, and replaces neither that nor the scene.
fn check_layout(layout: &Path, arguments: &LogArgs, scene: &Path) -> Result<(), Failure> {
    if arguments.output.as_deref() == Some(Path::new("-")) {
        return Err(Failure::usage("--layout needs a log in a file: it reads what has to be framed"));
    }
    let log = arguments.output.as_deref().unwrap_or(Path::new(""));
    if layout == log || same_file(layout, scene) || same_file(layout, log) {
        return Err(Failure::usage(format!("--layout {} is the scene or the log", layout.display())));
    }
    check_free(layout, arguments.force)
}

/// The header of the log of a run.
pub(super) fn header(simulation: &Simulation, loaded: &LoadedScene) -> Header {
    Header {
        setting: simulation.setting(&loaded.scene, &loaded.path),
        scene_text: scene_text(loaded),
        overrides: loaded.overrides.iter().map(ToString::to_string).collect(),
        seed: simulation.solver.seed(),
        fps: loaded.scene.fps,
        gravity: loaded.scene.gravity,
        gauges: loaded.scene.gauge.iter().map(|gauge| gauge.name.clone()).collect(),
    }
}

/// The text of the scene; one whose parts came from other files is written anew, with what was in them.
fn scene_text(loaded: &LoadedScene) -> String {
    let whole = loaded.has_files.then(|| toml::to_string(&loaded.scene).ok()).flatten();
    whole.unwrap_or_else(|| loaded.text.clone())
}

/// Whether this is a named pipe, which nobody can write to before somebody reads it.
fn is_pipe(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        path.metadata().is_ok_and(|found| found.file_type().is_fifo())
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}

fn to_standard_output(console: Console) -> Result<Destination, Failure> {
    if console.form == Form::Json {
        return Err(Failure::usage("-o - and --json cannot be used together: both write to standard output"));
    }
    if std::io::stdout().is_terminal() {
        return Err(Failure::usage("-o - writes a log, which no terminal shows: direct it to a file or a pipe"));
    }
    Ok(Destination::standard_output())
}

impl From<DestinationError> for Failure {
    fn from(error: DestinationError) -> Self {
        let exit = match error {
            DestinationError::Exists(_) | DestinationError::IsInput(_) => Exit::Usage,
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
