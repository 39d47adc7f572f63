//! `render`: pictures of a log, or of a scene that is run for them.

use unipbd_core::BuildOptions;

use super::recording::header;
use super::scene::{load, threads};
use crate::args::{LookArgs, RenderArgs, is_log};
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::read::{Log, LogError};
use crate::record::{Fields, Header, is_input, same_file};
use crate::render::{
    self, Annotations, ColorBy, Existing, Origin, Output, Range, RenderError, RenderJob, RenderOptions, Rendered,
    Speeds, TimeStamp, Vectors,
};
use crate::report::format::plural;
use crate::report::{Console, Counter, Form};
use crate::scene_file::LoadedScene;
use crate::simulation::Simulation;
use crate::snapshot::{Setting, Snapshot};

pub(super) fn render(arguments: &RenderArgs, console: Console) -> Result<Exit, Failure> {
    let mut job = job(arguments);
    if same_file(&arguments.source, &arguments.output) {
        return Err(Failure::usage(is_input(&arguments.output)));
    }
    let source = Source::open(arguments)?;
    let header = source.header();
    job.origin = Some(Origin::new(&header.run_sha256()));
    refuse_existing(&job)?;
    interrupt::listen();
    let setting = header.setting;
    if is_film(&job)? && render::Survey::is_needed(&setting, &job.options) {
        job.options = survey(&source, &setting, &job, console)?;
    }
    let counter = Counter::new(console, "drawing", source.frame_count());
    let rendered = render::run(source.frames()?, &setting, &job, |count| counter.show(count));
    counter.finish();
    announce(&rendered.map_err(|error| source.explain(error))?, console)?;
    Ok(Exit::Success)
}

fn job(arguments: &RenderArgs) -> RenderJob {
    let (frames, look) = (&arguments.frames, &arguments.look);
    RenderJob {
        existing: if arguments.force { Existing::Replace } else { Existing::Keep },
        selection: render::Selection { time: frames.time, from: frames.from, to: frames.to, every: frames.every },
        speed: frames.speed,
        options: RenderOptions {
            width: look.width,
            color_by: look.color,
            style: look.style,
            background: look.background,
            range: look.range.unwrap_or(Range::Automatic),
            view: look.view,
            time_stamp: if look.no_time_stamp { TimeStamp::Hidden } else { TimeStamp::Shown },
            annotations: Annotations { axes: look.axes, scale_bar: look.scale_bar, legend: look.legend },
            vectors: look.vectors,
            longest_vector: look.vector_max,
        },
        ffmpeg: arguments.ffmpeg.clone(),
        ..RenderJob::new(&arguments.output)
    }
}

/// Says so before the frames of a scene are made for an output that must not be replaced.
fn refuse_existing(job: &RenderJob) -> Result<(), Failure> {
    match render::plan_output(&job.output)? {
        Output::Picture(path)
        | Output::Svg(path)
        | Output::Pdf(path)
        | Output::Gif(path)
        | Output::Mp4(path)
        | Output::Replay(path) => Ok(job.check_free(&path)?),
        Output::Pictures(_) if job.selection.time.is_some() => {
            Err(Failure::usage("--time asks for one picture: give a single name, such as picture.png"))
        }
        _ => Ok(()),
    }
}

/// Whether more than one picture is drawn, which view and colours should outlast.
fn is_film(job: &RenderJob) -> Result<bool, Failure> {
    Ok(!matches!(render::plan_output(&job.output)?, Output::Picture(_) | Output::Svg(_) | Output::Pdf(_)))
}

/// Goes through all frames once to find a view and colours that fit them all. A scene is run for
/// it, which costs its time again but no memory.
fn survey(source: &Source, setting: &Setting, job: &RenderJob, console: Console) -> Result<RenderOptions, Failure> {
    let counter = Counter::new(console, "looking for view and colours", source.frame_count());
    let mut survey = render::Survey::new(setting, job.options.clone());
    for (index, frame) in source.frames()?.enumerate() {
        survey.include(&frame?).map_err(|error| source.explain(error))?;
        counter.show(index as u64 + 1);
    }
    counter.finish();
    Ok(survey.finish())
}

