use std::path::{Path, PathBuf};

use super::encode::{GifOptions, GifWriter, Mp4Writer, write_png};
use super::error::RenderError;
use super::options::RenderOptions;
use super::origin::Origin;
use super::output::{Numbered, Output, plan_output};
use super::renderer::Renderer;
use super::replay::{MOST_FPS, Replay};
use super::select::{Cadence, Selection};
use super::sheet::Sheet;
use super::vector;
use super::view::View;
use crate::snapshot::{Setting, Snapshot};

/// Whether an output that exists may be replaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// An existing output is an error, unless it was made from the same run.
    #[default]
    Keep,
    /// An existing output is replaced.
    Replace,
}

/// Description of a rendering: its output, and how it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderJob {
    /// Where to write; see [`plan_output`].
    pub output: PathBuf,
    /// Whether an existing output may be replaced.
    pub existing: Existing,
    /// The run that the pictures show: they carry it, and one of the same run may be replaced.
    pub origin: Option<Origin>,
    /// Which frames to draw.
    pub selection: Selection,
    /// Simulated seconds shown in a second of a film.
    pub speed: f64,
    /// How pictures look.
    pub options: RenderOptions,
    /// How a GIF is compressed.
    pub gif: GifOptions,
    /// The program that makes MP4 files.
    pub ffmpeg: PathBuf,
}

impl RenderJob {
    /// A job with default settings.
    pub fn new(output: impl Into<PathBuf>) -> RenderJob {
        RenderJob {
            output: output.into(),
            existing: Existing::default(),
            origin: None,
            selection: Selection::default(),
            speed: 1.0,
            options: RenderOptions::default(),
            gif: GifOptions::default(),
            ffmpeg: PathBuf::from("ffmpeg"),
        }
    }

    /// Refuses to replace a file unless the job allows it, or the file was made from the same run.
    pub fn check_free(&self, path: &Path) -> Result<(), RenderError> {
        let taken = self.existing == Existing::Keep && path.symlink_metadata().is_ok();
        if taken && !self.origin.as_ref().is_some_and(|origin| origin.made(path)) {
            return Err(RenderError::Exists(path.to_owned()));
        }
        Ok(())
    }

    fn mark(&self) -> &str {
        self.origin.as_ref().map_or("", Origin::mark)
    }
}

/// Result of a rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// Pictures drawn.
    pub frames: u64,
    /// The file, or the first of many.
    pub path: PathBuf,
    /// Size of the pictures in pixels.
    pub size: [u32; 2],
    /// Frames a second of a film.
    pub fps: Option<f64>,
}

/// Draws the chosen frames and writes them; `progress` hears the number of frames read so far.
///
/// For films give the options a [`Survey`](super::Survey) first unless view and range are known:
/// left open, the view is fitted to the first frame and the range widens as the film goes on.
pub fn run<E: Into<Box<dyn std::error::Error + Send + Sync>>>(
    frames: impl Iterator<Item = Result<Snapshot, E>>,
    setting: &Setting,
    job: &RenderJob,
    mut progress: impl FnMut(u64),
) -> Result<Rendered, RenderError> {
    job.selection.check()?;
    if !(job.speed > 0.0 && job.speed.is_finite()) {
        return Err(RenderError::Job("the speed must be a positive number"));
    }
    let output = plan_output(&job.output)?;
    let mut count = 0;
    let frames = frames.map(|frame| {
        count += 1;
        progress(count);
        frame.map_err(|error| RenderError::Frame(error.into()))
    });
    let renderer = Renderer::new(setting, job.options.clone());
    match output {
        Output::Picture(path) => picture(frames, renderer, job, &path),
        Output::Pictures(names) => pictures(frames, renderer, job, &names),
        Output::Gif(path) => film(frames, renderer, job, &path, Format::Gif),
        Output::Mp4(path) => film(frames, renderer, job, &path, Format::Mp4),
        Output::Svg(path) => still(frames, setting, job, &path, |sheet, mark| sheet.svg(mark).into_bytes()),
        Output::Pdf(path) => still(frames, setting, job, &path, Sheet::pdf),
        Output::Replay(path) => replay(frames, setting, job, &path),
    }
}

fn picture(
    frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    mut renderer: Renderer,
    job: &RenderJob,
    path: &Path,
) -> Result<Rendered, RenderError> {
    job.check_free(path)?;
    let frame = job.selection.single(frames)?;
    let image = renderer.draw(&frame)?;
    write_png(path, image, job.mark())?;
    Ok(Rendered { frames: 1, path: path.to_owned(), size: [image.width(), image.height()], fps: None })
}

