//! Syntax errors, less those that only follow from an earlier one.

use std::ops::Range;

use toml::de::{DeTable, DeValue, Error};
use unipbd_core::scene::KeyPath;

use super::source::{Fault, FaultKind};

/// One fault a line, and one for a bracket that is never closed and all the text it swallows.
pub(super) fn faults(text: &str, table: &DeTable<'_>, errors: &[Error]) -> Vec<Fault> {
    let mut errors: Vec<(Range<usize>, &Error)> =
        errors.iter().map(|error| (error.span().unwrap_or(0..0), error)).collect();
    errors.sort_by_key(|(span, _)| span.start);
    let mut values = Vec::new();
    collect_values(table, &mut values);
    let mut faults = Vec::new();
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
        faults.push(match unclosed {
            Some(value) => never_closed(text, value),
            None => syntax_fault(text, span.clone(), error),
        });
    }
    faults
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

fn syntax_fault(text: &str, span: Range<usize>, error: &Error) -> Fault {
    if error.message() == "recursion limit" {
        return fault(span, "keys or brackets are nested too deeply".to_owned());
    }
    let (what, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    let made = fault(span.clone(), format!("{what} (TOML syntax)"));
    if what.starts_with("string values must be quoted") {
        let word = text.get(span).unwrap_or("").trim();
        return made.hint(format!("write \"{word}\""));
    }
    if expected.is_empty() || expected == "nothing" { made } else { made.hint(format!("expected {expected}")) }
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
