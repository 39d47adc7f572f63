use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::LogError;
use super::chunk::{unpack, unpacked_bound};
use super::record::{Record, op};

/// The first and the last bytes of a whole log.
pub(super) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Kind and length of a record.
const PREFIX: usize = 9;

/// The records of a log from its start, chunks unpacked and checked. Memory is bounded by the size of the file times a
/// constant, whatever lengths are in it.
pub(crate) struct Records {
    source: BufReader<File>,
    path: PathBuf,
    /// Size of the file, and how much of it is not read yet \[bytes].
    size: u64,
    left: u64,
    /// Checksum of what was read, for the end of the data.
    sum: crc32fast::Hasher,
    /// Body of the record last read.
    body: Vec<u8>,
    /// The records of the chunk last read, and where the next of them is.
    chunk: Vec<u8>,
    place: usize,
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

/// A record that was found: in the chunk, or in `body`.
enum Found {
    InChunk(u8, std::ops::Range<usize>),
    InFile(u8),
    /// There is nothing more.
    Nothing,
}

/// Why a record cannot be read.
enum Fault {
    Io(io::Error),
    /// The file ends within it.
    Cut,
    Wrong(String),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::UnexpectedEof { Fault::Cut } else { Fault::Io(error) }
    }
}

impl Records {
    /// Starts at the beginning of a file.
    pub(crate) fn new(mut file: File, path: &Path) -> Result<Self, LogError> {
        let fail = |cause| LogError::io(path, cause);
        let mut magic = Vec::new();
        file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(fail)?;
        if magic != MAGIC {
            return Err(LogError::foreign(path, "it is no MCAP file"));
        }
        let size = file.seek(SeekFrom::End(0)).map_err(fail)?;
        let whole = ends_with_magic(&mut file, size).map_err(fail)?;
        file.seek(SeekFrom::Start(MAGIC.len() as u64)).map_err(fail)?;
        let mut sum = crc32fast::Hasher::new();
        sum.update(&MAGIC);
        let (source, left) = (BufReader::with_capacity(1 << 18, file), size - MAGIC.len() as u64);
        let (body, chunk) = (Vec::new(), Vec::new());
        Ok(Records { source, path: path.to_owned(), size, left, sum, body, chunk, place: 0, whole, end: None })
    }

    /// Whether the records ended where the file is cut off.
    pub(crate) fn truncated(&self) -> bool {
        self.end == Some(End::Truncated)
    }

    /// The next record; `None` after the last one, or where the file is cut off.
    pub(crate) fn next(&mut self) -> Result<Option<Record<'_>>, LogError> {
        if self.end.is_some() {
            return Ok(None);
        }
        let (opcode, range) = match self.advance() {
            Ok(Found::InChunk(opcode, range)) => (opcode, Some(range)),
            Ok(Found::InFile(op::DATA_END)) => return self.finish(),
            Ok(Found::InFile(opcode)) => (opcode, None),
            Ok(Found::Nothing) | Err(Fault::Cut) if !self.whole => {
                self.end = Some(End::Truncated);
                return Ok(None);
            }
            Ok(Found::Nothing) | Err(Fault::Cut) => return Err(self.fail("it ends too early")),
            Err(Fault::Wrong(reason)) => return Err(self.fail(reason)),
            Err(Fault::Io(cause)) => {
                self.end = Some(End::Failed);
                return Err(LogError::io(&self.path, cause));
            }
        };
        let body = range.map_or(&self.body[..], |range| &self.chunk[range]);
        match Record::parse(opcode, body) {
            Some(record) => Ok(Some(record)),
            None => {
                self.end = Some(End::Failed);
                let what = if opcode == op::ATTACHMENT { "its scene" } else { "a record in it" };
                Err(LogError::damaged(&self.path, format!("{what} is damaged")))
            }
        }
    }

    /// Finds the next record: in the chunk, while there are any.
    fn advance(&mut self) -> Result<Found, Fault> {
        loop {
            if self.place < self.chunk.len() {
                return self.next_in_chunk();
            }
            if self.left == 0 {
                return Ok(Found::Nothing);
            }
            let before = self.sum.clone();
            let opcode = self.read_record()?;
            match opcode {
                op::CHUNK => {
                    self.chunk = unpack(&self.body, unpacked_bound(self.size)).map_err(Fault::Wrong)?;
                    self.place = 0;
                }
                op::DATA_END => {
                    self.sum = before;
                    return Ok(Found::InFile(opcode));
                }
                _ => return Ok(Found::InFile(opcode)),
            }
        }
    }

    fn next_in_chunk(&mut self) -> Result<Found, Fault> {
        let short = || Fault::Wrong("a record in a chunk ends too early".to_owned());
        let rest = &self.chunk[self.place..];
        let prefix: &[u8; PREFIX] = rest.first_chunk().ok_or_else(short)?;
        let [opcode, length @ ..] = *prefix;
        let length = usize::try_from(u64::from_le_bytes(length)).ok();
        let length = length.filter(|length| *length <= rest.len() - PREFIX).ok_or_else(short)?;
        let start = self.place + PREFIX;
        self.place = start + length;
        Ok(Found::InChunk(opcode, start..start + length))
    }

    /// Reads a record of the file into `body` and returns its kind.
    fn read_record(&mut self) -> Result<u8, Fault> {
        let mut prefix = [0; PREFIX];
        self.source.read_exact(&mut prefix)?;
        let [opcode, length @ ..] = prefix;
        let length = u64::from_le_bytes(length);
        self.left = self.left.saturating_sub(PREFIX as u64);
        if length > self.left {
            return Err(Fault::Cut);
        }
        self.body.clear();
        let read = self.source.by_ref().take(length).read_to_end(&mut self.body)?;
        self.left -= length;
        if (read as u64) < length {
            return Err(Fault::Cut);
        }
        self.sum.update(&prefix);
        self.sum.update(&self.body);
        Ok(opcode)
    }

    /// The end of the data: its checksum counts, where there is one.
    fn finish(&mut self) -> Result<Option<Record<'_>>, LogError> {
        let sum = self.sum.clone().finalize();
        match self.body.first_chunk().map(|sum| u32::from_le_bytes(*sum)) {
            None => Err(self.fail("it ends too early")),
            Some(saved) if saved != 0 && saved != sum => Err(self.fail("the checksum of its data does not match")),
            Some(_) => {
                self.end = Some(End::Complete);
                Ok(None)
            }
        }
    }

    fn fail(&mut self, reason: impl Into<String>) -> LogError {
        self.end = Some(End::Failed);
        LogError::damaged(&self.path, reason)
    }
}

fn ends_with_magic(file: &mut File, size: u64) -> io::Result<bool> {
    if size < 2 * MAGIC.len() as u64 {
        return Ok(false);
    }
    let mut magic = [0; MAGIC.len()];
    file.seek(SeekFrom::End(-(MAGIC.len() as i64)))?;
    file.read_exact(&mut magic)?;
    Ok(magic == MAGIC)
}
