//! Random scenes, each made from its seed alone.

use unipbd_core::rng::Rng;
use unipbd_core::scene::{
    Block, Gas, Liquid, LiquidSurface, PressureGridUse, Scene, Slip, SolverSettings, Substeps, Tank,
};

use super::{Ending, endure};
use crate::scenes::{body, nozzle};

/// Random choices.
struct Random(Rng);

impl Random {
    fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.0.unit() < part
    }

    fn whole(&mut self, low: u32, high: u32) -> u32 {
        low + (self.0.next_u64() % u64::from(high - low + 1)) as u32
    }
}

/// How many scenes ended how.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Finite, contained, bounded.
    pub sound: u32,
    /// Stopped with an error of the solver.
    pub stopped: Vec<(u64, String)>,
    /// Refused by the checks.
    pub refused: u32,
    /// Broken, with the seed.
    pub broken: Vec<(u64, String)>,
}

/// Frames that a random scene is watched.
const FRAMES: u32 = 40;

/// Runs a random scene, or one that was shrunk from it.
pub fn endure_random(scene: &Scene) -> Ending {
    endure(scene, FRAMES, accountable_speed(scene))
}

/// Runs the scenes of these seeds.
pub fn fuzz(seeds: impl Iterator<Item = u64>, mut look: impl FnMut(u64, &Ending)) -> Counts {
    let mut counts = Counts::default();
    for seed in seeds {
        let ending = endure_random(&random_scene(seed));
        look(seed, &ending);
        match ending {
            Ending::Sound { .. } => counts.sound += 1,
            Ending::Refused => counts.refused += 1,
            Ending::Stopped(error) => counts.stopped.push((seed, error)),
            Ending::Broken(what) => counts.broken.push((seed, what)),
        }
    }
    counts
}

/// A scene in a few words.
pub fn summary(scene: &Scene) -> String {
    let liquids: Vec<String> = scene
        .liquid
        .iter()
        .map(|l| format!("{:.0} {:?} nu {:.1e}", l.density, l.surface, l.kinematic_viscosity))
        .collect();
    let gases: Vec<String> = scene.gas.iter().map(|g| format!("{:.0} x {:.2}", g.density, g.gravity_factor)).collect();
    let bodies: Vec<String> = scene.body.iter().map(|body| format!("{:.0}", body.density)).collect();
    let speed = scene.block.iter().map(|b| b.velocity[0].hypot(b.velocity[1])).fold(0.0, f64::max);
    format!(
        "dx {:.3}, {} fps, {:?}, liquids {liquids:?}, gases {gases:?}, bodies {bodies:?}, {} emitters, {:.1} dx/frame",
        scene.spacing,
        scene.fps,
        scene.solver.substeps,
        scene.emitter.len(),
        speed / (scene.spacing * scene.fps)
    )
}

/// The scene of a seed.
pub fn random_scene(seed: u64) -> Scene {
    let mut random = Random(Rng::from_state(seed));
    let spacing = 10f64.powf(random.range(-2.0, 0.0));
    let (width, height) = (f64::from(random.whole(8, 24)), f64::from(random.whole(8, 24)));
    let mut scene = Scene {
        spacing,
        fps: [30.0, 60.0, 120.0, 240.0][random.whole(0, 3) as usize],
        solver: solver(&mut random),
        tank: vec![Tank {
            name: String::new(),
            min: [0.0, 0.0],
            max: [width * spacing, height * spacing],
            open: Vec::new(),
            friction: Some(random.range(0.0, 1.0)),
            slip: if random.chance(0.3) { Slip::None } else { Slip::Free },
            without_slip: Vec::new(),
        }],
        ..Scene::default()
    };
    let frame = spacing * scene.fps;
    let speed = if random.chance(0.2) { random.range(0.0, 50.0) } else { random.range(0.0, 2.0) } * frame;
    materials(&mut random, &mut scene, frame);
    blocks(&mut random, &mut scene, (width, height), speed);
    if random.chance(0.4) {
        bodies(&mut random, &mut scene, (width, height));
    }
    if random.chance(0.2) {
        let material = scene.block[0].material.clone();
        let face = [0.5 * width * spacing, 0.7 * height * spacing];
        scene.emitter.push(nozzle(&material, face, 3.0 * spacing, 0.3 * frame));
    }
    if seed.is_multiple_of(2) { with_pressure_grid(scene) } else { scene }
}

