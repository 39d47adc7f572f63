//! Positions: the file and the overrides as one long text.

use std::ops::Range;
use std::string::FromUtf8Error;

use unipbd_core::scene::KeyPath;

use super::diagnostic::{Diagnostic, Origin, SceneFileError, printable};
use super::place::Lines;

/// The kind of check that found a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FaultKind {
    Syntax,
    /// A key or a value that does not belong where it is.
    Misfit,
    Missing,
    Meaning,
}

/// A problem with its place in the long text; without one it concerns the whole file.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub(super) path: KeyPath,
    pub(super) span: Option<Range<usize>>,
    pub(super) message: String,
    pub(super) hint: Option<String>,
    pub(super) kind: FaultKind,
}

impl Fault {
    pub(super) fn new(path: KeyPath, span: Option<Range<usize>>, message: impl Into<String>) -> Self {
        Fault { path, span, message: message.into(), hint: None, kind: FaultKind::Misfit }
    }

    #[must_use]
    pub(super) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    #[must_use]
    pub(super) fn kind(mut self, kind: FaultKind) -> Self {
        self.kind = kind;
        self
    }

    /// Whether the fault may be but a consequence of a syntax error, given the stretches of text
    /// that may be read wrongly.
    pub(super) fn may_follow_from_syntax(&self, doubtful: &[Range<usize>]) -> bool {
        let touches = |span: &Range<usize>| doubtful.iter().any(|d| span.start <= d.end && span.end >= d.start);
        self.kind != FaultKind::Misfit || self.span.as_ref().is_none_or(touches)
    }
}

/// The file, then each override, one behind the other.
pub(super) struct Sources<'a> {
    file_name: &'a str,
    parts: Vec<(usize, Lines<'a>)>,
}

impl<'a> Sources<'a> {
    /// The text of a file of this name, and those of overrides.
    pub(super) fn new(file_name: &'a str, text: &'a str, overrides: impl Iterator<Item = &'a str>) -> Self {
        let mut start = 0;
        let texts = std::iter::once(text).chain(overrides);
        let place = |part: &'a str| {
            let place = (start, Lines::new(part));
            start += part.len() + 1;
            place
        };
        let parts = texts.map(place).collect();
        Sources { file_name, parts }
    }

    /// The text of the file.
    pub(super) fn text(&self) -> &'a str {
        self.parts[0].1.text()
    }

    pub(super) fn start_of_override(&self, index: usize) -> usize {
        self.parts[index + 1].0
    }

    /// The text at a span, as written.
    pub(super) fn excerpt(&self, span: &Range<usize>) -> &'a str {
        let (part, local) = self.part_at(span.start);
        let (start, lines) = &self.parts[part];
        lines.text().get(local..span.end.saturating_sub(*start).max(local)).unwrap_or("")
    }

    /// Number of the part that holds an offset, and the offset within it.
    fn part_at(&self, offset: usize) -> (usize, usize) {
        let part = self.parts.partition_point(|(start, _)| *start <= offset).saturating_sub(1);
        (part, (offset - self.parts[part].0).min(self.parts[part].1.text().len()))
    }

    /// Sorts faults by position and makes an error of them.
    pub(super) fn error(&self, mut faults: Vec<Fault>) -> SceneFileError {
        faults.sort_by_key(|fault| fault.span.as_ref().map_or(usize::MAX, |span| span.start));
        let mut problems: Vec<Diagnostic> = Vec::new();
        for fault in faults {
            let problem = self.diagnostic(fault);
            if problems.last() != Some(&problem) {
                problems.push(problem);
            }
        }
        SceneFileError::Invalid { file: self.file_name.to_owned(), problems }
    }

    fn diagnostic(&self, fault: Fault) -> Diagnostic {
        let blank = Diagnostic {
            origin: Origin::File(self.file_name.to_owned()),
            line: 1,
            column: 1,
            source_line: String::new(),
            caret: 0..0,
            key: printable(&fault.path.to_string()),
            message: fault.message,
            hint: fault.hint,
        };
        let Some(span) = fault.span else { return blank };
        let (part, offset) = self.part_at(span.start);
        let (start, lines) = &self.parts[part];
        let place = lines.place(offset, span.end.saturating_sub(*start));
        let origin = if part == 0 { blank.origin } else { Origin::Override(lines.text().to_owned()) };
        Diagnostic {
            origin,
            line: place.line,
            column: place.column,
            source_line: place.text,
            caret: place.caret,
            ..blank
        }
    }
}

/// The error for a file that is no UTF-8 text.
pub(super) fn not_text(file_name: &str, error: &FromUtf8Error) -> SceneFileError {
    let valid = error.utf8_error().valid_up_to();
    let lossy = String::from_utf8_lossy(error.as_bytes());
    let byte = error.as_bytes()[valid];
    let sources = Sources::new(file_name, &lossy, std::iter::empty());
    let end = valid + char::REPLACEMENT_CHARACTER.len_utf8();
    let fault = Fault::new(KeyPath::default(), Some(valid..end), format!("not UTF-8 text: byte 0x{byte:02x}"));
    sources.error(vec![fault.hint("save the file as UTF-8")])
}
