//! Time of a frame against the number of particles, next to what the original program took.

use cpu_time::ProcessTime;
use unipbd_core::scene::{
    Block, GradientPoint, LegacyKernel, LegacySettings, Liquid, LiquidSurface, MassDensityDescription, Scene,
    SolverSettings, Substeps, Tank,
};

use crate::scenes::solver;

/// One size of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Particles.
    pub particles: usize,
    /// Mean time of a frame of 1/60 s \[ms].
    pub milliseconds: f64,
}

/// Mean time of a loop of the original program, one loop to 1/60 s, measured on a machine with two cores; the first is the
/// middle of 45 to 59 ms.
pub const ORIGINAL: [Point; 4] = [
    Point { particles: 1_600, milliseconds: 52.0 },
    Point { particles: 3_200, milliseconds: 140.0 },
    Point { particles: 6_400, milliseconds: 496.0 },
    Point { particles: 12_800, milliseconds: 2_514.0 },
];

/// Sizes that are measured if none are given.
pub const SIZES: [usize; 8] = [400, 1_600, 6_400, 12_800, 51_200, 204_800, 500_000, 1_000_000];

/// Whose solver runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The default settings.
    Default,
    /// The choices of the original program, as in `scenes/seed`.
    Original,
}

/// Two liquids side by side in a box, as high as wide: the original's scene at any size, its spacing kept.
pub fn two_liquids(particles: usize, method: Method) -> Scene {
    let across = (particles as f64).sqrt();
    let half = (across / 2.0).round().max(1.0);
    let rows = (particles as f64 / (2.0 * half)).round().max(1.0);
    let mut scene = Scene { spacing: 0.62, gravity: [0.0, -9.8], ..Scene::default() };
    let (half, top) = (half * scene.spacing, rows * scene.spacing);
    let original = method == Method::Original;
    let liquid = |name: &str, density: f64| Liquid {
        particle_mass: original.then_some(1.0),
        surface: if original { LiquidSurface::None } else { LiquidSurface::Free },
        ..Liquid::new(name, density)
    };
    scene.liquid = vec![liquid("light", 1.0), liquid("heavy", 2.0)];
    scene.block = vec![Block::new("light", [-half, 0.0], [0.0, top]), Block::new("heavy", [0.0, 0.0], [half, top])];
    scene.tank = vec![Tank::new([-half, 0.0], [half, 2.0 * top])];
    if original {
        scene.solver = SolverSettings {
            substeps: Substeps::Fixed(1),
            iterations: 3,
            kernel_radius: 2.0 / scene.spacing,
            gradients: Some(GradientPoint::Predicted),
            settle_substeps: Some(0),
            ..SolverSettings::default()
        };
        scene.legacy = LegacySettings {
            kernel: LegacyKernel::Poly6Spiky3d,
            mass_density: Some(MassDensityDescription::default()),
            ..LegacySettings::default()
        };
    }
    scene
}

/// The mean time of the frames after the first, on one thread. It is the time of the processor: what
/// else runs on the machine does not count.
///
/// # Panics
/// Where the run diverges.
pub fn measure(scene: &Scene, frames: u32) -> Point {
    let mut solver = solver(scene, 1);
    solver.step_frame().expect("a frame");
    let start = ProcessTime::now();
    for _ in 0..frames {
        solver.step_frame().expect("a frame");
    }
    let milliseconds = 1e3 * start.elapsed().as_secs_f64() / f64::from(frames);
    Point { particles: solver.positions().len(), milliseconds }
}

/// The exponent p of time ~ particles^p that fits best in logarithms, over the points of at least this
/// many particles.
pub fn exponent(points: &[Point], from: usize) -> f64 {
    let logs = points.iter().filter(|point| point.particles >= from);
    let logs: Vec<(f64, f64)> = logs.map(|point| ((point.particles as f64).ln(), point.milliseconds.ln())).collect();
    let count = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), log| (x + log.0 / count, y + log.1 / count));
    let products = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum::<f64>();
    products / logs.iter().map(|log| (log.0 - x) * (log.0 - x)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_law_is_its_power() {
        let law = |particles: usize| Point { particles, milliseconds: 0.3 * (particles as f64).powf(1.25) };
        let points = [400, 6_400, 100_000].map(law);
        assert!((exponent(&points, 0) - 1.25).abs() < 1e-12);
        assert!(exponent(&ORIGINAL, 0) > 1.7, "a search over all pairs");
    }

    #[test]
    fn both_solvers_get_the_particles_asked_for() {
        for particles in [400, 1_600, 12_800] {
            for method in [Method::Default, Method::Original] {
                let start = two_liquids(particles, method).estimate().particles_at_start;
                assert!((start as f64 / particles as f64 - 1.0).abs() < 0.03, "{start} for {particles}");
            }
        }
    }
}
