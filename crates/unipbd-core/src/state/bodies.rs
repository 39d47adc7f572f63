//! Rigid bodies and their contacts, and ropes, in a saved state.

use super::StateError;
use super::error::damaged;
use crate::coupling::RigidBodies;

/// Parts of a run as words: the number of bytes, then the bytes.
pub(super) fn to_words(part: &impl serde::Serialize) -> Vec<u64> {
    // Plain data in memory: writing cannot fail.
    let bytes = postcard::to_stdvec(part).unwrap_or_default();
    let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    std::iter::once(bytes.len() as u64).chain(bytes.chunks(8).map(word)).collect()
}

/// A part from words; `name` is what it is.
pub(super) fn read_words<T: serde::de::DeserializeOwned>(words: &[u64], name: &str) -> Result<T, StateError> {
    let (&length, words) = words.split_first().ok_or_else(|| damaged(&format!("its {name} are missing")))?;
    let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    if length > bytes.len() as u64 {
        return Err(damaged(&format!("its {name} end too early")));
    }
    bytes.truncate(length as usize);
    postcard::from_bytes(&bytes).map_err(|_| damaged(&format!("its {name} make no sense")))
}

/// The bodies from words, if they match the bodies of the run.
pub(super) fn from_words(words: &[u64], running: &RigidBodies, spacing: f64) -> Result<RigidBodies, StateError> {
    let rigid: RigidBodies = read_words(words, "bodies")?;
    running.at_saved(rigid, spacing).ok_or_else(|| damaged("its bodies are not those of the run"))
}
