//! Names from files never move a terminal.

use crate::support::{DROP, Place};

/// Every control character but the line breaks of the output itself.
fn is_clean(text: &str) -> bool {
    !text.chars().any(|letter| letter.is_control() && letter != '\n')
}

#[test]
fn control_characters_in_names_of_a_log_are_written_out() {
    let place = Place::new();
    let named = DROP.replace("\"Drop\"", "\"\\u001b]0;gone\\u0007\\nDrop\"").replace("\"water\"", "\"w\\u009b2Jater\"");
    place.write("odd.toml", &named);
    let ran = place.run(&["odd.toml"]).exits(0);
    assert!(is_clean(&ran.stdout()) && is_clean(&ran.stderr()), "{:?}{:?}", ran.stdout(), ran.stderr());
    let text = place.run(&["info", "odd.mcap"]).exits(0).stdout();
    assert!(is_clean(&text), "{text:?}");
    assert!(text.starts_with("\\u{1b}]0;gone\\u{7}\\nDrop\n"), "{text}");
    assert!(text.contains("w\\u{9b}2Jater"), "{text}");
    let bench = place.run(&["bench", "odd.toml", "--frames", "1", "--threads", "1"]).exits(0);
    assert!(is_clean(&bench.stdout()), "{:?}", bench.stdout());
}

#[cfg(unix)]
#[test]
fn control_characters_in_names_of_files_are_written_out() {
    let place = Place::new();
    place.write("a\u{1b}[2Jb.toml", "spacing = -1\n[[liquid]]\nname = \"water\"\n");
    for command in ["check", "run", "info"] {
        let ended = place.run(&[command, "a\u{1b}[2Jb.toml"]).exits(3);
        assert!(is_clean(&ended.stderr()), "{:?}", ended.stderr());
    }
    let absent = place.run(&["run", "c\u{1b}[2Jd.toml"]).exits(1);
    assert!(is_clean(&absent.stderr()), "{:?}", absent.stderr());
}
