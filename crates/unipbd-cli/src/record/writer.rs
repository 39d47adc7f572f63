use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, McapResult, WriteOptions};

use super::encode::EncodedFrame;
use super::header::{METADATA, SCENE_ATTACHMENT};
use super::topic::Topic;
use super::{Fields, Header};

const CHUNK_SIZE: u64 = 1024 * 1024;
const BUFFER_SIZE: usize = 256 * 1024;

/// Totals of a log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Totals {
    pub(crate) frames: u64,
    pub(crate) bytes: u64,
}

struct ChannelState {
    id: u16,
    messages: u32,
}

/// Puts encoded frames into an MCAP file. Chunks are put together in memory and written at once,
/// so a log that is cut off holds no half-described chunk, and the output need not seek.
pub(crate) struct LogWriter<W: Write> {
    mcap: mcap::Writer<NoSeek<BufWriter<W>>>,
    channels: BTreeMap<Topic, ChannelState>,
    /// Names of the gauges: fields of their messages.
    gauges: Vec<String>,
    frames: u64,
}

impl<W: Write> LogWriter<W> {
    /// Starts a log: scene and metadata come first, so that they survive a crash.
    pub(crate) fn new(output: W, header: &Header, fields: Fields) -> McapResult<Self> {
        let output = NoSeek::new(BufWriter::with_capacity(BUFFER_SIZE, output));
        let mut mcap = WriteOptions::new()
            .profile("")
            .library(concat!("unipbd ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_level(1)
            .compression_threads(0) // more would make the bytes depend on timing
            .chunk_size(Some(CHUNK_SIZE))
            .disable_seeking(true)
            .create(output)?;
        mcap.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: SCENE_ATTACHMENT.to_owned(),
            media_type: "application/toml".to_owned(),
            data: header.scene_text.as_bytes().into(),
        })?;
        mcap.write_metadata(&Metadata { name: METADATA.to_owned(), metadata: header.to_metadata(fields) })?;
        mcap.flush()?;
        Ok(LogWriter { mcap, channels: BTreeMap::new(), gauges: header.gauges.clone(), frames: 0 })
    }

    /// Writes a frame and flushes, so that a crash later loses nothing of it.
    pub(crate) fn write(&mut self, frame: &EncodedFrame) -> McapResult<()> {
        for message in &frame.messages {
            let (channel_id, sequence) = self.channel(message.topic)?;
            let header = MessageHeader { channel_id, sequence, log_time: message.time, publish_time: message.time };
            self.mcap.write_to_known_channel(&header, &frame.bytes[message.range.clone()])?;
        }
        self.mcap.flush()?;
        self.frames += 1;
        Ok(())
    }

    /// The channel of a topic, made on first use, and the number of the next message on it.
    fn channel(&mut self, topic: Topic) -> McapResult<(u16, u32)> {
        if !self.channels.contains_key(&topic) {
            let (name, descriptors) = topic.schema(&self.gauges);
            let schema = self.mcap.add_schema(&name, "protobuf", &descriptors)?;
            let id = self.mcap.add_channel(schema, &topic.name(), "protobuf", &BTreeMap::new())?;
            self.channels.insert(topic, ChannelState { id, messages: 0 });
        }
        let state = self.channels.get_mut(&topic).expect("the channel was just made");
        let sequence = state.messages;
        state.messages += 1;
        Ok((state.id, sequence))
    }

    /// Writes the summary and the index.
    pub(crate) fn finish(mut self) -> McapResult<Totals> {
        self.mcap.finish()?;
        let mut output = self.mcap.into_inner();
        output.flush()?;
        Ok(Totals { frames: self.frames, bytes: output.stream_position()? })
    }
}
