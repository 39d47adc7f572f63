//! A log as its records, taken apart and put together by hand.

/// Length of the first and of the last bytes of a log.
const MAGIC: usize = 8;

/// Kinds of records, by their numbers in the MCAP specification.
pub const CHUNK: u8 = 0x06;
pub const ATTACHMENT: u8 = 0x09;

/// The records behind the first magic: kind and body.
pub fn records(log: &[u8]) -> Vec<(u8, Vec<u8>)> {
    let (mut rest, mut found) = (&log[MAGIC..log.len() - MAGIC], Vec::new());
    while let Some((prefix, body)) = rest.split_first_chunk::<9>() {
        let length = u64::from_le_bytes(prefix[1..].try_into().unwrap()) as usize;
        found.push((prefix[0], body[..length].to_vec()));
        rest = &body[length..];
    }
    found
}

/// The log with these records in place of its own.
pub fn with_records(log: &[u8], records: impl IntoIterator<Item = (u8, Vec<u8>)>) -> Vec<u8> {
    let mut bytes = log[..MAGIC].to_vec();
    for (kind, body) in records {
        bytes.push(kind);
        bytes.extend((body.len() as u64).to_le_bytes());
        bytes.extend(body);
    }
    bytes.extend(&log[log.len() - MAGIC..]);
    bytes
}
