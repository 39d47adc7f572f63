//! Logs that a crash cut off are read up to the cut; damaged and foreign files are errors, never
//! panics or wrong frames.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use crate::support::{diagnostics, events, header, snapshot};
use tempfile::TempDir;
use unipbd_cli::read::{Frame, Log, LogError};
use unipbd_cli::record::{Fields, Recorder};

const FRAMES: u32 = 6;

struct Sample {
    folder: TempDir,
    bytes: Vec<u8>,
    frames: Vec<Frame>,
    /// Size of the file when so many frames were flushed.
    flushed: Vec<usize>,
}

impl Sample {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sample.mcap");
        let mut recorder = Recorder::create(&path, &header(), Fields::ALL).unwrap();
        for frame in 0..FRAMES {
            let snapshot = snapshot(40, frame);
            let diagnostics = diagnostics(&snapshot, frame);
            recorder.record(&snapshot, Some(&diagnostics), Some(1), &events(frame)).unwrap();
        }
        recorder.finish().unwrap();
        let bytes = fs::read(&path).unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        let ends = summary.chunk_indexes.iter().map(|chunk| chunk.chunk_start_offset + chunk.chunk_length);
        let flushed: Vec<usize> = ends.map(|end| end as usize).collect();
        assert_eq!(flushed.len(), FRAMES as usize, "one chunk a frame");
        let frames = Log::open(&path).unwrap().frames().unwrap().map(Result::unwrap).collect();
        Sample { folder, bytes, frames, flushed }
    }

    fn file(&self, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join("changed.mcap");
        fs::write(&path, bytes).unwrap();
        path
    }
}

/// All frames of a log up to its end or its first error, and whether it was cut off.
fn read_all(path: &Path) -> Result<(Vec<Frame>, bool, Option<LogError>), LogError> {
    let mut frames = Log::open(path)?.frames()?;
    let mut read = Vec::new();
    let mut failure = None;
    for frame in &mut frames {
        match frame {
            Ok(frame) => read.push(frame),
            Err(error) => failure = Some(error),
        }
    }
    Ok((read, frames.truncated(), failure))
}

#[test]
fn a_log_cut_anywhere_gives_every_frame_that_was_flushed() {
    let sample = Sample::new();
    for cut in (0..sample.bytes.len()).step_by(31) {
        let path = sample.file(&sample.bytes[..cut]);
        let whole_frames = sample.flushed.iter().filter(|end| **end <= cut).count();
        match read_all(&path) {
            Ok((frames, truncated, failure)) => {
                assert!(failure.is_none(), "cut at {cut}: {failure:?}");
                assert_eq!(frames, sample.frames[..whole_frames], "cut at {cut}");
                assert!(truncated || frames.len() == sample.frames.len(), "cut at {cut}");
                assert!(Log::open(&path).unwrap().totals().is_none(), "cut at {cut}");
            }
            Err(error) => {
                assert_eq!(whole_frames, 0, "cut at {cut}: {error}");
                assert!(!matches!(error, LogError::Io(..)), "cut at {cut}: {error}");
            }
        }
    }
}

#[test]
fn a_wrong_byte_gives_an_error_or_the_right_frames_but_no_panic() {
    let sample = Sample::new();
    let mut bytes = sample.bytes.clone();
    let mut noticed = 0;
    for (place, flip) in (0..bytes.len()).step_by(23).zip([0x01, 0x80, 0xff, 0x40].into_iter().cycle()) {
        bytes[place] ^= flip;
        match read_all(&sample.file(&bytes)) {
            Ok((frames, truncated, failure)) => {
                let known = frames.iter().zip(&sample.frames).all(|(read, written)| read == written);
                assert!(known && frames.len() <= sample.frames.len(), "byte {place}: wrong frames");
                let complete = frames.len() == sample.frames.len();
                assert!(complete || truncated || failure.is_some(), "byte {place}: frames lost without a word");
                noticed += usize::from(failure.is_some());
            }
            Err(error) => {
                assert!(error.to_string().contains("changed.mcap"), "byte {place}: {error}");
                noticed += 1;
            }
        }
        bytes[place] ^= flip;
    }
    assert!(noticed > sample.bytes.len() / 46, "only {noticed} wrong bytes were noticed");
}

#[test]
fn a_wrong_byte_in_the_messages_is_always_noticed() {
    let sample = Sample::new();
    let mut bytes = sample.bytes.clone();
    let middle = (sample.flushed[2] + sample.flushed[3]) / 2;
    bytes[middle] ^= 0x10;
    let (frames, _, failure) = read_all(&sample.file(&bytes)).unwrap();
    assert_eq!(frames, sample.frames[..3]);
    assert!(failure.unwrap().to_string().contains("changed.mcap is damaged"));
}

#[test]
fn foreign_files_are_named_as_such() {
    let sample = Sample::new();
    let mut foreign = mcap::Writer::new(std::io::Cursor::new(Vec::new())).unwrap();
    foreign.finish().unwrap();
    let foreign = foreign.into_inner().into_inner();
    let cases: [(&[u8], &str); 4] = [
        (b"", "is not a unipbd log: it is no MCAP file"),
        (b"name = \"a scene\"\n", "is not a unipbd log: it is no MCAP file"),
        (&[0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a, 0, 0], "is not a unipbd log: it is no MCAP file"),
        (&foreign, "is not a unipbd log: it is an MCAP file without a unipbd scene in it"),
    ];
    for (bytes, words) in cases {
        let error = Log::open(&sample.file(bytes)).unwrap_err();
        assert!(matches!(error, LogError::Foreign(..)) && error.to_string().ends_with(words), "{error}");
    }
    let missing = Log::open("no/such.mcap".as_ref()).unwrap_err();
    assert!(missing.to_string().starts_with("cannot read the log no/such.mcap: No such file"), "{missing}");
}

#[test]
fn a_log_whose_recorder_was_never_finished_is_whole_nevertheless() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &header(), Fields::default()).unwrap();
    recorder.record(&snapshot(40, 0), None, None, &[]).unwrap();
    drop(recorder);
    let (frames, truncated, failure) = read_all(&path).unwrap();
    assert_eq!((frames.len(), truncated, failure.is_none()), (1, false, true));
}

const ENDLESS_LOG: &str = "UNIPBD_TEST_ENDLESS_LOG";

/// Not a test of its own: the process that the next test kills.
#[test]
#[ignore = "runs until it is killed"]
fn endless_run() {
    let Some(path) = env::var_os(ENDLESS_LOG) else { return };
    let mut recorder = Recorder::create(path.as_ref(), &header(), Fields::default()).unwrap();
    for frame in 0.. {
        recorder.record(&snapshot(400, frame), None, None, &events(frame)).unwrap();
    }
}

#[test]
fn a_killed_run_leaves_a_log_that_is_readable_to_the_last_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed.mcap");
    let mut run = Command::new(env::current_exe().unwrap())
        .args(["--ignored", "--exact", "damage::endless_run"])
        .env(ENDLESS_LOG, &path)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::metadata(&path).map_or(0, |file| file.len()) < 200_000 {
        assert!(Instant::now() < deadline, "the run writes nothing");
        thread::sleep(Duration::from_millis(2));
    }
    run.kill().unwrap(); // SIGKILL on Unix
    run.wait().unwrap();
    let (frames, truncated, failure) = read_all(&path).unwrap();
    assert!(truncated && failure.is_none(), "{failure:?}");
    assert!(frames.len() > 10, "{} frames", frames.len());
    for (frame, number) in frames.iter().zip(0..) {
        assert_eq!(frame.snapshot.ids.len(), snapshot(400, number).ids.len());
    }
}
