use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::assemble::Assembler;
use super::record::Record;
use super::records::Records;
use super::{Frame, LogError};
use crate::record::Topic;

/// A channel whose messages are read.
struct Channel {
    topic: Topic,
    /// Messages read so far: the number of the next one.
    messages: u32,
}

/// The frames of a log, one by one. Ends after the first error.
pub struct Frames {
    records: Records,
    path: PathBuf,
    channels: BTreeMap<u16, Channel>,
    assembler: Assembler,
    failed: bool,
}

impl Frames {
    pub(crate) fn new(records: Records, path: &Path, materials: usize) -> Self {
        let assembler = Assembler::new(materials);
        Frames { records, path: path.to_owned(), channels: BTreeMap::new(), assembler, failed: false }
    }

    /// Whether the frames ended where the log is cut off. Known after the last frame.
    pub fn truncated(&self) -> bool {
        self.records.truncated()
    }

    /// Reads records up to the one that completes a frame.
    fn read_frame(&mut self) -> Result<Option<Frame>, LogError> {
        while let Some(record) = self.records.next()? {
            match record {
                Record::Channel { id, topic } => {
                    if let Some(topic) = Topic::from_name(&topic) {
                        self.channels.entry(id).or_insert(Channel { topic, messages: 0 });
                    }
                }
                Record::Message { channel, sequence, time, data } => {
                    let Some(channel) = self.channels.get_mut(&channel) else { continue };
                    let number = channel.messages;
                    channel.messages = number.wrapping_add(1);
                    let frame = if sequence == number {
                        self.assembler.add(channel.topic, time, data)
                    } else {
                        Err(format!("messages on {} are missing", channel.topic.name()))
                    };
                    if let Some(frame) = frame.map_err(|reason| LogError::damaged(&self.path, reason))? {
                        return Ok(Some(frame));
                    }
                }
                _ => {}
            }
        }
        Ok(None)
    }
}

impl Iterator for Frames {
    type Item = Result<Frame, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let frame = self.read_frame();
        self.failed = frame.is_err();
        frame.transpose()
    }
}
