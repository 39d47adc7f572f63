//! Columns of particles across the face of an emitter.

use crate::math::{Real, real};
use crate::scene::{Emitter, Profile};

/// One column of the face.
pub(super) struct Column {
    /// Distance from the middle of the face \[m].
    pub offset: f64,
    /// Distance of its particles \[m].
    pub row: f64,
    pub speed: f64,
    pub temperature: Real,
    pub core: bool,
}

/// The columns of a face, symmetric about the middle, the sheath outside the core.
pub(super) fn columns(emitter: &Emitter, spacing: f64) -> Vec<Column> {
    let (core, apart) = emitter.columns(spacing);
    let (sheath, apart_in_sheath) = emitter.sheath_columns(spacing);
    let half = 0.5 * core as f64 * apart;
    let row = |apart: f64| if apart == spacing { spacing } else { spacing * spacing / apart };
    let in_core = (0..core).map(|index| {
        let offset = (index as f64 + 0.5) * apart - half;
        Column {
            offset,
            row: row(apart),
            speed: emitter.speed * emitter.profile.factor(offset / half),
            temperature: real(emitter.temperature),
            core: true,
        }
    });
    let outside = |side: f64, index: usize| Column {
        offset: side * (half + (index as f64 + 0.5) * apart_in_sheath),
        row: row(apart_in_sheath),
        speed: emitter.sheath_speed(),
        temperature: real(emitter.sheath.as_ref().map_or(0.0, |sheath| sheath.temperature)),
        core: false,
    };
    let left = (0..sheath).rev().map(|index| outside(-1.0, index));
    let right = (0..sheath).map(|index| outside(1.0, index));
    left.chain(in_core).chain(right).collect()
}

impl Profile {
    /// Fraction of the speed at a position across the face, -1 to 1.
    fn factor(self, across: f64) -> f64 {
        match self {
            Profile::Uniform => 1.0,
            Profile::Parabolic => 1.0 - 0.5 * across * across,
        }
    }
}
