//! The displacement of particles by the waves of a scene.

use std::f64::consts::TAU;

use crate::math::Vector64;
use crate::rng::Rng;
use crate::scene::{Scene, Wave};

/// Stream of random phases.
const WAVE_STREAM: u64 = 4 << 32;
/// Depths of more than this many wavelengths are infinite.
const DEEP: f64 = 4.0;

/// The waves of a scene with their phases [rad].
pub(super) struct Waves<'a>(Vec<(&'a Wave, f64)>);

impl<'a> Waves<'a> {
    /// A phase that the scene leaves out follows the seed.
    pub fn new(scene: &'a Scene, seed: u64) -> Self {
        let phase = |(number, wave): (usize, &'a Wave)| {
            let random = Rng::new(seed, WAVE_STREAM + number as u64).unit() * TAU;
            (wave, wave.phase_deg.map_or(random, f64::to_radians))
        };
        Waves(scene.wave.iter().enumerate().map(phase).collect())
    }

    /// Where a particle of the undisturbed lattice starts.
    pub fn displaced(&self, x: Vector64) -> Vector64 {
        x + self.0.iter().map(|(wave, phase)| displacement(wave, *phase, x)).sum::<Vector64>()
    }
}

/// The linear mode of an inviscid layer above or below the level (Lamb, Hydrodynamics, section 228):
/// vertical a cos(kx) sinh(k d)/sinh(k depth), horizontal by continuity, d the distance to floor or lid.
fn displacement(wave: &Wave, phase: f64, x: Vector64) -> Vector64 {
    let k = TAU / wave.wavelength;
    let (sin, cos) = (k * x.x + phase).sin_cos();
    let above = x.y > wave.level;
    let far = DEEP * wave.wavelength;
    let depth =
        if above { wave.top.map(|top| top - wave.level) } else { wave.bottom.map(|bottom| wave.level - bottom) };
    let depth = depth.unwrap_or(far).min(far);
    let distance = (depth - (x.y - wave.level).abs()).max(0.0);
    let full = (k * depth).sinh();
    let side = if above { 1.0 } else { -1.0 };
    Vector64::new(side * sin * (k * distance).cosh() / full, cos * (k * distance).sinh() / full) * wave.amplitude
}
