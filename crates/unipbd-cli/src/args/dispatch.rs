//! `unipbd SCENE` means `unipbd run SCENE`.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use unipbd_core::scene::nearest;

use crate::exit::Failure;

const COMMANDS: [&str; 14] = [
    "run",
    "check",
    "expect",
    "info",
    "render",
    "plot",
    "export",
    "recover",
    "layout",
    "bench",
    "schema",
    "completions",
    "man",
    "help",
];

/// Commands that only the Python package has.
const COMMANDS_OF_PYTHON: [&str; 2] = ["dataset", "sweep"];

/// Puts `run` in front of a scene that stands where a command is expected.
///
/// A log in that place, or a misspelt command, is refused with a suggestion.
pub fn with_default_command(arguments: impl IntoIterator<Item = OsString>) -> Result<Vec<OsString>, Failure> {
    let mut arguments: Vec<OsString> = arguments.into_iter().collect();
    let Some(first) = arguments.iter().skip(1).find(|argument| !is_output_flag(argument)) else {
        return Ok(arguments);
    };
    if first.to_str().is_some_and(|word| COMMANDS.contains(&word) || is_help_or_version(word)) {
        return Ok(arguments);
    }
    if let Some(command) = COMMANDS_OF_PYTHON.iter().find(|command| first == **command) {
        return Err(Failure::usage(format!(
            "\"unipbd {command}\" comes with the Python package: pip install \"unipbd[data]\""
        )));
    }
    if is_log(Path::new(first)) {
        return Err(Failure::usage(log_is_no_scene(Path::new(first))));
    }
    if let Some(command) = misspelt_command(first) {
        let word = first.to_string_lossy();
        return Err(Failure::usage(format!("there is no command \"{word}\"; did you mean \"unipbd {command}\"?")));
    }
    arguments.insert(1, "run".into());
    Ok(arguments)
}

/// Whether the path names a log rather than a scene.
pub fn is_log(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mcap"))
}

/// The message about a log that is given where a scene is expected.
pub fn log_is_no_scene(path: &Path) -> String {
    let path = path.display();
    format!("{path} is a log, not a scene; try \"unipbd info {path}\" or \"unipbd render {path} -o pictures\"")
}

fn is_output_flag(argument: &OsStr) -> bool {
    argument.to_str().is_some_and(|word| matches!(word, "-q" | "--quiet" | "-v" | "--verbose" | "--json"))
}

fn is_help_or_version(word: &str) -> bool {
    matches!(word, "-h" | "--help" | "-V" | "--version")
}

/// The command that a bare word, which is no file either, most likely stands for.
fn misspelt_command(word: &OsStr) -> Option<&'static str> {
    let text = word.to_str()?;
    if text.contains(['.', '/', '\\', '-']) || Path::new(word).exists() {
        return None;
    }
    nearest(text, COMMANDS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn completed(words: &[&str]) -> Result<Vec<String>, Failure> {
        let arguments = with_default_command(words.iter().map(OsString::from))?;
        Ok(arguments.into_iter().map(|argument| argument.into_string().unwrap()).collect())
    }

    #[test]
    fn a_scene_alone_is_run() {
        assert_eq!(completed(&["unipbd", "a.toml"]).unwrap(), ["unipbd", "run", "a.toml"]);
        assert_eq!(
            completed(&["unipbd", "--json", "a.toml", "-q"]).unwrap(),
            ["unipbd", "run", "--json", "a.toml", "-q"]
        );
        assert_eq!(
            completed(&["unipbd", "--threads", "2", "a.toml"]).unwrap(),
            ["unipbd", "run", "--threads", "2", "a.toml"]
        );
    }

    #[test]
    fn commands_help_and_version_are_left_alone() {
        for words in [&["unipbd", "check", "a.toml"][..], &["unipbd", "--help"], &["unipbd", "-V"], &["unipbd"]] {
            assert_eq!(completed(words).unwrap(), words);
        }
        assert_eq!(completed(&["unipbd", "-v", "info", "a.mcap"]).unwrap(), ["unipbd", "-v", "info", "a.mcap"]);
    }

    #[test]
    fn commands_of_the_python_package_are_named() {
        for word in ["dataset", "sweep"] {
            let message = completed(&["unipbd", word, "a.toml"]).unwrap_err().message;
            assert!(message.contains("pip install") && message.contains(word), "{message}");
        }
    }

    #[test]
    fn a_log_and_a_misspelt_command_are_refused_with_a_suggestion() {
        assert!(completed(&["unipbd", "a.mcap"]).unwrap_err().message.contains("unipbd info a.mcap"));
        assert!(completed(&["unipbd", "chekc", "a.toml"]).unwrap_err().message.contains("unipbd check"));
    }
}