fn pictures(
    frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    mut renderer: Renderer,
    job: &RenderJob,
    names: &Numbered,
) -> Result<Rendered, RenderError> {
    if let Some(folder) = names.path(0).parent() {
        std::fs::create_dir_all(folder).map_err(|source| RenderError::Write { path: folder.to_owned(), source })?;
    }
    let mut done = Rendered { frames: 0, path: names.path(0), size: [0; 2], fps: None };
    for frame in job.selection.many(frames) {
        let path = names.path(done.frames);
        job.check_free(&path)?;
        let image = renderer.draw(&frame?)?;
        write_png(&path, image, job.mark())?;
        done.size = [image.width(), image.height()];
        done.frames += 1;
    }
    if done.frames == 0 { Err(RenderError::NoFrames) } else { Ok(done) }
}

/// Writes one picture of vectors.
fn still(
    frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    setting: &Setting,
    job: &RenderJob,
    path: &Path,
    form: impl FnOnce(&Sheet, &str) -> Vec<u8>,
) -> Result<Rendered, RenderError> {
    job.check_free(path)?;
    let frame = job.selection.single(frames)?;
    let sheet = vector::draw(setting, &job.options, &frame)?;
    std::fs::write(path, form(&sheet, job.mark()))
        .map_err(|source| RenderError::Write { path: path.to_owned(), source })?;
    let size = sheet.size().map(|length| length.round() as u32);
    Ok(Rendered { frames: 1, path: path.to_owned(), size, fps: None })
}

/// Writes a page; the view is fitted to the first frame unless it is known.
fn replay(
    frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    setting: &Setting,
    job: &RenderJob,
    path: &Path,
) -> Result<Rendered, RenderError> {
    job.check_free(path)?;
    if job.options.vectors.is_some() {
        return Err(RenderError::Job("a page draws no arrows: choose PNG, SVG, PDF or a film for --vectors"));
    }
    let cadence = Cadence::new(1.0, MOST_FPS, job.selection.every);
    let (fps, mut frames) = cadence.apply(job.selection.many(frames))?;
    let first = frames.next().ok_or(RenderError::NoFrames)??;
    let mut options = job.options.clone();
    let of_scene = setting.view.map(|(min, max)| View { min, max });
    let view = options.view.or(of_scene).unwrap_or_else(|| View::fit(setting, [&first]));
    options.view = Some(view);
    let mut page = Replay::new(setting, &options, view);
    for frame in std::iter::once(Ok(first)).chain(frames) {
        let mut frame = frame?;
        frame.sort_by_id();
        page.push(&frame);
    }
    let done = Rendered { frames: page.frames(), path: path.to_owned(), size: [0; 2], fps: Some(fps) };
    page.finish(path, job.mark())?;
    Ok(done)
}

/// Kinds of films.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Gif,
    Mp4,
}

impl Format {
    /// Frames a second above which frames are left out, unless the job says which to take.
    fn most_fps(self) -> f64 {
        match self {
            Format::Gif => 25.0,
            Format::Mp4 => 60.0,
        }
    }
}

/// A film being written.
enum Film {
    Gif(GifWriter),
    Mp4(Mp4Writer),
}

fn film(
    frames: impl Iterator<Item = Result<Snapshot, RenderError>>,
    mut renderer: Renderer,
    job: &RenderJob,
    path: &Path,
    format: Format,
) -> Result<Rendered, RenderError> {
    job.check_free(path)?;
    let cadence = Cadence::new(job.speed, format.most_fps(), job.selection.every);
    let (fps, frames) = cadence.apply(job.selection.many(frames))?;
    let mut film: Option<Film> = None;
    let mut done = Rendered { frames: 0, path: path.to_owned(), size: [0; 2], fps: Some(fps) };
    for frame in frames {
        let image = renderer.draw(&frame?)?;
        let film = match &mut film {
            Some(film) => film,
            None => film.insert(match format {
                Format::Gif => Film::Gif(GifWriter::new(path, fps, job.gif).marked(job.mark())),
                Format::Mp4 => Film::Mp4(Mp4Writer::new(path, fps, image, &job.ffmpeg)?),
            }),
        };
        match film {
            Film::Gif(writer) => writer.push(image)?,
            Film::Mp4(writer) => writer.push(image)?,
        }
        done.size = [image.width(), image.height()];
        done.frames += 1;
    }
    match film.ok_or(RenderError::NoFrames)? {
        Film::Gif(writer) => writer.finish()?,
        Film::Mp4(writer) => writer.finish()?,
    }
    Ok(done)
}
