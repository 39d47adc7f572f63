//! Messages that would take far more memory than their bytes, refused before they are decoded.

use crate::record::Topic;

/// Most fields of a message, those of lists counted one by one: a body and its shape for each of 200,000 bodies fit.
const MOST_FIELDS: usize = 500_000;
/// Largest message of diagnostics or of an event \[bytes].
const LARGEST: usize = 8 << 20;

/// Whether a message may be decoded. Errors say why not.
pub(super) fn check(topic: Topic, data: &[u8]) -> Result<(), String> {
    let small = matches!(topic, Topic::Diagnostics | Topic::Log);
    if small && data.len() > LARGEST {
        return Err(format!("a message on {} has {} bytes", topic.name(), data.len()));
    }
    // Columns hold as many numbers as they have bytes, in a few fields or in many.
    if topic != Topic::Columns && has_more_fields(data, MOST_FIELDS) {
        return Err(format!("a message on {} has more than {MOST_FIELDS} fields", topic.name()));
    }
    Ok(())
}

/// Whether a protobuf message has more fields than this; what cannot be decoded anyway has not.
fn has_more_fields(mut data: &[u8], most: usize) -> bool {
    let mut fields = 0;
    while fields <= most {
        let Some(rest) = skip_field(data) else { return false };
        (data, fields) = (rest, fields + 1);
    }
    true
}

/// The bytes after the first field; `None` where there is none.
fn skip_field(data: &[u8]) -> Option<&[u8]> {
    let (key, data) = varint(data)?;
    match key & 7 {
        0 => varint(data).map(|(_, rest)| rest),
        1 => data.get(8..),
        2 => {
            let (length, data) = varint(data)?;
            data.get(usize::try_from(length).ok()?..)
        }
        5 => data.get(4..),
        _ => None,
    }
}

fn varint(data: &[u8]) -> Option<(u64, &[u8])> {
    let length = data.iter().take(10).position(|byte| byte & 0x80 == 0)? + 1;
    let (bytes, rest) = data.split_at(length);
    let value = bytes.iter().rev().fold(0, |value: u64, byte| value << 7 | u64::from(byte & 0x7f));
    Some((value, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_empty_bodies_in_a_few_bytes_are_refused() {
        let bodies = [0x0a, 0x00].repeat(MOST_FIELDS + 1);
        assert!(check(Topic::Bodies, &bodies).unwrap_err().contains("more than 500000 fields"));
        assert!(check(Topic::Bodies, &bodies[2..]).is_ok());
        assert!(check(Topic::Diagnostics, &vec![0; LARGEST + 1]).is_err());
    }

    #[test]
    fn fields_of_every_kind_are_counted() {
        let message = [0x08, 0x96, 0x01, 0x11, 1, 2, 3, 4, 5, 6, 7, 8, 0x1a, 2, 0, 0, 0x25, 1, 2, 3, 4];
        assert!(has_more_fields(&message, 3) && !has_more_fields(&message, 4));
        assert!(!has_more_fields(&[0x1a, 0xff, 0xff, 0xff, 0xff, 0x0f], 0), "a length beyond the message");
    }
}