/// The scene with the pressure grid, if that supports it. It draws no random number, so all other scenes stay the same.
fn with_pressure_grid(scene: Scene) -> Scene {
    let solver = SolverSettings { pressure_grid: PressureGridUse::On, ..scene.solver.clone() };
    let grid = Scene { solver, ..scene.clone() };
    if grid.validate().0.is_empty() { grid } else { scene }
}

/// The speed that a scene can account for [m/s].
pub fn accountable_speed(scene: &Scene) -> f64 {
    let frame = scene.spacing * scene.fps;
    let height = scene.tank.iter().map(|tank| tank.max[1] - tank.min[1]).fold(0.0, f64::max);
    let thrown = scene.block.iter().map(|block| block.velocity[0].hypot(block.velocity[1]));
    let speed = thrown.chain(scene.emitter.iter().map(|emitter| emitter.speed)).fold(0.0, f64::max);
    let fall = (2.0 * 9.81 * height).sqrt();
    // Hot gas rises, a start that overlaps a little flies apart. What is light and caught between a heavy
    // liquid and a wall leaves as fast as Bernoulli lets it, sqrt(2 p/rho), with p the heavy one's weight
    // and its impact.
    let densities = || scene.materials().map(|material| material.density()).filter(|density| *density > 0.0);
    let ratio = densities().fold(0.0, f64::max) / densities().fold(f64::INFINITY, f64::min);
    let squirt = if ratio.is_finite() { ratio.sqrt() * (fall + 2.0 * speed) } else { 0.0 };
    6.0 * fall + 3.0 * speed + 6.0 * frame + squirt
}

fn solver(random: &mut Random) -> SolverSettings {
    SolverSettings {
        substeps: if random.chance(0.7) { Substeps::Auto } else { Substeps::Fixed(random.whole(1, 12)) },
        max_substeps: 48,
        settle_substeps: Some(20),
        ..SolverSettings::default()
    }
}

fn materials(random: &mut Random, scene: &mut Scene, frame: f64) {
    let nu = |random: &mut Random, spacing: f64| {
        if random.chance(0.3) { 10f64.powf(random.range(-3.0, 2.0)) * spacing * frame } else { 0.0 }
    };
    for index in 0..random.whole(1, 2) {
        let kinematic_viscosity = nu(random, scene.spacing);
        let name = format!("fluid {index}");
        let density = 10f64.powf(random.range(0.0, 3.0));
        if random.chance(0.2) {
            let gravity_factor = random.range(-1.0, 1.0);
            scene.gas.push(Gas { name, density, gravity_factor, kinematic_viscosity, ..Gas::default() });
        } else {
            let surface = if random.chance(0.1) { LiquidSurface::None } else { LiquidSurface::Free };
            scene.liquid.push(Liquid { kinematic_viscosity, surface, ..Liquid::new(&name, density) });
        }
    }
}

fn blocks(random: &mut Random, scene: &mut Scene, (width, height): (f64, f64), speed: f64) {
    let names: Vec<String> = scene.materials().map(|material| material.name().to_owned()).collect();
    let share = width / names.len() as f64;
    for (index, name) in names.iter().enumerate() {
        let left = (share * index as f64).floor();
        let right = (left + random.range(0.3, 1.0) * share).floor().max(left + 1.0);
        let bottom = random.range(0.0, 0.4 * height).floor();
        let top = (bottom + random.range(0.2, 0.6) * height).floor().max(bottom + 1.0);
        let at = |x: f64, y: f64| [x * scene.spacing, y * scene.spacing];
        let angle = random.range(0.0, std::f64::consts::TAU);
        let mut block = Block::new(name, at(left, bottom), at(right, top));
        block.velocity = [speed * angle.cos(), speed * angle.sin()];
        block.jitter = if random.chance(0.3) { random.range(0.0, 0.4) } else { 0.0 };
        block.temperature = 1.0;
        scene.block.push(block);
    }
}

fn bodies(random: &mut Random, scene: &mut Scene, (width, height): (f64, f64)) {
    for index in 0..random.whole(1, 3) {
        let size = random.range(2.0, 5.0) * scene.spacing;
        let place = [
            (width * (f64::from(index) + 0.5) / 3.0) * scene.spacing,
            height * scene.spacing * random.range(0.7, 0.85),
        ];
        let mut one = body(&format!("body {index}"), place);
        if random.chance(0.5) {
            one.radius = Some(0.5 * size);
        } else {
            one.size = Some([size, size * random.range(0.5, 1.5)]);
        }
        one.density = 10f64.powf(random.range(1.0, 4.0));
        one.angle_deg = random.range(0.0, 360.0);
        scene.body.push(one);
    }
}
