//! Logs are written the same every time, read back as they were, and fail with clear words.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::support::{bodiless_snapshot, diagnostics, events, header, open_header, snapshot};
use unipbd_cli::read::{Frame, Log};
use unipbd_cli::record::{Fields, Header, Recorder, Summary};
use unipbd_cli::snapshot::Snapshot;

const FRAMES: u32 = 12;
const PARTICLES: u32 = 300;

fn record_with(path: &Path, header: &Header, fields: Fields, make: fn(u32, u32) -> Snapshot) -> Summary {
    let mut recorder = Recorder::create(path, header, fields).unwrap();
    for frame in 0..FRAMES {
        let snapshot = make(PARTICLES, frame);
        let diagnostics = diagnostics(&snapshot, frame);
        recorder.record(&snapshot, Some(&diagnostics), Some(0xfeed + u64::from(frame)), &events(frame)).unwrap();
    }
    recorder.finish().unwrap()
}

fn record(path: &Path, fields: Fields) -> Summary {
    record_with(path, &header(), fields, snapshot)
}

/// Messages per topic, by a reader that knows nothing of ours.
fn topics(path: &Path) -> BTreeMap<String, usize> {
    let bytes = fs::read(path).unwrap();
    let mut counts = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        *counts.entry(message.unwrap().channel.topic.clone()).or_insert(0) += 1;
    }
    counts
}

/// A frame as the log gives it back: rows in the order of their ids, only the asked fields.
fn as_recorded(snapshot: &Snapshot, fields: Fields) -> Snapshot {
    let mut rows: Vec<usize> = (0..snapshot.ids.len()).collect();
    rows.sort_by_key(|row| snapshot.ids[*row]);
    fn pick<T: Copy>(values: &[T], rows: &[usize]) -> Vec<T> {
        rows.iter().map(|row| values[*row]).collect()
    }
    Snapshot {
        time: (snapshot.time * 1e9).round() / 1e9,
        positions: pick(&snapshot.positions, &rows),
        ids: pick(&snapshot.ids, &rows),
        phases: pick(&snapshot.phases, &rows),
        materials: pick(&snapshot.materials, &rows),
        velocities: snapshot.velocities.as_ref().filter(|_| fields.velocity).map(|values| pick(values, &rows)),
        density_errors: snapshot.density_errors.as_ref().filter(|_| fields.density).map(|values| pick(values, &rows)),
        temperatures: snapshot.temperatures.as_ref().filter(|_| fields.temperature).map(|values| pick(values, &rows)),
        bodies: snapshot.bodies.clone(),
    }
}

#[test]
fn the_same_run_gives_the_same_bytes_under_any_file_name() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first.mcap"), folder.path().join("another name.mcap"));
    let summary = record(&first, Fields::ALL);
    record(&second, Fields::ALL);
    let bytes = fs::read(&first).unwrap();
    assert_eq!(bytes, fs::read(&second).unwrap());
    assert_eq!(summary, Summary { frames: u64::from(FRAMES), bytes: bytes.len() as u64 });
}

#[test]
fn the_order_of_rows_leaves_no_trace_in_the_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (shuffled, sorted) = (folder.path().join("shuffled.mcap"), folder.path().join("sorted.mcap"));
    record_with(&shuffled, &header(), Fields::ALL, snapshot);
    record_with(&sorted, &header(), Fields::ALL, |count, frame| Snapshot {
        time: snapshot(count, frame).time,
        ..as_recorded(&snapshot(count, frame), Fields::ALL)
    });
    assert_eq!(fs::read(shuffled).unwrap(), fs::read(sorted).unwrap());
}

#[test]
fn what_was_recorded_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    for fields in [Fields::default(), Fields { velocity: true, ..Fields::default() }, Fields::ALL] {
        record(&path, fields);
        let log = Log::open(&path).unwrap();
        assert_eq!(log.header(), &header());
        assert_eq!(log.fields(), fields);
        assert_eq!(log.version(), env!("CARGO_PKG_VERSION"));
        let totals = log.totals().unwrap();
        assert_eq!((totals.frames, totals.start), (u64::from(FRAMES), 0.0));
        let mut frames = log.frames().unwrap();
        for number in 0..FRAMES {
            let Frame { snapshot: read, diagnostics: numbers, state_hash, events: happened } =
                frames.next().unwrap().unwrap();
            assert_eq!(read, as_recorded(&snapshot(PARTICLES, number), fields), "frame {number}");
            assert_eq!(numbers, Some(diagnostics(&snapshot(PARTICLES, number), number)), "frame {number}");
            assert_eq!(state_hash, Some(0xfeed + u64::from(number)));
            assert_eq!(happened.len(), events(number).len());
            for (read, written) in happened.iter().zip(events(number)) {
                assert_eq!((read.severity, &read.message), (written.severity, &written.message));
                assert!((read.time - written.time).abs() < 1e-9);
            }
        }
        assert!(frames.next().is_none() && !frames.truncated());
    }
}

#[test]
fn topics_hold_as_many_messages_as_the_format_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    record(&path, Fields::default());
    let every = FRAMES as usize;
    let expected = [
        ("/bodies", every),
        ("/boundary", 1),
        ("/diagnostics", every),
        ("/gauges", every),
        ("/log", 4),
        ("/particles", every),
        ("/particles/columns", 3),
        ("/scene", 1),
        ("/tf", every),
    ];
    assert_eq!(topics(&path), expected.map(|(topic, count)| (topic.to_owned(), count)).into());
    record(&path, Fields { density: true, ..Fields::default() });
    assert_eq!(topics(&path)["/particles/columns"], every);
    record(&path, Fields { samples: true, ..Fields::default() });
    assert_eq!((topics(&path)["/bodies/samples"], topics(&path)["/particles/columns"]), (every, 3));
}

