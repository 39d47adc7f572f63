//! Fields of MCAP records. Every length is checked against the bytes that are there before anything is made of it.

use std::collections::BTreeMap;

/// The bytes of a record that are not read yet. Reading beyond them gives `None`.
pub(super) struct Wire<'a>(pub &'a [u8]);

impl<'a> Wire<'a> {
    /// This many bytes.
    pub fn bytes(&mut self, count: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(usize::try_from(count).ok()?)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*taken)
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// A string behind its length.
    pub fn text(&mut self) -> Option<String> {
        let length = self.u32()?;
        String::from_utf8(self.bytes(length.into())?.to_vec()).ok()
    }

    /// Pairs of strings behind the length of all of them.
    pub fn map(&mut self) -> Option<BTreeMap<String, String>> {
        let length = self.u32()?;
        let mut pairs = Wire(self.bytes(length.into())?);
        let mut map = BTreeMap::new();
        while !pairs.0.is_empty() {
            map.insert(pairs.text()?, pairs.text()?);
        }
        Some(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_beyond_the_record_is_no_text_and_no_map() {
        assert_eq!(Wire(b"\x02\0\0\0ab").text(), Some("ab".to_owned()));
        assert_eq!(Wire(b"\xff\xff\xff\xffab").text(), None);
        assert_eq!(Wire(b"\x01\0\0\0\xff").text(), None, "not UTF-8");
        assert_eq!(Wire(b"\x0a\0\0\0\x01\0\0\0a\x01\0\0\0b").map().unwrap()["a"], "b");
        assert_eq!(Wire(b"\x09\0\0\0\x01\0\0\0a\x01\0\0\0b").map(), None);
        assert_eq!(Wire(b"\xff\xff\xff\xff").map(), None);
        assert_eq!(Wire(b"abc").bytes(u64::MAX), None);
    }
}
