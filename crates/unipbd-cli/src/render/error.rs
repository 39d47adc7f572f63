use std::fmt;
use std::path::PathBuf;

use super::color_by::ColorBy;

/// Why a picture could not be made.
#[derive(Debug)]
#[non_exhaustive]
pub enum RenderError {
    /// The frames lack the column that the colours show.
    MissingColumn(ColorBy),
    /// The frames lack the velocities that arrows show.
    NoVelocities,
    /// The frame has no bodies, on which arrows show forces.
    NoBodies,
    /// The region to show is empty or not finite.
    View,
    /// The picture would be empty or absurdly large.
    PictureSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The ends of the colour map are not in order.
    Range,
    /// The output has an ending that names no format.
    Format(PathBuf),
    /// The output of a plot has an ending that names no format.
    PlotFormat(PathBuf),
    /// The output exists and must not be replaced.
    Exists(PathBuf),
    /// A setting of the job makes no sense.
    Job(&'static str),
    /// No frame lies in the chosen span of time.
    NoFrames,
    /// A frame could not be read.
    Frame(Box<dyn std::error::Error + Send + Sync>),
    /// `ffmpeg` is not installed.
    NoFfmpeg(PathBuf),
    /// `ffmpeg` failed; with what it said.
    Ffmpeg(String),
    /// The GIF would need too much memory.
    GifMemory {
        /// Most that it may take \[byte].
        limit: usize,
    },
    /// The GIF does not fit into the size asked for.
    GifSize {
        /// Bytes asked for.
        limit: u64,
    },
    /// A file could not be written.
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RenderError::MissingColumn(by) => {
                let [name, field] = [by.name(), by.field().unwrap_or(by.name())];
                write!(f, "the frames have no {field} column to colour by {name}: record it with --fields {field}")
            }
            RenderError::NoVelocities => {
                write!(f, "the frames have no velocity column for arrows: record it with --fields velocity")
            }
            RenderError::NoBodies => write!(f, "arrows of force stand at bodies, and there are none"),
            RenderError::View => {
                write!(f, "the view is empty: its upper right corner must lie above and right of its lower left one")
            }
            RenderError::PictureSize { width, height } => {
                write!(f, "cannot draw a picture of {width} x {height} pixels")
            }
            RenderError::Range => write!(f, "the range of the colour map must run from a smaller to a larger number"),
            RenderError::Format(path) => write!(
                f,
                "cannot tell the format of {}: use NAME.png, NAME.svg, NAME.pdf, NAME_%04d.png, DIRECTORY/, NAME.gif, NAME.mp4 or NAME.html",
                path.display()
            ),
            RenderError::PlotFormat(path) => {
                write!(f, "cannot tell the format of {}: use NAME.svg, NAME.pdf or NAME.png", path.display())
            }
            RenderError::Exists(path) => {
                write!(f, "{} exists and was not made from this run: use --force to replace it", path.display())
            }
            RenderError::Job(what) => write!(f, "{what}"),
            RenderError::NoFrames => write!(f, "no frame lies in the chosen span of time"),
            RenderError::Frame(source) => write!(f, "{source}"),
            RenderError::NoFfmpeg(program) => write!(
                f,
                "MP4 needs {}, which was not found: install ffmpeg, or write a .gif or PNG frames instead",
                program.display()
            ),
            RenderError::Ffmpeg(message) => write!(f, "ffmpeg failed: {message}"),
            RenderError::GifMemory { limit } => write!(
                f,
                "the GIF needs more than {} MB of memory: use fewer frames (--every, --from, --to), a smaller --width, or .mp4",
                limit / 1_000_000
            ),
            RenderError::GifSize { limit } => {
                write!(f, "the GIF does not fit into {limit} bytes: use fewer frames or a smaller --width")
            }
            RenderError::Write { path, source } => write!(f, "cannot write {}: {source}", path.display()),
        }
    }
}

impl std::error::Error for RenderError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            RenderError::Write { source, .. } => Some(source),
            RenderError::Frame(source) => source.source(),
            _ => None,
        }
    }
}
