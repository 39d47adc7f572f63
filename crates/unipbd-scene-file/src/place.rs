//! From bytes of a text to lines and columns, in time that does not grow with the text.

use std::ops::Range;

/// Bytes between two counts of characters.
const STRIDE: usize = 1024;
/// Longest excerpt of a line \[bytes].
const EXCERPT: usize = 4 * STRIDE;

/// A text with the places of its lines and characters.
pub(super) struct Lines<'a> {
    text: &'a str,
    /// Where each line begins.
    starts: Vec<usize>,
    /// Number of characters that begin before each multiple of [`STRIDE`].
    characters: Vec<usize>,
}

/// A stretch of one line.
pub(super) struct Place {
    /// Its number, from 1.
    pub line: usize,
    /// The column at which it begins, from 1.
    pub column: usize,
    /// The line, or of a long one the part around the stretch.
    pub text: String,
    /// The characters of the text that are marked.
    pub caret: Range<usize>,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1)).collect();
        let begins = |chunk: &[u8]| chunk.iter().filter(|byte| (**byte as i8) >= -0x40).count();
        let counts = text.as_bytes().chunks(STRIDE).map(begins);
        let sums = counts.scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        });
        Lines { text, starts, characters: std::iter::once(0).chain(sums).collect() }
    }

    pub fn text(&self) -> &'a str {
        self.text
    }

    /// Number of characters that begin before a byte.
    fn characters_before(&self, byte: usize) -> usize {
        let stride = byte / STRIDE;
        let rest = &self.text.as_bytes()[stride * STRIDE..byte];
        self.characters[stride] + rest.iter().filter(|byte| (**byte as i8) >= -0x40).count()
    }

    /// The line that holds byte `start`, with the characters from there to byte `end` marked.
    pub fn place(&self, start: usize, end: usize) -> Place {
        let text = self.text;
        let start = floor_of(text, start);
        let line = self.starts.partition_point(|begin| *begin <= start);
        let begin = self.starts[line - 1];
        let stop = self.starts.get(line).map_or(text.len(), |next| next - 1);
        let begin = if text[begin..].starts_with('\u{feff}') { begin + '\u{feff}'.len_utf8() } else { begin };
        let stop = if text[begin..stop.max(begin)].ends_with('\r') { stop - 1 } else { stop.max(begin) };
        let start = start.clamp(begin, stop);
        let end = ceiling_of(text, end.min(stop)).clamp(start, stop);
        let column = self.characters_before(start) - self.characters_before(begin) + 1;
        // The part of a long line that is shown begins and ends near the stretch.
        let first =
            if stop - begin > EXCERPT { floor_of(text, start.saturating_sub(EXCERPT / 2).max(begin)) } else { begin };
        let last = if stop - begin > EXCERPT { ceiling_of(text, (start + EXCERPT / 2).min(stop)) } else { stop };
        let count = |from: usize, to: usize| self.characters_before(to) - self.characters_before(from);
        let caret = count(first, start)..count(first, end.min(last));
        Place { line, column, text: text[first..last].to_owned(), caret }
    }
}

/// The border of a character at or before a byte.
fn floor_of(text: &str, byte: usize) -> usize {
    (0..=byte.min(text.len())).rev().find(|&byte| text.is_char_boundary(byte)).unwrap_or(0)
}

/// The border of a character at or behind a byte.
fn ceiling_of(text: &str, byte: usize) -> usize {
    (byte..text.len()).find(|&byte| text.is_char_boundary(byte)).unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters() {
        let lines = Lines::new("\u{feff}a\r\nö = ü\n");
        let first = lines.place(3, 4);
        assert_eq!((first.line, first.column, first.text.as_str(), first.caret), (1, 1, "a", 0..1));
        let second = lines.place(11, 13);
        assert_eq!((second.line, second.column, second.text.as_str(), second.caret), (2, 5, "ö = ü", 4..5));
        let end = lines.place(99, 120);
        assert_eq!((end.line, end.column, end.text.as_str(), end.caret), (3, 1, "", 0..0));
    }

    #[test]
    fn of_a_long_line_the_part_around_the_stretch_is_kept() {
        let long = "ä".repeat(100_000);
        let lines = Lines::new(&long);
        let place = lines.place(100_000, 100_010);
        assert_eq!((place.line, place.column), (1, 50_001));
        assert!(place.text.len() <= EXCERPT + 4);
        assert_eq!(place.caret.len(), 5);
    }
}
