//! `run`: a scene from start to end.

use crate::expect::Watch;
use unipbd_core::observe::Diagnostics;
use unipbd_core::{BuildOptions, SolverError};

use super::recording::Recording;
use super::scene::load;
use crate::args::{RunArgs, StopCondition};
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::report::json::FrameLine;
use crate::report::summary::{LogFile, Summary};
use crate::report::{Console, Form, Outcome, Progress, Statistics};
use crate::scene_file::LoadedScene;
use crate::simulation::{Simulation, stage_names, title};

pub(super) fn run(arguments: &RunArgs, console: Console) -> Result<Exit, Failure> {
    let destination = Recording::destination(&arguments.log, &arguments.scene)?;
    let loaded = load(&arguments.scene, &arguments.changes)?;
    interrupt::listen();
    let statistics = Statistics::start();
    let options = BuildOptions { threads: arguments.threads, seed: None };
    let simulation = Simulation::new(&loaded.scene, options);
    announce(&simulation, &loaded, console);
    let recording = destination
        .map(|destination| Recording::start(destination, &simulation, &loaded, arguments.log.fields))
        .transpose()?;
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
    fn until_end(&mut self) -> Result<(Outcome, Diagnostics), Failure> {
        let mut diagnostics = self.observe()?;
        loop {
            if interrupt::requested() {
                return Ok((Outcome::Interrupted, diagnostics));
            }
            match self.simulation.next_frame() {
                None => return Ok((Outcome::Completed, diagnostics)),
                Some(Err(error)) => return Ok((self.diverged(&error), diagnostics)),
                Some(Ok(report)) => self.statistics.add_frame(&report),
            }
            diagnostics = self.observe()?;
            if let Some(message) = self.condition_met(&diagnostics) {
                return Ok((Outcome::ConditionMet { message }, diagnostics));
            }
        }
    }

    /// Shows and records the state at the start or after a frame.
    fn observe(&mut self) -> Result<Diagnostics, Failure> {
        let diagnostics = self.simulation.solver.diagnostics();
        let events = self.simulation.solver.take_events();
        self.statistics.add_state(&diagnostics);
        if let Some(watch) = &mut self.watch {
            watch.observe(&self.simulation.solver);
        }
        self.statistics.add_events(&events);
        if let Some(recording) = &mut self.recording {
            recording.frame(&self.simulation, &diagnostics, &events)?;
        }
        self.progress.events(&events);
        self.progress.frame(&diagnostics);
        if self.console.form == Form::Json {
            self.console.object(&FrameLine::from(&diagnostics))?;
        }
        Ok(diagnostics)
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
    fn close(mut self, ended: Result<(Outcome, Diagnostics), Failure>, scene: String) -> Result<Exit, Failure> {
        let log = self.recording.take().map(Recording::finish).transpose();
        let (outcome, last) = ended?;
        let log: Option<LogFile> = log?;
        let completed = matches!(outcome, Outcome::Completed);
        let violations = self.watch.filter(|_| completed).map(|watch| watch.violations(&self.simulation.solver));
        let exit = match &violations {
            Some(lines) if !lines.is_empty() => Exit::ConditionMet,
            _ => exit_of(&outcome),
        };
        let solver = &self.simulation.solver;
        let summary = Summary::new(scene, outcome, self.statistics, solver, last, log);
        match self.console.form {
            Form::Json => self.console.object(&summary.line())?,
            Form::Text if self.console.verbosity > crate::report::Verbosity::Quiet => {
                self.console.line(summary.text(self.console.verbosity))?;
            }
            Form::Text => {}
        }
        match &summary.outcome {
            Outcome::Diverged { message } => self.console.error(message),
            Outcome::ConditionMet { message } => self.console.note(format_args!("stopped by {message}")),
            Outcome::Interrupted => self.console.note("interrupted"),
            Outcome::Completed => {}
        }
        violations.iter().flatten().for_each(|line| self.console.error(format_args!("not as expected: {line}")));
        Ok(exit)
    }
}

fn exit_of(outcome: &Outcome) -> Exit {
    match outcome {
        Outcome::Completed => Exit::Success,
        Outcome::Diverged { .. } => Exit::Diverged,
        Outcome::ConditionMet { .. } => Exit::ConditionMet,
        Outcome::Interrupted => Exit::Interrupted,
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
