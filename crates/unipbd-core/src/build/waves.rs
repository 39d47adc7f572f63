//! The waves of a scene: which material fills which place of the lattice.

use std::f64::consts::TAU;

use crate::math::Vector64;
use crate::rng::Rng;
use crate::scene::{Block, Scene, Wave, block_points};

/// Stream of random phases.
const WAVE_STREAM: u64 = 4 << 32;
/// Depths of more than this many wavelengths are infinite.
const DEEP: f64 = 4.0;
/// The displacement is undone step by step; each step is a contraction by the slope of the wave.
const STEPS: usize = 12;

/// The waves of a scene with their phases \[rad].
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

    /// The places of the lattice that a block fills once its outline is wavy. The lattice itself stays as
    /// it is: a bent one pushes back like a solid, and holds a small wave for good.
    pub fn block_points(&self, block: &Block, spacing: f64) -> Vec<Vector64> {
        if self.0.is_empty() {
            return block_points(block, spacing);
        }
        let highest = self.0.iter().map(|(wave, _)| wave.amplitude.abs()).sum::<f64>();
        let more = (highest / spacing).ceil() * spacing;
        let [low, high] = [block.min[1] - more, block.max[1] + more];
        let taller = Block { min: [block.min[0], low], max: [block.max[0], high], ..block.clone() };
        let inside = |point: &Vector64| (block.min[1]..block.max[1]).contains(&self.rest_height(*point));
        block_points(&taller, spacing).into_iter().filter(inside).collect()
    }

    /// The height from which the waves lift the fluid that is at a point now \[m].
    fn rest_height(&self, x: Vector64) -> f64 {
        let lifted = |y: f64| self.0.iter().map(|(wave, phase)| lift(wave, *phase, x.x, y)).sum::<f64>();
        (0..STEPS).fold(x.y, |y, _| x.y - lifted(y))
    }
}

/// Vertical displacement in the linear mode of an inviscid layer above or below the level (Lamb,
/// Hydrodynamics, section 228): a cos(kx) sinh(k d)/sinh(k depth), d the distance to floor or lid \[m].
fn lift(wave: &Wave, phase: f64, x: f64, y: f64) -> f64 {
    let k = TAU / wave.wavelength;
    let end = if y > wave.level { wave.top } else { wave.bottom };
    let far = DEEP * wave.wavelength;
    let depth = end.map_or(far, |end| (end - wave.level).abs().min(far));
    let distance = depth - (y - wave.level).abs();
    if distance <= 0.0 {
        return 0.0;
    }
    wave.amplitude * libm::cos(k * x + phase) * libm::sinh(k * distance) / libm::sinh(k * depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(amplitude: f64) -> Scene {
        let wave = |level| Wave {
            level,
            amplitude,
            wavelength: 3.2,
            phase_deg: Some(0.0),
            bottom: Some(0.0),
            top: Some(2.0 * level),
        };
        Scene { spacing: 0.1, wave: vec![wave(1.6)], ..Scene::default() }
    }

    #[test]
    fn two_blocks_share_the_lattice_between_them() {
        let scene = scene(0.2);
        let waves = Waves::new(&scene, 1);
        let light = waves.block_points(&Block::new("light", [0.0, 0.0], [3.2, 1.6]), 0.1);
        let heavy = waves.block_points(&Block::new("heavy", [0.0, 1.6], [3.2, 3.2]), 0.1);
        let mut all: Vec<_> = light.iter().chain(&heavy).map(|x| [(x.x * 1e3).round(), (x.y * 1e3).round()]).collect();
        all.sort_by(|a, b| a.partial_cmp(b).unwrap());
        all.dedup();
        assert_eq!(all.len(), 32 * 32);
        assert!(light.iter().all(|x| x.y < 1.6 + 0.2 * (TAU * x.x / 3.2).cos() + 1e-3));
        assert!(heavy.iter().all(|x| x.y > 1.6 + 0.2 * (TAU * x.x / 3.2).cos() - 1e-3));
    }

    #[test]
    fn the_outline_has_the_amplitude_asked_for() {
        let scene = scene(0.2);
        let points = Waves::new(&scene, 1).block_points(&Block::new("light", [0.0, 0.0], [3.2, 1.6]), 0.1);
        let sum: f64 = points.iter().map(|x| (TAU * x.x / 3.2).cos()).sum();
        let amplitude = 2.0 * sum * 0.01 / 3.2;
        assert!((amplitude - 0.2).abs() < 0.02, "amplitude {amplitude}");
    }
}
