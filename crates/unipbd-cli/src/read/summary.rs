use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::record::{Record, op};
use super::records::MAGIC;
use super::wire::Wire;
use crate::record::Topic;

/// Contents of the summary of a complete log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Frames in the log.
    pub frames: u64,
    /// Simulated time of the first message \[s].
    pub start: f64,
    /// Simulated time of the last message \[s].
    pub end: f64,
}

/// The footer: kind, length, two places in the file and a checksum.
const FOOTER: u64 = 1 + 8 + 8 + 8 + 4;
/// Largest summary that is read \[bytes]: some hundred bytes for each frame of an hour.
const LARGEST: u64 = 256 << 20;

/// Counts of messages and times of the first and the last one.
struct Statistics {
    start: u64,
    end: u64,
    messages: BTreeMap<u16, u64>,
}

/// Reads the summary at the end of a log; `None` where there is no sound one.
pub(crate) fn read_totals(path: &Path) -> Option<Totals> {
    let section = read_section(&mut File::open(path).ok()?)?;
    let (mut channel, mut statistics) = (None, None);
    let mut wire = Wire(&section);
    while !wire.0.is_empty() {
        let ([opcode], length) = (wire.bytes(1)?, wire.u64()?) else { return None };
        let body = wire.bytes(length)?;
        match *opcode {
            op::STATISTICS => statistics = Some(Statistics::parse(body)?),
            op::CHANNEL => {
                if let Record::Channel { id, topic } = Record::parse(op::CHANNEL, body)?
                    && topic == Topic::Particles.name()
                {
                    channel = Some(id);
                }
            }
            _ => {}
        }
    }
    let statistics = statistics?;
    let frames = channel.and_then(|channel| statistics.messages.get(&channel)).copied();
    let (start, end) = (statistics.start as f64 / 1e9, statistics.end as f64 / 1e9);
    Some(Totals { frames: frames.unwrap_or(0), start, end })
}

/// The summary without the footer, if the checksum of both is right.
fn read_section(file: &mut File) -> Option<Vec<u8>> {
    let size = file.metadata().ok()?.len();
    let end = size.checked_sub(FOOTER + MAGIC.len() as u64)?;
    file.seek(SeekFrom::Start(end)).ok()?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail).ok()?;
    let mut wire = Wire(&tail);
    let ([op::FOOTER], 20) = (wire.bytes(1)?, wire.u64()?) else { return None };
    let (start, _offsets, checksum) = (wire.u64()?, wire.u64()?, wire.u32()?);
    let length = end.checked_sub(start).filter(|length| start > 0 && *length <= LARGEST)?;
    if wire.0 != MAGIC {
        return None;
    }
    file.seek(SeekFrom::Start(start)).ok()?;
    let mut section = Vec::new();
    file.take(length).read_to_end(&mut section).ok()?;
    let mut sum = crc32fast::Hasher::new();
    sum.update(&section);
    sum.update(&tail[..FOOTER as usize - 4]);
    (checksum == 0 || checksum == sum.finalize()).then_some(section)
}

impl Statistics {
    fn parse(body: &[u8]) -> Option<Statistics> {
        let mut wire = Wire(body);
        let (_messages, _schemas, _channels) = (wire.u64()?, wire.u16()?, wire.u32()?);
        let (_attachments, _metadata, _chunks) = (wire.u32()?, wire.u32()?, wire.u32()?);
        let (start, end, length) = (wire.u64()?, wire.u64()?, wire.u32()?);
        let mut counts = Wire(wire.bytes(length.into())?);
        let mut messages = BTreeMap::new();
        while !counts.0.is_empty() {
            messages.insert(counts.u16()?, counts.u64()?);
        }
        Some(Statistics { start, end, messages })
    }
}