#[test]
fn topics_a_run_does_not_use_are_absent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &open_header(), Fields::default()).unwrap();
    for frame in 0..FRAMES {
        recorder.record(&bodiless_snapshot(PARTICLES, frame), None, None, &[]).unwrap();
    }
    recorder.finish().unwrap();
    assert_eq!(topics(&path).into_keys().collect::<Vec<_>>(), ["/particles", "/particles/columns"]);
    let log = Log::open(&path).unwrap();
    assert!(log.frames().unwrap().all(|frame| frame.unwrap().diagnostics.is_none()));
}

#[test]
fn a_run_that_starts_and_ends_without_particles_is_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let counts = [0, 0, 5, 5, 0, 0, 3];
    let mut recorder = Recorder::create(&path, &open_header(), Fields::ALL).unwrap();
    for (frame, count) in (0..).zip(counts) {
        let snapshot = Snapshot { time: f64::from(frame), ..bodiless_snapshot(count, 0) };
        recorder.record(&snapshot, None, None, &[]).unwrap();
    }
    recorder.finish().unwrap();
    let read = Log::open(&path).unwrap().frames().unwrap();
    let read: Vec<usize> = read.map(|frame| frame.unwrap().snapshot.positions.len()).collect();
    assert_eq!(read, counts.map(|count| count as usize));
}

#[test]
fn bodies_may_come_and_go() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let counts = [0, 1, 2, 2, 1, 0, 2];
    let mut recorder = Recorder::create(&path, &open_header(), Fields::default()).unwrap();
    for (frame, count) in (0..).zip(counts) {
        let mut snapshot = snapshot(9, frame);
        snapshot.bodies.truncate(count);
        recorder.record(&snapshot, None, None, &[]).unwrap();
    }
    recorder.finish().unwrap();
    let read = Log::open(&path).unwrap().frames().unwrap();
    for ((number, frame), count) in (0..).zip(read).zip(counts) {
        assert_eq!(frame.unwrap().snapshot.bodies, snapshot(9, number).bodies[..count], "frame {number}");
    }
    assert_eq!(topics(&path)["/scene"], 5);
}

#[test]
fn log_time_never_runs_backwards() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    record(&path, Fields::ALL);
    let bytes = fs::read(&path).unwrap();
    let times: Vec<u64> = mcap::MessageStream::new(&bytes).unwrap().map(|message| message.unwrap().log_time).collect();
    assert!(times.is_sorted());
    assert_eq!((times[0], *times.last().unwrap()), (0, 183_333_333));
}

#[test]
fn scene_and_metadata_stand_before_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    record(&path, Fields::default());
    let bytes = fs::read(&path).unwrap();
    let kinds = mcap::read::LinearReader::new(&bytes).unwrap().map(|record| record.unwrap().opcode());
    assert_eq!(kinds.take(4).collect::<Vec<_>>(), [0x01, 0x09, 0x0c, 0x06]);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!((summary.attachment_indexes.len(), summary.metadata_indexes.len()), (1, 1));
    assert!(summary.chunk_indexes.len() >= FRAMES as usize && summary.stats.is_some());
}

#[test]
fn columns_of_different_length_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut recorder = Recorder::create(&folder.path().join("run.mcap"), &header(), Fields::default()).unwrap();
    let mut faulty = snapshot(10, 0);
    faulty.ids.pop();
    let error = recorder.record(&faulty, None, None, &[]).unwrap_err();
    assert!(error.to_string().contains("differ in length"), "{error}");
}

/// A disk with little space left.
struct SmallDisk {
    left: usize,
}

impl Write for SmallDisk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.left == 0 {
            return Err(io::Error::from_raw_os_error(28)); // ENOSPC
        }
        let written = bytes.len().min(self.left);
        self.left -= written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn record_to_small_disk(space: usize) -> String {
    let start = Recorder::to_writer(SmallDisk { left: space }, "run.mcap".as_ref(), &header(), Fields::ALL);
    let mut recorder = match start {
        Ok(recorder) => recorder,
        Err(error) => return error.to_string(),
    };
    for frame in 0..FRAMES {
        if let Err(error) = recorder.record(&snapshot(PARTICLES, frame), None, None, &events(frame)) {
            return error.to_string();
        }
    }
    recorder.finish().unwrap_err().to_string()
}

#[test]
fn a_full_disk_is_an_error_that_names_the_file_and_the_cause() {
    for space in [0, 10, 1_000, 10_000, 30_000] {
        let message = record_to_small_disk(space);
        assert!(message.starts_with("cannot write the log run.mcap: No space left on device"), "{space}: {message}");
    }
}

#[test]
fn a_missing_folder_is_an_error_that_names_the_file() {
    let error = Recorder::create("no/such/folder/run.mcap".as_ref(), &header(), Fields::ALL).err().unwrap();
    assert!(error.to_string().contains("no/such/folder/run.mcap: No such file"), "{error}");
}

#[test]
fn two_runs_do_not_write_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let first = Recorder::create(&path, &header(), Fields::default()).unwrap();
    let refused = Recorder::create(&path, &header(), Fields::default()).err().unwrap();
    assert!(refused.to_string().ends_with("run.mcap: another run is writing it"), "{refused}");
    first.finish().unwrap();
    record(&path, Fields::default());
    assert!(Log::open(&path).is_ok());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_that_names_it() {
    let error = Recorder::create("/dev/full".as_ref(), &header(), Fields::default()).err().unwrap();
    assert!(error.to_string().starts_with("cannot write the log /dev/full: No space left on device"), "{error}");
}
