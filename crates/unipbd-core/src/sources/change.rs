//! Emitters that come, change and go while a run goes on, and the state of all of them.

use super::columns::columns;
use super::emitter::{EmitterSystem, Nozzle};
use super::saved::{EmitterState, SavedEmitter};
use crate::particles::Particles;
use crate::rng::Rng;
use crate::rows::RowIndex;
use crate::scene::{Emitter, Scene};

/// Properties of an emitter to be changed; those that are `None` stay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EmitterChange {
    /// Speed at the face [m/s]; a sheath without a speed of its own goes along.
    pub speed: Option<f64>,
    /// Temperature of the emitted gas.
    pub temperature: Option<f64>,
    /// Switches it on or off from now on, whatever its `start` and `stop` say.
    pub on: Option<bool>,
}

impl EmitterChange {
    /// The description after the change; `now` \[s].
    pub(crate) fn applied(&self, emitter: &Emitter, now: f64) -> Emitter {
        let mut emitter = emitter.clone();
        emitter.speed = self.speed.unwrap_or(emitter.speed);
        emitter.temperature = self.temperature.unwrap_or(emitter.temperature);
        if self.on == Some(true) {
            (emitter.start, emitter.stop) = (emitter.start.min(now), None);
        }
        emitter
    }
}

/// An emitter as it is read from outside.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct EmitterReading {
    /// Its description, with all changes since the start.
    pub description: Emitter,
    /// Whether it pushes particles out.
    pub running: bool,
    /// Whether it was taken away.
    pub removed: bool,
}

impl EmitterSystem {
    /// No emitters yet.
    pub(crate) fn none() -> Self {
        EmitterSystem { emitters: Vec::new(), injectors: Vec::new() }
    }

    /// Whether nothing will come out any more: all were taken away.
    pub(crate) fn is_over(&self) -> bool {
        self.injectors.is_empty() && self.emitters.iter().all(|nozzle| nozzle.removed)
    }

    /// The emitters, in the order in which they came.
    pub(crate) fn readings(&self) -> Vec<EmitterReading> {
        let reading = |nozzle: &Nozzle| EmitterReading {
            description: nozzle.description.clone(),
            running: nozzle.state.running,
            removed: nozzle.removed,
        };
        self.emitters.iter().map(reading).collect()
    }

    /// Adds an emitter; `kit` has the materials.
    pub(crate) fn add(&mut self, emitter: &Emitter, kit: &Scene, seed: u64) {
        let rng = Rng::new(seed, self.emitters.len() as u64);
        self.emitters.push(Nozzle::new(emitter, kit, rng));
    }

    /// Changes an emitter; `now` \[s].
    pub(crate) fn change(&mut self, number: usize, change: &EmitterChange, kit: &Scene, now: f64) {
        let nozzle = &mut self.emitters[number];
        nozzle.description = change.applied(&nozzle.description, now);
        nozzle.off = change.on.map_or(nozzle.off, |on| !on);
        nozzle.columns = columns(&nozzle.description, kit.spacing);
    }

    /// Takes an emitter away; the particles behind its face are let go.
    pub(crate) fn remove(&mut self, number: usize, particles: &mut Particles, rows: &RowIndex) {
        let nozzle = &mut self.emitters[number];
        nozzle.removed = true;
        if nozzle.state.running {
            nozzle.close(particles, rows);
        }
    }

    /// The emitters as words, part of a saved state: their descriptions, then where they stand.
    pub fn save(&self) -> Vec<u64> {
        let saved = |nozzle: &Nozzle| SavedEmitter::of(&nozzle.description, [nozzle.removed, nozzle.off]);
        let all: Vec<SavedEmitter> = self.emitters.iter().map(saved).collect();
        // Plain data in memory: writing cannot fail.
        let bytes = postcard::to_stdvec(&all).unwrap_or_default();
        let mut words = vec![bytes.len() as u64];
        words
            .extend(bytes.chunks(8).map(|chunk| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte))));
        words.extend(self.emitters.iter().flat_map(|nozzle| nozzle.state.words()));
        words
    }

    /// The same system with the emitters of [`save`](Self::save); `None` if these make no sense with the materials of
    /// `kit`. The first `of_scene` emitters have these numbers of columns.
    pub(crate) fn at_saved(words: &[u64], kit: &Scene, of_scene: &[usize]) -> Option<Vec<RestoredEmitter>> {
        let (&length, words) = words.split_first()?;
        let count = usize::try_from(length).ok()?.div_ceil(8);
        if count > words.len() {
            return None;
        }
        let (text, words) = words.split_at(count);
        let mut bytes: Vec<u8> = text.iter().flat_map(|word| word.to_le_bytes()).collect();
        bytes.truncate(length as usize);
        let all: Vec<SavedEmitter> = postcard::from_bytes(&bytes).ok()?;
        let mut words = words.iter().copied();
        let mut restored = Vec::new();
        for saved in all {
            let (description, [removed, off]) = saved.emitter();
            if problem_of(&description, kit).is_some() {
                return None;
            }
            let mut nozzle = Nozzle::new(&description, kit, Rng::new(0, 0));
            nozzle.state = EmitterState::from_words(&mut words, nozzle.columns.len())?;
            (nozzle.removed, nozzle.off) = (removed, off);
            restored.push(RestoredEmitter(nozzle));
        }
        let columns = restored.iter().map(|emitter| emitter.0.columns.len());
        let same = of_scene.len() <= restored.len() && of_scene.iter().copied().eq(columns.take(of_scene.len()));
        (same && words.next().is_none()).then_some(restored)
    }

    /// Takes these emitters in place of those that there are.
    pub(crate) fn restore(&mut self, emitters: Vec<RestoredEmitter>) {
        self.emitters = emitters.into_iter().map(|emitter| emitter.0).collect();
    }
}

/// An emitter from a saved state.
pub(crate) struct RestoredEmitter(Nozzle);

/// The first problem of an emitter beside these materials, in words.
pub(crate) fn problem_of(emitter: &Emitter, kit: &Scene) -> Option<String> {
    let scene = Scene { emitter: vec![Emitter { name: String::new(), ..emitter.clone() }], ..kit.clone() };
    scene.validate().0.first().map(|problem| problem.to_string())
}
