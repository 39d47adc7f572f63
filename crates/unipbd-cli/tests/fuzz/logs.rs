//! Logs: bytes that are wrong, and records that are wrong behind right checksums.

use std::io::Cursor;
use std::sync::{Arc, Mutex};

use unipbd_cli::read::Log;
use unipbd_cli::record::{Fields, Header, Recorder};
use unipbd_cli::scene_file;
use unipbd_cli::simulation::Simulation;
use unipbd_core::BuildOptions;

use crate::harness::{Dice, fuzz, spoil};
use crate::records::{ATTACHMENT, CHUNK, records, with_records};

const SCENE: &str = r#"
name = "log"
spacing = 0.1
[[liquid]]
name = "water"
[[gas]]
name = "air"
[[block]]
material = "water"
min = [0.0, 0.0]
max = [0.5, 0.5]
[[tank]]
min = [0.0, 0.0]
max = [1.0, 1.0]
[[body]]
size = [0.2, 0.2]
position = [0.7, 0.3]
[[body]]
radius = 0.1
position = [0.7, 0.6]
"#;

/// Room that a recorder writes to and that can be read afterwards.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Cursor<Vec<u8>>>>);

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn recorded() -> Vec<u8> {
    let loaded = scene_file::parse(SCENE, "log.toml", &[]).unwrap();
    let mut simulation = Simulation::new(&loaded.scene, BuildOptions { threads: Some(1), seed: None });
    let header = Header {
        setting: simulation.setting(&loaded.scene, "log.toml".as_ref()),
        scene_text: SCENE.to_owned(),
        fps: 60.0,
        ..Header::default()
    };
    let output = Shared::default();
    let mut recorder = Recorder::to_writer(output.clone(), "log.mcap".as_ref(), &header, Fields::ALL).unwrap();
    for _ in 0..4 {
        let (snapshot, found) = (simulation.snapshot(Fields::ALL), simulation.solver.diagnostics());
        recorder.record(&snapshot, Some(&found), Some(7), &simulation.solver.take_events()).unwrap();
        simulation.next_frame();
    }
    recorder.finish().unwrap();
    output.0.lock().unwrap().get_ref().clone()
}

/// Changes what is in a chunk, and packs it again with the right checksum.
fn respoil_chunk(body: &[u8], dice: &mut Dice) -> Vec<u8> {
    let packed = &body[8 + 8 + 8 + 4 + 4 + 4 + 8..];
    let mut records = zstd::decode_all(packed).unwrap();
    match dice.below(8) {
        // Few bytes that unpack to many.
        0 => records = vec![0; 1 << (10 + dice.below(17))],
        1 => records = [0x0a, 0x00].repeat(dice.below(1 << 20)),
        _ => spoil(&mut records, dice),
    }
    let packed = zstd::encode_all(&records[..], 1).unwrap();
    let size = if dice.one_in(8) { dice.edge() } else { records.len() as u64 };
    let sum = crc32fast::hash(&records).to_le_bytes();
    let head = [&body[..16], &size.to_le_bytes(), &sum, &body[28..36]].concat();
    [&head[..], &(packed.len() as u64).to_le_bytes(), &packed].concat()
}

fn respoil(kind: u8, body: &[u8], dice: &mut Dice) -> Vec<u8> {
    match kind {
        CHUNK if !dice.one_in(4) => respoil_chunk(body, dice),
        ATTACHMENT => {
            let mut bytes = body[..body.len() - 4].to_vec();
            spoil(&mut bytes, dice);
            bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
            bytes
        }
        _ => {
            let mut bytes = body.to_vec();
            spoil(&mut bytes, dice);
            bytes
        }
    }
}

fn changed(log: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = log.to_vec();
    if dice.one_in(3) {
        spoil(&mut bytes, dice);
        return bytes;
    }
    let mut records = records(log);
    let victim = dice.below(records.len());
    let (kind, body) = &mut records[victim];
    *body = respoil(*kind, body, dice);
    with_records(log, records)
}

#[test]
fn a_log_is_read_or_refused() {
    let log = recorded();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fuzzed.mcap");
    let run = |input: &[u8]| {
        std::fs::write(&path, input).unwrap();
        let frames = Log::open(&path).and_then(|log| log.frames());
        match frames {
            Ok(frames) => frames.filter_map(Result::err).for_each(|error| assert!(!error.to_string().is_empty())),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    };
    run(&log);
    assert_eq!(Log::open(&path).unwrap().frames().unwrap().filter(Result::is_ok).count(), 4);
    fuzz("log", 1500, |dice| changed(&log, dice), run);
}
