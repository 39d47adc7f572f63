//! Syntax errors, less those that only follow from an earlier one.

use std::ops::Range;

use toml::de::{DeTable, DeValue, Error};
use unipbd_core::scene::KeyPath;

use super::source::{Fault, FaultKind};

/// One fault a line, and one for a bracket that is never closed and all the text it swallows; and
/// the stretches of text that may have been read wrongly.
pub(super) fn faults(text: &str, table: &DeTable<'_>, errors: &[Error]) -> (Vec<Fault>, Vec<Range<usize>>) {
    let mut errors: Vec<(Range<usize>, &Error)> =
        errors.iter().map(|error| (error.span().unwrap_or(0..0), error)).collect();
    errors.sort_by_key(|(span, _)| span.start);
    let mut values = Vec::new();
    collect_values(table, &mut values);
    let (mut faults, mut doubtful) = (Vec::new(), Vec::new());
    let mut quiet_until = 0;
    for (span, error) in &errors {
        if !faults.is_empty() && span.start < quiet_until {
            continue;
        }
        let value = values.iter().find(|value| value.start <= span.start && span.start <= value.end);
        let unclosed = value.filter(|value| {
            let inside = |span: &Range<usize>| span.start >= value.start && span.start <= value.end;
            errors.iter().any(|(span, error)| inside(span) && is_unclosed(error))
        });
        let line_end = text[span.start.min(text.len())..].find('\n').map_or(text.len(), |end| span.start + end);
        quiet_until = value.map_or(0, |value| value.end + 1).max(line_end + 1);
        let line_start = text[..span.start.min(text.len())].rfind('\n').map_or(0, |end| end + 1);
        doubtful.push(value.map_or(line_start, |value| value.start.min(line_start))..quiet_until.saturating_sub(1));
        faults.push(match unclosed {
            Some(value) => never_closed(text, value),
            None => syntax_fault(text, span.clone(), error),
        });
    }
    (faults, doubtful)
}

fn is_unclosed(error: &Error) -> bool {
    error.message().starts_with("unclosed array,") || error.message().starts_with("unclosed inline table")
}

fn never_closed(text: &str, value: &Range<usize>) -> Fault {
    let bracket = if text[value.start..].starts_with('{') { "{" } else { "[" };
    let closing = if bracket == "{" { "}" } else { "]" };
    fault(value.start..value.start + 1, format!("this `{bracket}` is never closed"))
        .hint(format!("add the missing `{closing}`"))
}

/// The parser's message, in plainer words where it is hard to read.
fn syntax_fault(text: &str, span: Range<usize>, error: &Error) -> Fault {
    let (what, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    let word = text.get(span.clone()).unwrap_or("").trim();
    let plain = |message: &str| fault(span.clone(), message.to_owned());
    match what {
        "recursion limit" => plain("keys or brackets are nested too deeply"),
        "cannot recurse further; max recursion depth met" => plain("brackets are nested too deeply"),
        "string values must be quoted" if word.is_empty() => plain("the value is missing"),
        "string values must be quoted"
            if word.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter)) =>
        {
            plain("this is not a number").hint(format!("write a number alone, or the string \"{word}\""))
        }
        "string values must be quoted" => plain("a string must be in quotes").hint(format!("write \"{word}\"")),
        "invalid basic string" if expected == "`\"`" => plain("the string is never closed").hint("add the missing \""),
        "missing escaped value" => plain("a backslash in a string begins an escape such as \\n")
            .hint("write \\\\ for a backslash, or put the string in single quotes"),
        "duplicate key" => plain("this key or table is already there").hint("keep one of the two"),
        "unexpected key or value" => plain("unexpected text behind the value")
            .hint("a number has a decimal point; a further key needs a line of its own"),
        _ if expected.is_empty() || expected == "nothing" => fault(span, format!("{what} (TOML syntax)")),
        _ => fault(span, format!("{what} (TOML syntax)")).hint(format!("expected {expected}")),
    }
}

fn fault(span: Range<usize>, message: String) -> Fault {
    Fault::new(KeyPath::default(), Some(span), message).kind(FaultKind::Syntax)
}

/// Spans of all arrays and inline tables that stand directly under a key.
fn collect_values(table: &DeTable<'_>, found: &mut Vec<Range<usize>>) {
    for (key, value) in table.iter() {
        match value.get_ref() {
            // The span of `[header]` holds its key; that of an inline table comes after it.
            DeValue::Table(inner) if value.span().start <= key.span().start => collect_values(inner, found),
            DeValue::Array(elements) if value.span().start <= key.span().start => {
                let tables = elements.iter().filter_map(|element| element.get_ref().as_table());
                tables.for_each(|inner| collect_values(inner, found));
            }
            DeValue::Array(_) | DeValue::Table(_) => found.push(value.span()),
            _ => {}
        }
    }
}
