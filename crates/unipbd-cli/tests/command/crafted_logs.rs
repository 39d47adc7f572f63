//! Logs that were made by hand: a clear error, and no more memory than the file's size times a constant.

use crate::records::{ATTACHMENT, CHUNK, records, with_records};
use crate::support::Place;

const CHANNEL: u8 = 0x04;
const METADATA: u8 = 0x0c;
const DATA_END: u8 = 0x0f;

/// A log of `drop.toml` in which the first record of a kind is changed.
fn crafted(kind: u8, change: impl FnOnce(&mut Vec<u8>)) -> Place {
    let place = Place::new();
    place.run(&["drop.toml", "-q"]).exits(0);
    let log = std::fs::read(place.path("drop.mcap")).unwrap();
    let mut records = records(&log);
    change(&mut records.iter_mut().find(|(found, _)| *found == kind).unwrap().1);
    for (_, body) in records.iter_mut().filter(|(kind, _)| *kind == DATA_END) {
        body.fill(0); // no checksum of what was changed
    }
    let bytes = with_records(&log, records);
    std::fs::write(place.path("crafted.mcap"), bytes).unwrap();
    place
}

/// What `info` says of it, within 1.5 GB of address space where that can be limited.
fn refusal(place: &Place) -> String {
    let command = format!("ulimit -v 1500000; exec {} info crafted.mcap", env!("CARGO_BIN_EXE_unipbd"));
    let output = match cfg!(unix) {
        true => std::process::Command::new("sh").args(["-c", &command]).current_dir(place.path(".")).output().unwrap(),
        false => place.run(&["info", "crafted.mcap"]).0,
    };
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("crafted.mcap") && !message.contains("panicked"), "{message}");
    message
}

/// A chunk with this content and a right checksum.
fn packed(content: &[u8]) -> Vec<u8> {
    let packed = zstd::encode_all(content, 1).unwrap();
    let mut chunk = [0; 16].to_vec();
    chunk.extend((content.len() as u64).to_le_bytes());
    chunk.extend(crc32fast::hash(content).to_le_bytes());
    chunk.extend(b"\x04\0\0\0zstd");
    chunk.extend((packed.len() as u64).to_le_bytes());
    chunk.extend(packed);
    chunk
}

#[test]
fn a_short_attachment_with_a_right_checksum_is_damage() {
    for length in [0, 1, 20, 40] {
        let place = crafted(ATTACHMENT, |body| {
            body.truncate(length);
            body.extend(crc32fast::hash(body).to_le_bytes());
        });
        assert!(refusal(&place).contains("damaged"));
    }
}

#[test]
fn few_bytes_that_unpack_to_many_are_refused() {
    let zeros = vec![0; 1 << 30];
    let place = crafted(CHUNK, |body| *body = packed(&zeros));
    assert!(place.path("crafted.mcap").metadata().unwrap().len() < 200_000);
    assert!(refusal(&place).contains("unpack"), "{}", refusal(&place));
    // The size that is announced may be wrong too.
    let place = crafted(CHUNK, |body| {
        *body = packed(&zeros);
        body[16..24].copy_from_slice(&1000_u64.to_le_bytes());
    });
    assert!(refusal(&place).contains("unpacks to"));
}

#[test]
fn lengths_beyond_the_record_reserve_nothing() {
    for (kind, place_of_length) in [(ATTACHMENT, 16), (METADATA, 0)] {
        let place = crafted(kind, |body| {
            body[place_of_length..place_of_length + 4].copy_from_slice(&u32::MAX.to_le_bytes());
            if kind == ATTACHMENT {
                body.truncate(body.len() - 4);
                body.extend(crc32fast::hash(body).to_le_bytes());
            }
        });
        assert!(refusal(&place).contains("damaged"));
    }
    let place = crafted(CHUNK, |body| {
        let mut records = zstd::decode_all(&body[44..]).unwrap();
        // A channel whose topic claims four gigabytes.
        let record =
            [&[CHANNEL][..], &12_u64.to_le_bytes(), &[1, 0, 1, 0, 0xff, 0xff, 0xff, 0xff, b'a', b'b', b'c', b'd']]
                .concat();
        records.splice(0..0, record);
        *body = packed(&records);
    });
    assert!(refusal(&place).contains("damaged"));
}

/// Sets an entry of the metadata.
fn with_entry(body: &mut Vec<u8>, key: &str, value: &str) {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let name_end = 4 + u32::from_le_bytes(body[..4].try_into().unwrap()) as usize;
    let mut map = body[name_end + 4..].to_vec();
    let old = text(key);
    if let Some(start) = map.windows(old.len()).position(|part| part == old) {
        let value_start = start + old.len();
        let length = u32::from_le_bytes(map[value_start..value_start + 4].try_into().unwrap()) as usize;
        map.drain(start..value_start + 4 + length);
    }
    if !value.is_empty() {
        map.extend([text(key), text(value)].concat());
    }
    body.truncate(name_end);
    body.extend((map.len() as u32).to_le_bytes());
    body.extend(map);
}

#[test]
fn a_log_of_a_newer_format_is_refused_by_its_version() {
    let place = crafted(METADATA, |body| {
        with_entry(body, "log_format", "7");
        with_entry(body, "version", "9.9.9");
    });
    let message = refusal(&place);
    assert!(message.contains("has format 7, written by unipbd 9.9.9; this unipbd reads formats up to"), "{message}");
}

#[test]
fn a_log_without_a_format_is_of_the_first_and_is_read() {
    let place = crafted(METADATA, |body| with_entry(body, "log_format", ""));
    let text = place.run(&["info", "crafted.mcap"]).exits(0).stdout();
    assert!(text.contains("11 frames"), "{text}");
}

#[test]
fn what_a_reader_does_not_know_it_passes_over() {
    let place = crafted(METADATA, |body| with_entry(body, "an entry of a later version", "1"));
    place.run(&["info", "crafted.mcap"]).exits(0);
}
