use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{MAGIC, McapError};

use super::LogError;

/// Largest record or unpacked chunk that is believed [bytes]: ten million particles fit.
const RECORD_LIMIT: usize = 1 << 30;
/// Bytes read at a time, however many a record claims to have.
const READ_SIZE: usize = 1 << 20;
const CHECKSUM_SIZE: usize = 4;

/// The records of a log from its start, chunks unpacked and checked.
pub(crate) struct Records<R> {
    source: R,
    path: PathBuf,
    reader: LinearReader,
    /// Body of the record last read.
    body: Vec<u8>,
    /// Whether the file ends as a whole log does.
    whole: bool,
    end: Option<End>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Complete,
    Truncated,
    Failed,
}

impl Records<File> {
    /// Starts at the beginning of a file.
    pub(crate) fn new(mut file: File, path: &Path) -> Result<Self, LogError> {
        let fail = |cause| LogError::io(path, cause);
        let mut magic = Vec::new();
        file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(fail)?;
        if magic != MAGIC {
            return Err(LogError::foreign(path, "it is no MCAP file"));
        }
        let whole = ends_with_magic(&mut file).map_err(fail)?;
        file.rewind().map_err(fail)?;
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_record_length_limit(RECORD_LIMIT);
        let reader = LinearReader::new_with_options(options);
        Ok(Records { source: file, path: path.to_owned(), reader, body: Vec::new(), whole, end: None })
    }
}

fn ends_with_magic(file: &mut File) -> io::Result<bool> {
    let length = file.seek(SeekFrom::End(0))?;
    if length < 2 * MAGIC.len() as u64 {
        return Ok(false);
    }
    let mut magic = [0; MAGIC.len()];
    file.seek(SeekFrom::End(-(MAGIC.len() as i64)))?;
    file.read_exact(&mut magic)?;
    Ok(magic == *MAGIC)
}

impl<R: Read> Records<R> {
    /// Whether the records ended where the file is cut off.
    pub(crate) fn truncated(&self) -> bool {
        self.end == Some(End::Truncated)
    }

    /// The next record; `None` after the last one, or where the file is cut off.
    pub(crate) fn next(&mut self) -> Result<Option<Record<'_>>, LogError> {
        if self.end.is_some() {
            return Ok(None);
        }
        let opcode = match self.advance() {
            Ok(Some(opcode)) => opcode,
            Ok(None) | Err(McapError::UnexpectedEof) if !self.whole => return Ok(self.stop(End::Truncated)),
            Ok(None) => return Err(self.fail("it ends too early")),
            Err(McapError::Io(cause)) if cause.raw_os_error().is_some() => {
                self.end = Some(End::Failed);
                return Err(LogError::io(&self.path, cause));
            }
            Err(error) => return Err(self.fail(error.to_string())),
        };
        match opcode {
            op::DATA_END => return Ok(self.stop(End::Complete)),
            // The parser trusts the lengths in an attachment: check its sum before.
            op::ATTACHMENT if !attachment_is_sound(&self.body) => return Err(self.fail("its scene is damaged")),
            _ => {}
        }
        match mcap::parse_record(opcode, &self.body) {
            Ok(record) => Ok(Some(record)),
            Err(error) => {
                self.end = Some(End::Failed);
                Err(LogError::damaged(&self.path, error.to_string()))
            }
        }
    }

    /// Reads the next record into `body` and returns its kind.
    fn advance(&mut self) -> Result<Option<u8>, McapError> {
        while let Some(event) = self.reader.next_event() {
            match event? {
                LinearReadEvent::Record { data, opcode } => {
                    self.body.clear();
                    self.body.extend_from_slice(data);
                    return Ok(Some(opcode));
                }
                LinearReadEvent::ReadRequest(need) => {
                    let read = read_some(&mut self.source, self.reader.insert(need.clamp(1, READ_SIZE)))?;
                    self.reader.notify_read(read);
                }
            }
        }
        Ok(None)
    }

    fn stop<T>(&mut self, end: End) -> Option<T> {
        self.end = Some(end);
        None
    }

    fn fail(&mut self, reason: impl Into<String>) -> LogError {
        self.end = Some(End::Failed);
        LogError::damaged(&self.path, reason)
    }
}

fn read_some(source: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    loop {
        match source.read(buffer) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            other => return other,
        }
    }
}

/// Whether the checksum at the end of an attachment is that of the bytes before it.
fn attachment_is_sound(body: &[u8]) -> bool {
    let Some((bytes, checksum)) = body.split_last_chunk::<CHECKSUM_SIZE>() else { return false };
    u32::from_le_bytes(*checksum) == crc32fast::hash(bytes)
}
