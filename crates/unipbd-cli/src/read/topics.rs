use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

use super::LogError;
use super::record::Record;
use super::records::Records;

/// Messages of a topic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Traffic {
    pub(crate) messages: u64,
    /// Before compression \[bytes].
    pub(crate) bytes: u64,
}

/// The topics of a log by name, with what is on them.
pub(crate) fn topics(path: &Path) -> Result<BTreeMap<String, Traffic>, LogError> {
    let file = File::open(path).map_err(|cause| LogError::Io(path.to_owned(), cause))?;
    let mut records = Records::new(file, path)?;
    let mut names = BTreeMap::new();
    let mut topics: BTreeMap<String, Traffic> = BTreeMap::new();
    while let Some(record) = records.next()? {
        match record {
            Record::Channel { id, topic } => {
                topics.entry(topic.clone()).or_default();
                names.insert(id, topic);
            }
            Record::Message { channel, data, .. } => {
                if let Some(traffic) = names.get(&channel).and_then(|name| topics.get_mut(name)) {
                    traffic.messages += 1;
                    traffic.bytes += data.len() as u64;
                }
            }
            _ => {}
        }
    }
    Ok(topics)
}
