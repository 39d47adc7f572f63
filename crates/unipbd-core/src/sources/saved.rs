//! The variable state of an emitter: part of a saved state.

use crate::scene::{Emitter, Profile, Sheath, SmokeSource};

/// The description of an emitter with every field, as formats without field names need it, and what became of it.
#[derive(serde::Serialize, serde::Deserialize)]
pub(super) struct SavedEmitter {
    names: (String, String),
    place: ([f64; 2], [f64; 2], f64),
    flow: (f64, Profile, f64, f64),
    schedule: (f64, Option<f64>, bool),
    sheath: Option<(f64, Option<f64>, f64)>,
    smoke: Option<(String, u32)>,
    /// Whether it was taken away, and whether it was switched off.
    over: [bool; 2],
}

impl SavedEmitter {
    pub fn of(emitter: &Emitter, over: [bool; 2]) -> Self {
        let Emitter { name, material, position, direction, width, speed, profile, temperature, .. } = emitter.clone();
        let Emitter { jitter, start, stop, throttle, sheath, smoke, .. } = emitter.clone();
        SavedEmitter {
            names: (name, material),
            place: (position, direction, width),
            flow: (speed, profile, temperature, jitter),
            schedule: (start, stop, throttle),
            sheath: sheath.map(|sheath| (sheath.thickness, sheath.speed, sheath.temperature)),
            smoke: smoke.map(|smoke| (smoke.material, smoke.per_particle)),
            over,
        }
    }

    pub fn emitter(self) -> (Emitter, [bool; 2]) {
        let (name, material) = self.names;
        let (position, direction, width) = self.place;
        let (speed, profile, temperature, jitter) = self.flow;
        let (start, stop, throttle) = self.schedule;
        let sheath = self.sheath.map(|(thickness, speed, temperature)| Sheath { thickness, speed, temperature });
        let smoke = self.smoke.map(|(material, per_particle)| SmokeSource { material, per_particle });
        let emitter = Emitter {
            name,
            material,
            position,
            direction,
            width,
            speed,
            profile,
            temperature,
            jitter,
            start,
            stop,
            throttle,
            sheath,
            smoke,
        };
        (emitter, self.over)
    }
}

/// Particles kept behind the face in each column.
pub(super) const ROWS_BEHIND: usize = 3;

/// The variable state of an emitter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EmitterState {
    pub rng: u64,
    pub running: bool,
    /// Mean of max(C, 0) ahead of the face, averaged over the flow distance.
    pub compression: f64,
    pub columns: Vec<ColumnState>,
}

/// The variable state of one column of its face.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ColumnState {
    /// Flow distance since the last particle crossed the face, in spacings [0, 1).
    pub progress: f64,
    /// Ids of the particles behind the face, the nearest first.
    pub behind: [u32; ROWS_BEHIND],
}

impl EmitterState {
    /// The state as words.
    pub fn words(&self) -> Vec<u64> {
        let mut words = vec![self.rng, u64::from(self.running), self.compression.to_bits()];
        for column in &self.columns {
            words.push(column.progress.to_bits());
            words.extend(column.behind.map(u64::from));
        }
        words
    }

    /// The state from words; `None` if they are invalid.
    pub fn from_words(words: &mut impl Iterator<Item = u64>, columns: usize) -> Option<Self> {
        let (rng, running) = (words.next()?, words.next()?);
        let part = |word: u64| Some(f64::from_bits(word)).filter(|part| (0.0..=1.0).contains(part));
        let compression = part(words.next()?)?;
        let mut states = Vec::with_capacity(columns);
        for _ in 0..columns {
            let progress = part(words.next()?)?;
            let mut behind = [0; ROWS_BEHIND];
            for id in &mut behind {
                *id = u32::try_from(words.next()?).ok()?;
            }
            states.push(ColumnState { progress, behind });
        }
        Some(EmitterState { rng, running: running != 0, compression, columns: states })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_give_the_same_emitter_back_and_nonsense_gives_none() {
        let column = ColumnState { progress: 0.25, behind: [7, 8, 9] };
        let state = EmitterState { rng: 5, running: true, compression: 0.5, columns: vec![column; 2] };
        let words = state.words();
        assert_eq!(EmitterState::from_words(&mut words.iter().copied(), 2), Some(state));
        assert_eq!(EmitterState::from_words(&mut words.iter().copied(), 3), None);
        assert_eq!(EmitterState::from_words(&mut [1, 1, f64::NAN.to_bits()].into_iter(), 0), None);
    }
}
