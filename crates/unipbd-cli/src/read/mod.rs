//! Reads the logs that [`record`](crate::record) writes: whole ones, and ones cut off by a crash.
//!
//! Reading needs no summary or index: a log is read from its start, so one without an end gives all
//! frames up to the cut.

mod assemble;
mod chunk;
mod error;
mod frames;
mod guard;
mod record;
mod records;
mod summary;
mod topics;
mod wire;

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use unipbd_core::observe::{Diagnostics, Event};

use crate::record::{Fields, Header, LOG_FORMAT, METADATA, SCENE_ATTACHMENT, log_format};
use crate::snapshot::{Setting, Snapshot};
use record::Record;
use records::Records;
pub(crate) use topics::{Traffic, topics};

pub use error::LogError;
pub use frames::Frames;
pub use summary::Totals;

/// A log on disk.
#[derive(Clone, Debug)]
pub struct Log {
    path: PathBuf,
    version: String,
    header: Header,
    fields: Fields,
    totals: Option<Totals>,
}

/// A frame of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Particles, in ascending order of their ids, and bodies.
    pub snapshot: Snapshot,
    /// Numbers about the frame, where the run recorded them.
    pub diagnostics: Option<Diagnostics>,
    /// Hash of the state, where the run recorded it.
    pub state_hash: Option<u64>,
    /// Events since the frame before.
    pub events: Vec<Event>,
}

impl Log {
    /// Opens a log and reads what it says once.
    pub fn open(path: &Path) -> Result<Log, LogError> {
        let file = File::open(path).map_err(|cause| LogError::io(path, cause))?;
        let (scene, metadata) = read_opening(path, Records::new(file, path)?)?;
        let format = log_format(&metadata).map_err(|reason| LogError::damaged(path, reason))?;
        if format > LOG_FORMAT {
            let version = metadata.get("version").cloned().unwrap_or_default();
            return Err(LogError::Newer { path: path.to_owned(), format, version });
        }
        let scene_text = String::from_utf8(scene).map_err(|_| LogError::damaged(path, "its scene is not UTF-8"))?;
        let (header, fields) =
            Header::from_metadata(&metadata, scene_text).map_err(|reason| LogError::damaged(path, reason))?;
        if metadata.get("scene_sha256") != Some(&header.scene_sha256()) {
            return Err(LogError::damaged(path, "its scene does not have the recorded SHA-256"));
        }
        let version = metadata.get("version").cloned().unwrap_or_default();
        let totals = summary::read_totals(path);
        Ok(Log { path: path.to_owned(), version, header, fields, totals })
    }

    /// Where the log is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Version of unipbd that wrote it.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Scene, seed, overrides and the like.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Constant data of the run.
    pub fn setting(&self) -> &Setting {
        &self.header.setting
    }

    /// Fields that were asked for.
    pub fn fields(&self) -> Fields {
        self.fields
    }

    /// Contents of the summary; `None` for a log that was cut off.
    pub fn totals(&self) -> Option<Totals> {
        self.totals
    }

    /// Reads the frames one by one from the start.
    pub fn frames(&self) -> Result<Frames, LogError> {
        let file = File::open(&self.path).map_err(|cause| LogError::io(&self.path, cause))?;
        Ok(Frames::new(Records::new(file, &self.path)?, &self.path, self.header.setting.materials.len()))
    }
}

/// Scene and metadata, which stand before all messages.
fn read_opening(path: &Path, mut records: Records) -> Result<(Vec<u8>, BTreeMap<String, String>), LogError> {
    let (mut scene, mut metadata) = (None, None);
    while scene.is_none() || metadata.is_none() {
        match records.next()? {
            Some(Record::Attachment { name, data }) if name == SCENE_ATTACHMENT => scene = Some(data.to_vec()),
            Some(Record::Metadata { name, entries }) if name == METADATA => metadata = Some(entries),
            None | Some(Record::Schema | Record::Channel { .. } | Record::Message { .. }) => break,
            Some(_) => {}
        }
    }
    match (scene, metadata) {
        (Some(scene), Some(metadata)) => Ok((scene, metadata)),
        _ if records.truncated() => Err(LogError::damaged(path, "it ends before its first frame")),
        _ => Err(LogError::foreign(path, "it is an MCAP file without a unipbd scene in it")),
    }
}
