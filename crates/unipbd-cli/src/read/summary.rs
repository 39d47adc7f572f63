use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use mcap::sans_io::summary_reader::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};

use crate::record::Topic;

/// What the summary of a complete log says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Frames in the log.
    pub frames: u64,
    /// Simulated time of the first message [s].
    pub start: f64,
    /// Simulated time of the last message [s].
    pub end: f64,
}

/// Reads the summary at the end of a log; `None` where there is no sound one.
pub(crate) fn read_totals(path: &Path) -> Option<Totals> {
    let mut file = File::open(path).ok()?;
    let size = file.metadata().ok()?.len();
    let limit = usize::try_from(size).ok()?;
    let options = SummaryReaderOptions::default().with_file_size(size).with_record_length_limit(limit);
    let mut reader = SummaryReader::new_with_options(options);
    while let Some(event) = reader.next_event() {
        match event.ok()? {
            SummaryReadEvent::ReadRequest(need) => {
                let read = file.read(reader.insert(need.min(limit))).ok()?;
                reader.notify_read(read);
            }
            SummaryReadEvent::SeekRequest(to) => {
                let position = file.seek(to).ok()?;
                reader.notify_seeked(position);
            }
        }
    }
    let summary = reader.finish()?;
    let statistics = summary.stats?;
    let particles = Topic::Particles.name();
    let channel = summary.channels.values().find(|channel| channel.topic == particles);
    let frames = channel.and_then(|channel| statistics.channel_message_counts.get(&channel.id)).copied();
    Some(Totals {
        frames: frames.unwrap_or(0),
        start: statistics.message_start_time as f64 / 1e9,
        end: statistics.message_end_time as f64 / 1e9,
    })
}
