//! What a scene would cost, without building it.

use super::layout::{block_counts, disc_count, particle_counts};
use super::{Drive, Emitter, Profile, Scene, SubstepLaw, Substeps};

/// Memory per particle \[byte]: columns, multipliers and about 20 stored neighbours.
pub const BYTES_PER_PARTICLE: u64 = 300;
/// Rough time per particle and substep on one core \[s].
pub const SECONDS_PER_PARTICLE_AND_SUBSTEP: f64 = 60e-9;
/// The same with the pressure grid, whose substeps are long: each has a grid to solve and a list to make.
pub const SECONDS_WITH_PRESSURE_GRID: f64 = 160e-9;

/// What a scene would cost. Upper bounds where the run decides: throttled emitters emit less, and
/// gas may be removed before its lifetime is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Particles at the start.
    pub particles_at_start: u64,
    /// Particles and smoke markers that all emitters add while all of them run [1/s].
    pub emitted_per_second: f64,
    /// Most particles at any time of the run, by starts, stops and lifetimes.
    pub particles_at_peak: u64,
    /// Substeps per frame at the start: the given number, or what `"auto"` would choose.
    pub substeps: u32,
    /// Memory at the peak \[byte], at [`BYTES_PER_PARTICLE`].
    pub memory_bytes: u64,
    /// Computing time of the whole run on one core \[s], at [`SECONDS_PER_PARTICLE_AND_SUBSTEP`] and the
    /// substeps of the start: right to a factor of about 3.
    pub cost_seconds: f64,
}

impl Scene {
    /// Estimates the cost of the scene without allocating its particles.
    pub fn estimate(&self) -> Estimate {
        let population = population(self);
        let emitted_per_second =
            self.emitter.iter().map(|emitter| rates(emitter, self.spacing)).map(|r| r.0 + r.1).sum::<f64>()
                + self.injector.iter().map(|injector| injector.rate).sum::<f64>();
        let substeps = match self.solver.substeps {
            Substeps::Fixed(count) => count,
            Substeps::Auto => automatic_substeps(self),
        };
        let steps = self.fps * f64::from(substeps);
        let grid = self.uses_pressure_grid();
        let each = if grid { SECONDS_WITH_PRESSURE_GRID } else { SECONDS_PER_PARTICLE_AND_SUBSTEP };
        Estimate {
            particles_at_start: population.start as u64,
            emitted_per_second,
            particles_at_peak: population.peak.ceil() as u64,
            substeps,
            memory_bytes: (population.peak.ceil() as u64).saturating_mul(BYTES_PER_PARTICLE),
            cost_seconds: population.particle_seconds * steps * each,
        }
    }

    /// Most particles at any time of the run.
    pub(super) fn most_particles(&self) -> f64 {
        population(self).peak.ceil()
    }

    fn lifetime(&self, material: &str) -> f64 {
        let gas = self.gas.iter().find(|gas| gas.name == material).and_then(|gas| gas.lifetime);
        let smoke = self.smoke.iter().find(|smoke| smoke.name == material).and_then(|smoke| smoke.lifetime);
        gas.or(smoke).unwrap_or(f64::INFINITY)
    }
}

/// Particles and smoke markers that an emitter adds [1/s].
fn rates(emitter: &Emitter, spacing: f64) -> (f64, f64) {
    let rate =
        |(columns, apart): (usize, f64), speed: f64| columns as f64 * (apart / spacing) * (speed.max(0.0) / spacing);
    // The mean of 1 - s^2/2 over the face is 5/6.
    let mean = if emitter.profile == Profile::Parabolic { 5.0 / 6.0 } else { 1.0 };
    let core = rate(emitter.columns(spacing), emitter.speed * mean);
    let sheath = 2.0 * rate(emitter.sheath_columns(spacing), emitter.sheath_speed());
    let markers = emitter.smoke.as_ref().map_or(0.0, |smoke| core * f64::from(smoke.per_particle));
    (core + sheath, markers)
}

/// The number of particles over time, in brief.
struct Population {
    start: f64,
    peak: f64,
    /// Integral over the run \[s].
    particle_seconds: f64,
}

/// A change at a time: in the rate at which the number grows [1/s], or in the number itself.
struct Change {
    time: f64,
    rate: f64,
    jump: f64,
}

/// Follows the number of particles, which is piecewise linear in time.
fn population(scene: &Scene) -> Population {
    let start = particle_counts(scene).into_iter().map(|(_, count)| count).sum();
    let mut changes = changes(scene);
    changes.retain(|change| change.time < scene.duration);
    changes.push(Change { time: scene.duration, rate: 0.0, jump: 0.0 });
    changes.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut population = Population { start, peak: start, particle_seconds: 0.0 };
    let (mut time, mut count, mut rate) = (0.0, start, 0.0);
    for change in changes {
        let span: f64 = (change.time - time).max(0.0);
        let next = count + rate * span;
        population.particle_seconds += 0.5 * (count + next) * span;
        population.peak = population.peak.max(next);
        (time, count, rate) = (time + span, next + change.jump, rate + change.rate);
    }
    population
}

