//! `run`: a scene from start to end.

use unipbd_core::observe::{Diagnostics, Event};
use unipbd_core::{BuildOptions, SolverError};

use super::recording::Recording;
use super::scene::{load, threads};
use crate::args::{RunArgs, StopCondition};
use crate::exit::{Exit, Failure};
use crate::expect::Watch;
use crate::interrupt;
use crate::report::json::FrameLine;
use crate::report::summary::{LogFile, Summary};
use crate::report::{Console, Form, Outcome, Progress, Statistics, Verbosity};
use crate::scene_file::LoadedScene;
use crate::simulation::{Simulation, stage_names, title};

pub(super) fn run(arguments: &RunArgs, console: Console) -> Result<Exit, Failure> {
    let destination = Recording::destination(&arguments.log, &arguments.scene, console)?;
    let loaded = load(&arguments.scene, &arguments.changes)?;
    let gauges = &loaded.scene.gauge;
    arguments.stop_on.iter().try_for_each(|condition| condition.check(gauges)).map_err(Failure::usage)?;
    let statistics = Statistics::start();
    let options = BuildOptions { threads: threads(arguments.threads)?, seed: None };
    let simulation = Simulation::new(&loaded.scene, options);
    announce(&simulation, &loaded, console);
    let recording = destination
        .map(|destination| Recording::start(destination, &simulation, &loaded, arguments.log.fields, console))
        .transpose()?;
    // Not before: a pipe that nobody reads is waited for, and a signal then ends the process.
    interrupt::listen();
    let progress = Progress::new(console, simulation.frames, loaded.scene.duration);
    let watch = arguments.expect.then(|| Watch::new(&loaded.scene));
    let mut run = Run { watch, simulation, recording, statistics, progress, console, conditions: &arguments.stop_on };
    let ended = run.until_end();
    run.progress.finish();
    run.close(ended, title(&loaded.scene, &loaded.path))
}

/// A run on its way.
struct Run<'a> {
    simulation: Simulation,
    recording: Option<Recording>,
    statistics: Statistics,
    progress: Progress,
    console: Console,
    conditions: &'a [StopCondition],
    watch: Option<Watch>,
}

