//! Names: each is there once, and a reference names something that is there.

use std::collections::BTreeMap;

use super::checker::Checker;
use crate::scene::{KeyPath, nearest};

/// Notes names that an earlier thing has. Things without a name are passed over.
pub(super) fn check_unique<'n>(
    checker: &mut Checker,
    things: &str,
    names: impl IntoIterator<Item = (KeyPath, &'n str)>,
) {
    let mut seen = BTreeMap::new();
    for (path, name) in names.into_iter().filter(|(_, name)| !name.is_empty()) {
        if let Some(first) = seen.get(name) {
            let message = format!("the name \"{}\" is taken by {first}", excerpt(name));
            checker.problem(path.then("name"), message, format!("names of {things} must differ"));
        } else {
            seen.insert(name, path);
        }
    }
}

/// Names that a hint compares with: there is nothing to be gained from thousands.
pub(super) const HINTED: usize = 500;

/// The hint for a name that nothing has: the one that is likely meant, or all there are.
pub(super) fn hint_for_unknown(name: &str, names: &[&str], things: &str) -> String {
    match nearest(name, names.iter().copied().take(HINTED)) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => list(&format!("the {things} are"), names),
    }
}

/// The first names, behind a few words.
pub(super) fn list(start: &str, names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(8).map(|name| format!("\"{}\"", excerpt(name))).collect();
    let more = if names.len() > shown.len() { ", ..." } else { "" };
    format!("{start} {}{more}", shown.join(", "))
}

/// The start of a word from the scene, short enough for a message.
pub(super) fn excerpt(word: &str) -> String {
    let clean = |letter: char| if letter.is_control() { ' ' } else { letter };
    let start: String = word.chars().take(40).map(clean).collect();
    if start.chars().count() < word.chars().count() { start + "..." } else { start }
}