fn changes(scene: &Scene) -> Vec<Change> {
    let mut changes = Vec::new();
    for block in &scene.block {
        let jump = -block_counts(block, scene.spacing).into_iter().product::<f64>();
        changes.push(Change { time: scene.lifetime(&block.material), rate: 0.0, jump });
    }
    for disc in &scene.disc {
        let jump = -disc_count(disc, scene.spacing);
        changes.push(Change { time: scene.lifetime(&disc.material), rate: 0.0, jump });
    }
    for points in &scene.points {
        let jump = -(points.positions.len() as f64);
        changes.push(Change { time: scene.lifetime(&points.material), rate: 0.0, jump });
    }
    let mut flow = |rate: f64, material: &str, start: f64, stop: Option<f64>| {
        let (lifetime, stop) = (scene.lifetime(material), stop.unwrap_or(f64::INFINITY));
        let steps = [(start, rate), (stop, -rate), (start + lifetime, -rate), (stop + lifetime, rate)];
        changes.extend(steps.map(|(time, rate)| Change { time, rate, jump: 0.0 }));
    };
    for emitter in &scene.emitter {
        let (particles, markers) = rates(emitter, scene.spacing);
        let smoke = emitter.smoke.as_ref().map_or("", |smoke| &smoke.material);
        flow(particles, &emitter.material, emitter.start, emitter.stop);
        flow(markers, smoke, emitter.start, emitter.stop);
    }
    for injector in &scene.injector {
        flow(injector.rate, &injector.material, injector.start, injector.stop);
    }
    changes
}

/// Substeps per frame for the speeds and depths at the start.
fn automatic_substeps(scene: &Scene) -> u32 {
    let (mut speed, pressure) = (largest_speed(scene), pressure_over_density(scene));
    if scene.uses_pressure_grid() {
        // Substeps follow the speed alone: about that of a fall through half the depth, once it moves.
        speed = speed.max(pressure.sqrt());
    }
    let acceleration = libm::hypot(scene.gravity[0], scene.gravity[1]);
    let wanted = SubstepLaw::new(scene).wanted(1.0 / scene.fps, Drive { speed, pressure, acceleration });
    let count = wanted.into_iter().fold(1.0, f64::max).ceil();
    (count as u32).min(scene.solver.max_substeps)
}

fn largest_speed(scene: &Scene) -> f64 {
    let speed = |velocity: [f64; 2]| libm::hypot(velocity[0], velocity[1]);
    let blocks = scene.block.iter().map(|block| speed(block.velocity));
    let discs = scene.disc.iter().map(|disc| speed(disc.velocity));
    let sheath = |emitter: &Emitter| emitter.sheath.as_ref().and_then(|sheath| sheath.speed).unwrap_or(0.0);
    let emitters = scene.emitter.iter().map(|emitter| emitter.speed.max(sheath(emitter)));
    blocks.chain(discs).chain(emitters).fold(0.0, f64::max)
}

/// Liquid at the start along gravity: the lowest and highest place \[m] and the density [kg/m^2].
struct Layer {
    low: f64,
    high: f64,
    density: f64,
}

/// g x depth of all liquid along gravity, times the density ratio where a heavier liquid lies on a
/// lighter one [m^2/s^2]. Gas has no weight of its own.
fn pressure_over_density(scene: &Scene) -> f64 {
    let [x, y] = scene.gravity;
    let strength = libm::hypot(x, y);
    if strength == 0.0 {
        return 0.0;
    }
    let up = [-x / strength, -y / strength];
    let layers = layers(scene, up);
    let low = layers.iter().map(|layer| layer.low).fold(f64::INFINITY, f64::min);
    let high = layers.iter().map(|layer| layer.high).fold(f64::NEG_INFINITY, f64::max);
    strength * (high - low).max(0.0) * inverted_density_ratio(&layers)
}

/// The largest ratio of the density of a layer to that of one below it, at least 1.
fn inverted_density_ratio(layers: &[Layer]) -> f64 {
    let mut by_height: Vec<(f64, f64)> = layers.iter().map(|layer| (layer.low + layer.high, layer.density)).collect();
    by_height.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut lightest = f64::INFINITY;
    by_height.into_iter().fold(1.0, |ratio: f64, (_, density)| {
        lightest = lightest.min(density);
        ratio.max(density / lightest)
    })
}

fn layers(scene: &Scene, up: [f64; 2]) -> Vec<Layer> {
    let along = |point: [f64; 2]| point[0] * up[0] + point[1] * up[1];
    let density = |name: &str| scene.liquid.iter().find(|liquid| liquid.name == name).map(|liquid| liquid.density);
    let blocks = scene.block.iter().filter_map(|block| {
        let corners = [block.min, block.max, [block.min[0], block.max[1]], [block.max[0], block.min[1]]].map(along);
        let [low, high] =
            [corners.into_iter().fold(f64::INFINITY, f64::min), corners.into_iter().fold(f64::MIN, f64::max)];
        Some(Layer { low, high, density: density(&block.material)? })
    });
    let discs = scene.disc.iter().filter_map(|disc| {
        let middle = along(disc.center);
        Some(Layer { low: middle - disc.radius, high: middle + disc.radius, density: density(&disc.material)? })
    });
    blocks.chain(discs).collect()
}