impl Run<'_> {
    /// Runs to the end, whatever it is. On an error of input or output the log has yet to be closed.
    fn until_end(&mut self) -> Result<(Outcome, Option<Diagnostics>), Failure> {
        let mut diagnostics = self.observe()?;
        loop {
            if interrupt::requested().is_some() {
                return Ok((Outcome::Interrupted, diagnostics));
            }
            match self.simulation.next_frame() {
                None => return Ok((Outcome::Completed, diagnostics)),
                Some(Err(error)) => return Ok((self.diverged(&error), diagnostics)),
                Some(Ok(report)) => self.statistics.add_frame(&report),
            }
            diagnostics = self.observe()?;
            if let Some(message) = diagnostics.as_ref().and_then(|now| self.condition_met(now)) {
                return Ok((Outcome::ConditionMet { message }, diagnostics));
            }
        }
    }

    /// Whether anything reads the diagnostics of the frames: the log, the JSON lines, a condition, or the summary,
    /// whose mean and worst are those of all frames. They cost up to a fifth of a small scene's frame.
    fn is_measured(&self) -> bool {
        let shown = self.console.form == Form::Json || self.console.verbosity > Verbosity::Quiet;
        shown || self.recording.is_some() || !self.conditions.is_empty()
    }

    /// Looks at the state at the start or after a frame; measures it where anything reads that.
    fn observe(&mut self) -> Result<Option<Diagnostics>, Failure> {
        let events = self.simulation.solver.take_events();
        self.statistics.add_events(&events);
        self.progress.events(&events);
        if let Some(watch) = &mut self.watch {
            watch.observe(&self.simulation.solver);
        }
        if !self.is_measured() {
            return Ok(None);
        }
        let diagnostics = self.simulation.solver.diagnostics();
        self.show(&diagnostics, &events)?;
        Ok(Some(diagnostics))
    }

    /// Counts, records and shows a measured state.
    fn show(&mut self, diagnostics: &Diagnostics, events: &[Event]) -> Result<(), Failure> {
        self.statistics.add_state(diagnostics);
        if let Some(recording) = &mut self.recording {
            recording.frame(&self.simulation, diagnostics, events)?;
        }
        self.progress.frame(diagnostics);
        if self.console.form == Form::Json {
            self.console.object(&FrameLine::from(diagnostics))?;
        }
        Ok(())
    }

    fn diverged(&mut self, error: &SolverError) -> Outcome {
        let events = self.simulation.solver.take_events();
        self.statistics.add_events(&events);
        self.progress.events(&events);
        Outcome::Diverged { message: error.to_string() }
    }

    fn condition_met(&self, diagnostics: &Diagnostics) -> Option<String> {
        self.conditions.iter().find_map(|condition| {
            let value = condition.met_by(diagnostics)?;
            Some(format!("--stop-on {condition}: {value:.6} at {:.4} s", diagnostics.time))
        })
    }

    /// Closes the log, prints the summary and says how it ended.
    fn close(mut self, ended: Result<(Outcome, Option<Diagnostics>), Failure>, scene: String) -> Result<Exit, Failure> {
        let whole = matches!(&ended, Ok((Outcome::Completed | Outcome::ConditionMet { .. }, _)));
        let log = self.recording.take().map(|recording| recording.finish(whole, self.console)).transpose();
        let (outcome, last) = ended?;
        let log: Option<LogFile> = log?;
        let completed = matches!(outcome, Outcome::Completed);
        let violations = self.watch.filter(|_| completed).map(|watch| watch.violations(&self.simulation.solver));
        let exit = match &violations {
            Some(lines) if !lines.is_empty() => Exit::ConditionMet,
            _ => exit_of(&outcome),
        };
        if let Some(last) = last {
            let to_output = !log.as_ref().is_some_and(LogFile::is_standard_output);
            let solver = &self.simulation.solver;
            summarize(
                &Summary::new(scene, outcome.clone(), self.statistics, solver, last, log),
                self.console,
                to_output,
            )?;
        }
        match &outcome {
            Outcome::Diverged { message } => self.console.error(message),
            Outcome::ConditionMet { message } => self.console.note(format_args!("stopped by {message}")),
            Outcome::Interrupted => self.console.note("interrupted"),
            Outcome::Completed => {}
        }
        violations.iter().flatten().for_each(|line| self.console.error(format_args!("not as expected: {line}")));
        Ok(exit)
    }
}

/// Standard output is for data: where the log goes there, the summary is a message.
fn summarize(summary: &Summary, console: Console, to_output: bool) -> std::io::Result<()> {
    match console.form {
        Form::Text if !to_output => console.note(summary.text(console.verbosity)),
        Form::Json => console.object(&summary.line())?,
        Form::Text if console.verbosity > Verbosity::Quiet => console.line(summary.text(console.verbosity))?,
        Form::Text => {}
    }
    Ok(())
}

fn exit_of(outcome: &Outcome) -> Exit {
    match outcome {
        Outcome::Completed => Exit::Success,
        Outcome::Diverged { .. } => Exit::Diverged,
        Outcome::ConditionMet { .. } => Exit::ConditionMet,
        Outcome::Interrupted => interrupt::requested().unwrap_or(Exit::Interrupted),
    }
}

fn announce(simulation: &Simulation, loaded: &LoadedScene, console: Console) {
    console.detail(format_args!(
        "{}: {} frames of {:.6} s, seed {}, stages {}",
        loaded.path.display(),
        simulation.frames,
        simulation.solver.frame_time(),
        simulation.solver.seed(),
        stage_names(&simulation.solver).join(" > "),
    ));
}
