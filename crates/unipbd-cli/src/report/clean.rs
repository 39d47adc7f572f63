//! Text from files and logs, made safe for a terminal.

use std::borrow::Cow;

/// The text with control characters written out; lines and tabs are kept.
pub fn clean(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| letter.is_control() && !matches!(letter, '\n' | '\t'))
}

/// The same for a name, which has one line.
pub fn one_line(name: &str) -> Cow<'_, str> {
    escaped(name, char::is_control)
}

fn escaped(text: &str, is_unsafe: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_unsafe) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if is_unsafe(letter) { out.extend(letter.escape_default()) } else { out.push(letter) }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_a_terminal_is_written_out() {
        assert_eq!(clean("a\u{1b}[2J\tb\nc\u{9b}\u{7f}"), "a\\u{1b}[2J\tb\nc\\u{9b}\\u{7f}");
        assert_eq!(one_line("a\nb\r"), "a\\nb\\r");
        assert!(matches!(clean("grün"), Cow::Borrowed("grün")));
    }
}
