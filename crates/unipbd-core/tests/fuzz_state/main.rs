//! Saved states with wrong numbers in them and a right checksum: refused, or gone on from without a panic.
#![allow(unsafe_code)]

#[path = "../../../../tests/fuzz/harness.rs"]
mod harness;
mod kinds;
#[allow(dead_code)]
#[path = "../state/scenes.rs"]
mod scenes;

use harness::{Dice, fuzz, spoil};
use unipbd_core::rng::mix;
use unipbd_core::scene::Scene;
use unipbd_core::{BuildOptions, Solver, State};

/// Bytes before the contents: the name of the format and its version.
const HEAD: usize = 12;
const CHECKSUM: usize = 8;

/// A scene, and saved moments of it.
struct Kind {
    scene: Scene,
    saved: Vec<Vec<u8>>,
}

fn build(scene: &Scene) -> Solver {
    scene.build(BuildOptions { threads: Some(1), seed: None }).unwrap()
}

fn kinds() -> Vec<Kind> {
    let saved = |scene: Scene| {
        let mut solver = build(&scene);
        let mut saved = vec![solver.save().to_bytes()];
        for frames in [1, 12, 60] {
            scenes::run(&mut solver, frames);
            saved.push(solver.save().to_bytes());
        }
        Kind { scene, saved }
    };
    kinds::all().into_iter().map(saved).collect()
}

/// The checksum of the format, so that what is changed gets past it.
fn seal(mut contents: Vec<u8>) -> Vec<u8> {
    let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    let start = mix(contents.len() as u64);
    let sum = contents.chunks(8).fold(start, |sum, chunk| mix(sum.rotate_left(5) ^ word(chunk)));
    contents.extend(sum.to_le_bytes());
    contents
}

/// A changed state behind the number of its kind.
fn changed(kinds: &[Kind], dice: &mut Dice) -> Vec<u8> {
    let kind = dice.below(kinds.len());
    let state = dice.pick(&kinds[kind].saved);
    let mut contents = state[HEAD..state.len() - CHECKSUM].to_vec();
    spoil(&mut contents, dice);
    let whole = [&state[..HEAD], &contents[..]].concat();
    [&[kind as u8][..], &seal(whole)].concat()
}

#[test]
fn a_state_with_wrong_numbers_is_refused_or_gone_on_from() {
    let kinds = kinds();
    let run = |input: &[u8]| {
        let Ok(state) = State::from_bytes(&input[1..]) else { return };
        let mut solver = build(&kinds[usize::from(input[0])].scene);
        if solver.restore(&state).is_ok() {
            let stepped = (0..3).try_for_each(|_| solver.step_frame().map(drop));
            drop(stepped);
            let _ = (solver.diagnostics(), solver.state_hash());
            let _ = State::from_bytes(&solver.save().to_bytes());
        }
    };
    fuzz("state", 600, |dice| changed(&kinds, dice), run);
}

#[test]
fn states_that_nothing_was_changed_in_go_on_bit_for_bit() {
    for kind in kinds() {
        for saved in &kind.saved {
            let state = State::from_bytes(&seal(saved[..saved.len() - CHECKSUM].to_vec())).unwrap();
            let (mut one, mut other) = (build(&kind.scene), build(&kind.scene));
            scenes::run(&mut other, 3);
            for solver in [&mut one, &mut other] {
                solver.restore(&state).unwrap();
                scenes::run(solver, 5);
            }
            assert_eq!(one.state_hash(), other.state_hash());
        }
    }
}
