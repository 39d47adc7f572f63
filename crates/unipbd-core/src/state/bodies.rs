//! Rigid bodies and their contacts in a saved state.

use super::StateError;
use super::error::damaged;
use crate::coupling::RigidBodies;

/// The bodies as words: the number of bytes, then the bytes.
pub(super) fn to_words(rigid: &RigidBodies) -> Vec<u64> {
    // Plain data in memory: writing cannot fail.
    let bytes = postcard::to_stdvec(rigid).unwrap_or_default();
    let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    std::iter::once(bytes.len() as u64).chain(bytes.chunks(8).map(word)).collect()
}

/// The bodies from words, if they match the bodies of the run.
pub(super) fn from_words(words: &[u64], running: &RigidBodies, spacing: f64) -> Result<RigidBodies, StateError> {
    let (&length, words) = words.split_first().ok_or_else(|| damaged("its bodies are missing"))?;
    let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    if length > bytes.len() as u64 {
        return Err(damaged("its bodies end too early"));
    }
    bytes.truncate(length as usize);
    let rigid: RigidBodies = postcard::from_bytes(&bytes).map_err(|_| damaged("its bodies make no sense"))?;
    running.at_saved(rigid, spacing).ok_or_else(|| damaged("its bodies are not those of the run"))
}
