//! Records a run as an MCAP log that Lichtblick, Foxglove and Rerun replay.
//!
//! | topic | schema | when |
//! |---|---|---|
//! | `/particles` | foxglove.PointCloud: x, y, z as f32, red, green, blue, alpha as u8 | every frame, last |
//! | `/particles/columns` | unipbd.ParticleColumns | when the set of ids changed; with fields, every frame |
//! | `/diagnostics` | unipbd.Diagnostics | every frame for which there are any |
//! | `/gauges` | unipbd.Gauges: a number for each gauge, under its name | every frame, where the scene has gauges |
//! | `/boundary` | foxglove.PointCloud: samples of the walls | once |
//! | `/scene` | foxglove.SceneUpdate: walls, and bodies in their frames | once, and when a shape changed |
//! | `/tf` | foxglove.FrameTransforms: all bodies, `world` to `body/<id>` | every frame |
//! | `/bodies` | unipbd.Bodies | every frame |
//! | `/bodies/samples` | foxglove.PointCloud: samples of all bodies where they are | every frame, on request |
//! | `/log` | foxglove.Log | events |
//!
//! All messages are protobuf. Topics a run does not use are absent. Particles are in the order of
//! their ids, whatever order the solver has them in. Times are simulated times; no wall-clock time,
//! path or number of threads is in the file, so the same run gives the same bytes.

mod background;
mod body_message;
mod destination;
mod encode;
mod error;
mod fields;
mod gauge_message;
mod header;
mod messages;
mod quantity_message;
mod quantity_schema;
mod same_file;
pub mod schema;
mod shapes;
mod topic;
mod writer;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use unipbd_core::observe::{Diagnostics, Event};

use crate::snapshot::Snapshot;
use background::Background;
use encode::Encoder;
use writer::LogWriter;

pub use destination::{Destination, DestinationError, Existing, is_input};
pub use error::RecordError;
pub use fields::{Fields, UnknownField};
pub use header::Header;
pub use same_file::same_file;

pub(crate) use body_message::kind_name;
pub(crate) use header::{LOG_FORMAT, METADATA, SCENE_ATTACHMENT, log_format};
pub(crate) use messages::{Level, Log, POINT_STRIDE, PointCloud, unpack_position};
pub(crate) use quantity_message::read_diagnostics;
pub(crate) use shapes::outline as outline_to_draw;
pub(crate) use topic::Topic;

/// Writes a log frame by frame; compression and output happen on a thread of their own.
///
/// Call [`finish`](Recorder::finish): a recorder that is dropped closes its log too, but swallows
/// errors.
pub struct Recorder {
    path: PathBuf,
    encoder: Encoder,
    background: Background,
}

/// A log that is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// Frames in it.
    pub frames: u64,
    /// Its size [bytes].
    pub bytes: u64,
}

impl Recorder {
    /// Starts a log at a path; a file that is there is replaced at once (see [`Destination`] for
    /// when that is wanted).
    pub fn create(path: &Path, header: &Header, fields: Fields) -> Result<Recorder, RecordError> {
        let file = open_alone(path).map_err(|cause| RecordError::new(path, cause))?;
        Recorder::to_writer(file, path, header, fields)
    }

    /// Starts a log on any writer; errors name it by `path`.
    pub fn to_writer<W: Write + Send + 'static>(
        output: W,
        path: &Path,
        header: &Header,
        fields: Fields,
    ) -> Result<Recorder, RecordError> {
        let writer = LogWriter::new(output, header, fields).map_err(|error| RecordError::from_mcap(path, error))?;
        let background = Background::start(writer).map_err(|cause| RecordError::new(path, cause))?;
        Ok(Recorder { path: path.to_owned(), encoder: Encoder::new(header, fields), background })
    }

    /// Adds a frame with what is known about it and what happened since the last one. An error of
    /// the output may show a few frames late.
    pub fn record(
        &mut self,
        snapshot: &Snapshot,
        diagnostics: Option<&Diagnostics>,
        state_hash: Option<u64>,
        events: &[Event],
    ) -> Result<(), RecordError> {
        let mut frame = self.background.spare_frame();
        self.encoder
            .encode(snapshot, diagnostics, state_hash, events, &mut frame)
            .and_then(|()| self.background.send(frame))
            .map_err(|cause| RecordError::new(&self.path, cause))
    }

    /// Completes the log.
    pub fn finish(mut self) -> Result<Summary, RecordError> {
        let totals = self.background.finish().map_err(|cause| RecordError::new(&self.path, cause))?;
        Ok(Summary { frames: totals.frames, bytes: totals.bytes })
    }
}

/// Opens an empty file that no other recorder writes to.
fn open_alone(path: &Path) -> io::Result<File> {
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(path)?;
    if !file.metadata()?.is_file() {
        return Ok(file);
    }
    // A file system without locks is no reason to refuse.
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(io::Error::new(io::ErrorKind::ResourceBusy, "another run is writing it"));
    }
    file.set_len(0)?;
    Ok(file)
}