fn announce(rendered: &Rendered, console: Console) -> Result<(), Failure> {
    let [width, height] = rendered.size;
    match console.form {
        Form::Json => console.object(&serde_json::json!({
            "type": "rendered",
            "path": rendered.path.display().to_string(),
            "frames": rendered.frames,
            "size": rendered.size,
            "fps": rendered.fps,
        }))?,
        Form::Text if width == 0 => {
            console.note(format_args!("{}: {}", rendered.path.display(), plural(rendered.frames, "frame")));
        }
        Form::Text => console.note(format_args!(
            "{}: {} of {width} x {height} pixels",
            rendered.path.display(),
            plural(rendered.frames, "picture")
        )),
    }
    Ok(())
}

/// Where frames come from.
enum Source {
    Log { log: Box<Log>, with_velocities: bool },
    Scene { loaded: Box<LoadedScene>, options: BuildOptions, fields: Fields },
}

impl Source {
    fn open(arguments: &RenderArgs) -> Result<Self, Failure> {
        if is_log(&arguments.source) {
            arguments.changes.refuse_for_log()?;
            let with_velocities = fields_for(&arguments.look).velocity;
            return Ok(Source::Log { log: Box::new(Log::open(&arguments.source)?), with_velocities });
        }
        let loaded = load(&arguments.source, &arguments.changes)?;
        let options = BuildOptions { threads: threads(arguments.threads)?, seed: None };
        Ok(Source::Scene { loaded: Box::new(loaded), options, fields: fields_for(&arguments.look) })
    }

    fn header(&self) -> Header {
        match self {
            Source::Log { log, .. } => log.header().clone(),
            Source::Scene { loaded, options, .. } => header(&Simulation::new(&loaded.scene, options.clone()), loaded),
        }
    }

    fn frame_count(&self) -> Option<u64> {
        match self {
            Source::Log { log, .. } => log.totals().map(|totals| totals.frames),
            Source::Scene { loaded, .. } => Some(crate::simulation::frame_count(&loaded.scene) + 1),
        }
    }

    fn frames(&self) -> Result<Box<dyn Iterator<Item = Result<Snapshot, Failure>>>, Failure> {
        let frames: Box<dyn Iterator<Item = Result<Snapshot, Failure>>> = match self {
            Source::Log { log, with_velocities } => {
                let mut speeds = Speeds::default();
                let with_velocities = *with_velocities;
                Box::new(log.frames()?.map(move |frame| {
                    let mut snapshot = frame?.snapshot;
                    if with_velocities {
                        speeds.fill(&mut snapshot);
                    }
                    Ok(snapshot)
                }))
            }
            Source::Scene { loaded, options, fields } => Box::new(SceneFrames {
                simulation: Simulation::new(&loaded.scene, options.clone()),
                fields: *fields,
                at_start: true,
            }),
        };
        Ok(Box::new(frames.map(|frame| match interrupt::requested() {
            Some(exit) => Err(Failure::new(exit, "interrupted")),
            None => frame,
        })))
    }

    /// A scene has every column that its materials have, so no flag helps.
    fn explain(&self, error: RenderError) -> Failure {
        match (self, &error) {
            (Source::Scene { .. }, RenderError::MissingColumn(by)) => {
                Failure::usage(format!("no material of the scene has a {}", by.name()))
            }
            _ => error.into(),
        }
    }
}

/// The frames of a scene, from its start.
struct SceneFrames {
    simulation: Simulation,
    fields: Fields,
    at_start: bool,
}

impl Iterator for SceneFrames {
    type Item = Result<Snapshot, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        if !std::mem::take(&mut self.at_start)
            && let Err(error) = self.simulation.next_frame()?
        {
            return Some(Err(Failure::new(Exit::Diverged, error.to_string())));
        }
        Some(Ok(self.simulation.snapshot(self.fields)))
    }
}

/// The columns that pictures need.
fn fields_for(look: &LookArgs) -> Fields {
    Fields {
        velocity: look.color == ColorBy::Speed || look.vectors == Some(Vectors::Velocity),
        density: look.color == ColorBy::Density,
        temperature: look.color == ColorBy::Temperature,
        samples: false,
    }
}

impl From<LogError> for Failure {
    fn from(error: LogError) -> Self {
        Failure::io(error.to_string())
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Frame(source) => match source.downcast::<Failure>() {
                Ok(failure) => *failure,
                Err(other) => Failure::io(other.to_string()),
            },
            RenderError::NoFfmpeg(_) | RenderError::Ffmpeg(_) | RenderError::Write { .. } => {
                Failure::io(error.to_string())
            }
            other => Failure::usage(other.to_string()),
        }
    }
}
