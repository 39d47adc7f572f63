//! The records of a log that are read.

use std::collections::BTreeMap;

use super::wire::Wire;

/// Kinds of records, by their numbers in the MCAP specification.
pub(super) mod op {
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const MESSAGE: u8 = 0x05;
    pub const CHUNK: u8 = 0x06;
    pub const ATTACHMENT: u8 = 0x09;
    pub const STATISTICS: u8 = 0x0b;
    pub const METADATA: u8 = 0x0c;
    pub const DATA_END: u8 = 0x0f;
}

/// A record.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Record<'a> {
    /// A file within the log.
    Attachment { name: String, data: &'a [u8] },
    /// Words by name.
    Metadata { name: String, entries: BTreeMap<String, String> },
    /// Numbers a topic.
    Channel { id: u16, topic: String },
    /// A message on a topic.
    Message { channel: u16, sequence: u32, time: u64, data: &'a [u8] },
    /// Describes messages.
    Schema,
    /// A record that a reader may pass over.
    Other,
}

impl<'a> Record<'a> {
    /// A record from its body; `None` where the body is too short or its lengths are wrong.
    pub(super) fn parse(opcode: u8, body: &'a [u8]) -> Option<Record<'a>> {
        let mut wire = Wire(body);
        Some(match opcode {
            op::SCHEMA => Record::Schema,
            op::CHANNEL => {
                let (id, _schema) = (wire.u16()?, wire.u16()?);
                let (topic, _encoding) = (wire.text()?, wire.text()?);
                wire.map()?;
                Record::Channel { id, topic }
            }
            op::MESSAGE => {
                let (channel, sequence, time, _published) = (wire.u16()?, wire.u32()?, wire.u64()?, wire.u64()?);
                Record::Message { channel, sequence, time, data: wire.0 }
            }
            op::ATTACHMENT => attachment(body)?,
            op::METADATA => Record::Metadata { name: wire.text()?, entries: wire.map()? },
            _ => Record::Other,
        })
    }
}

/// An attachment whose checksum, at its end, is that of the bytes before it.
fn attachment(body: &[u8]) -> Option<Record<'_>> {
    let (bytes, checksum) = body.split_last_chunk()?;
    if u32::from_le_bytes(*checksum) != crc32fast::hash(bytes) {
        return None;
    }
    let mut wire = Wire(bytes);
    let (_logged, _created) = (wire.u64()?, wire.u64()?);
    let (name, _media) = (wire.text()?, wire.text()?);
    let length = wire.u64()?;
    let data = wire.bytes(length)?;
    wire.0.is_empty().then_some(Record::Attachment { name, data })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    #[test]
    fn a_short_attachment_with_a_right_checksum_is_no_attachment() {
        let whole = sealed([&[0; 16][..], &[1, 0, 0, 0, b'a', 0, 0, 0, 0], &[1, 0, 0, 0, 0, 0, 0, 0], b"x"].concat());
        let found = Record::parse(op::ATTACHMENT, &whole);
        assert_eq!(found, Some(Record::Attachment { name: "a".to_owned(), data: b"x" }));
        for length in 0..whole.len() {
            assert_eq!(Record::parse(op::ATTACHMENT, &whole[..length]), None);
            let resealed = sealed(whole[..length].to_vec());
            assert!(length == whole.len() - 4 || Record::parse(op::ATTACHMENT, &resealed).is_none(), "{length}");
        }
    }

    #[test]
    fn records_that_end_too_early_are_none() {
        for opcode in [op::CHANNEL, op::MESSAGE, op::METADATA] {
            assert_eq!(Record::parse(opcode, &[0xff; 9]), None);
        }
        assert_eq!(Record::parse(0x7f, &[]), Some(Record::Other));
    }
}
