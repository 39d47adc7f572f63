//! Chunks: records that were compressed together.

use std::io::Read;

use super::wire::Wire;

/// Smallest bound on what a chunk unpacks to \[bytes]...
const LEAST_BOUND: u64 = 64 << 20;
/// ...its bound in bytes of the file: a frame of our own logs packs to a third...
const EXPANSION: u64 = 256;
/// ...and the largest: ten million particles fit.
const MOST_BOUND: u64 = 1 << 30;
/// Largest window of a packed stream, as a power of two \[bytes].
const WINDOW: u32 = 25;

/// The most that a chunk of a file of this size may unpack to \[bytes].
pub(super) fn unpacked_bound(file: u64) -> u64 {
    file.saturating_mul(EXPANSION).clamp(LEAST_BOUND, MOST_BOUND)
}

/// The records of a chunk, if its lengths and its checksum are right. Errors say what is wrong.
pub(super) fn unpack(body: &[u8], bound: u64) -> Result<Vec<u8>, String> {
    let short = || "a chunk ends too early".to_owned();
    let mut wire = Wire(body);
    let mut header = || Some((wire.u64()?, wire.u64()?, wire.u64()?, wire.u32()?, wire.text()?, wire.u64()?));
    let (_start, _end, size, checksum, compression, packed_size) = header().ok_or_else(short)?;
    let packed = wire.bytes(packed_size).ok_or_else(short)?;
    if size > bound {
        return Err(format!("a chunk claims to unpack to {size} bytes"));
    }
    let records = match compression.as_str() {
        "" => packed.to_vec(),
        "zstd" => unzip(packed, size).map_err(|error| format!("a chunk cannot be unpacked: {error}"))?,
        other => return Err(format!("a chunk is compressed by \"{}\"", other.escape_default())),
    };
    if records.len() as u64 != size {
        return Err(format!("a chunk of {size} bytes unpacks to {} or more", records.len()));
    }
    if checksum != 0 && checksum != crc32fast::hash(&records) {
        return Err("the checksum of a chunk does not match".to_owned());
    }
    Ok(records)
}

/// At most one byte more than the size that was announced.
fn unzip(packed: &[u8], size: u64) -> std::io::Result<Vec<u8>> {
    let mut decoder = zstd::Decoder::with_buffer(packed)?;
    decoder.window_log_max(WINDOW)?;
    let mut records = Vec::new();
    decoder.take(size.saturating_add(1)).read_to_end(&mut records)?;
    Ok(records)
}
