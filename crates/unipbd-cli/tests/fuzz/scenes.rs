//! Scene files and overrides.

use std::path::Path;

use unipbd_cli::scene_file::{self, Override};
use unipbd_core::BuildOptions;

use crate::harness::{Dice, fuzz, spoil};

/// Scenes with at most this many particles and bodies are built and stepped, now and then.
const SMALL: u64 = 1500;

/// Values that scenes stumble over.
const VALUES: [&str; 24] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-300",
    "1e-9",
    "0.5",
    "3",
    "1e3",
    "1e9",
    "1e30",
    "1e308",
    "9223372036854775807",
    "nan",
    "inf",
    "-inf",
    "true",
    "\"auto\"",
    "\"water\"",
    "[]",
    "[0.0, 0.0]",
    "[1e9, -1e9]",
    "{}",
    "1979-05-27",
];

fn corpus() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [root.join("../../scenes"), root.join("../../scenes/seed"), root.join("tests/scene_errors")];
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()).collect()
}

/// Lines that change places, come twice or from another scene, and values of another kind.
fn rewrite(corpus: &[String], dice: &mut Dice) -> Vec<u8> {
    let mut lines: Vec<String> = dice.pick(corpus).lines().map(str::to_owned).collect();
    for _ in 0..1 + dice.below(6) {
        let place = dice.below(lines.len());
        match dice.below(6) {
            0 => lines.insert(place, dice.pick(corpus).lines().nth(dice.below(30)).unwrap_or_default().to_owned()),
            1 => drop((!lines.is_empty()).then(|| lines.remove(place))),
            2 => {
                let end = (place + 1 + dice.below(12)).min(lines.len());
                let part = lines[place.min(end)..end].to_vec();
                lines.extend(part);
            }
            _ => {
                if let Some((key, _)) = lines.get(place).and_then(|line| line.split_once('=')) {
                    let value = dice.pick(&VALUES);
                    lines[place] = format!("{key}= {value}");
                }
            }
        }
    }
    let mut bytes = lines.join("\n").into_bytes();
    if dice.one_in(3) {
        spoil(&mut bytes, dice);
    }
    bytes
}

fn read(text: &str, overrides: &[Override]) {
    match scene_file::parse(text, "fuzzed.toml", overrides) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(loaded) => {
            let cost = loaded.scene.estimate();
            let small = cost.particles_at_peak + 20 * loaded.scene.body.len() as u64 + cost.substeps as u64 <= SMALL;
            let copied = loaded.scene.body.iter().any(|body| body.copies.is_some());
            if small && !copied && text.len().is_multiple_of(8) {
                let mut solver = loaded.scene.build(BuildOptions { threads: Some(1), seed: None });
                let _ = solver.step_frame();
            }
        }
    }
}

#[test]
fn a_scene_file_is_read_or_refused() {
    let corpus = corpus();
    let run = |input: &[u8]| read(&String::from_utf8_lossy(input), &[]);
    fuzz("scene", 1500, |dice| rewrite(&corpus, dice), run);
}

/// Keys of scenes and what looks like them.
const WORDS: [&str; 22] = [
    "spacing",
    "solver",
    "substeps",
    "liquid",
    "0",
    "1",
    "-1",
    "99999999999999999999",
    "water",
    "density",
    "block",
    "min",
    "body",
    "copies",
    "columns",
    "emitter",
    "gravity",
    "",
    "\"a b\"",
    "\u{1b}[2J",
    "tank",
    "open",
];

fn override_text(dice: &mut Dice) -> Vec<u8> {
    let mut text = Vec::new();
    for part in 0..1 + dice.below(5) {
        if part > 0 {
            text.push(b'.');
        }
        text.extend(dice.pick(&WORDS).bytes());
    }
    text.push(b'=');
    for part in 0..1 + dice.below(3) {
        if part > 0 {
            text.extend(dice.pick(&[",", "[", "{", "}", "\n", "#"]).bytes());
        }
        text.extend(dice.pick(&VALUES).bytes());
    }
    if dice.one_in(2) {
        spoil(&mut text, dice);
    }
    text
}

#[test]
fn an_override_is_applied_or_refused() {
    let scenes = corpus();
    let bases: Vec<&String> = scenes.iter().filter(|text| scene_file::parse(text, "base.toml", &[]).is_ok()).collect();
    let run = |input: &[u8]| {
        let base = bases[input.len() % bases.len()];
        match String::from_utf8_lossy(input).parse::<Override>() {
            Ok(change) => read(base, &[change]),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    };
    fuzz("override", 1500, override_text, run);
}
