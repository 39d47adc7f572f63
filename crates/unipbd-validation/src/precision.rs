//! f32 against f64: the same scenes in two builds, near the origin, far from it, and over a wide domain.

use std::fmt::Write;
use std::process::Command;

use unipbd_core::math::Vector64;
use unipbd_core::scene::{Block, Disc, Liquid, Scene, SolverSettings, Substeps, Tank};

use crate::runner::{Failure, Runner, energy, points, velocities};
use crate::stamp::stamp;

/// Heading of the section in the accuracy sheet.
pub const HEADING: &str = "Single and double precision";
/// Rest distance \[m]: a power of two, so that walls and lattices lie at the same places in f32 far out too,
/// and what differs is the solver's doing.
const SPACING: f64 = 0.125;
/// How far from the origin far is \[spacings].
pub const FAR: f64 = 1e5;

/// Result of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Name of the scene.
    pub scene: String,
    /// Mean of max(C, 0) over all particles and frames.
    pub mean: f64,
    /// Change of the linear momentum over the sum of m |v| at the start; NaN where walls take part.
    pub momentum: f64,
    /// Change of the angular momentum about the first centre of mass over the sum of m |v| |x|; NaN likewise.
    pub angular: f64,
    /// Change of the energy from start to end, over that of the start.
    pub energy: f64,
    /// Largest growth of the energy, over that of the start.
    pub gain: f64,
}

struct Probe {
    name: &'static str,
    scene: fn(f64) -> Scene,
    frames: u32,
    free: bool,
    places: &'static [f64],
}

const PROBES: [Probe; 4] = [
    Probe { name: "tank at rest", scene: rest, frames: 150, free: false, places: &[0.0, 0.25 * FAR, FAR] },
    Probe { name: "dam break", scene: dam_break, frames: 60, free: false, places: &[0.0, 0.25 * FAR, FAR] },
    Probe { name: "drops collide", scene: drops, frames: 60, free: true, places: &[0.0, 0.25 * FAR, FAR] },
    Probe { name: "two dam breaks 1e5 dx apart", scene: both_ends, frames: 60, free: false, places: &[0.0] },
];

/// Runs all scenes in the precision of this build.
///
/// # Errors
/// When a scene is refused or diverges.
pub fn measure() -> Result<Vec<Reading>, Failure> {
    let places = PROBES.iter().flat_map(|probe| probe.places.iter().map(move |place| (probe, *place)));
    places.map(|(probe, place)| read(probe, place)).collect()
}

/// Momentum and angular momentum about a point, and the sums of m |v| and m |v| |x|.
fn momenta(run: &Runner, masses: &[f64], about: Vector64) -> (Vector64, f64, f64, f64) {
    let rows = points(&run.solver).zip(velocities(&run.solver)).zip(run.solver.material_indices());
    rows.fold((Vector64::ZERO, 0.0, 0.0, 0.0), |(p, l, size, turn), ((x, v), material)| {
        let (mass, x) = (masses[usize::from(*material)], x - about);
        let speed = mass * v.length();
        (p + v * mass, l + mass * x.perp_dot(v), size + speed, turn + speed * x.length())
    })
}

fn read(probe: &Probe, place: f64) -> Result<Reading, Failure> {
    let mut run = Runner::new(&(probe.scene)(place))?;
    let masses: Vec<f64> = run.solver.materials().iter().map(|m| m.density * SPACING * SPACING).collect();
    let about = points(&run.solver).sum::<Vector64>() / run.solver.positions().len() as f64;
    let (p, l, size, turn) = momenta(&run, &masses, about);
    let start = energy(&run.solver);
    let (mut mean, mut gain) = (0.0, f64::NEG_INFINITY);
    run.frames(probe.frames, |solver| {
        mean += solver.diagnostics().density_error_mean / f64::from(probe.frames);
        gain = gain.max(energy(solver) / start - 1.0);
    })?;
    // Internal forces move the centre of mass by p t/m alone: it is enough to ask about the first one.
    let (p_now, l_now, ..) = momenta(&run, &masses, about);
    let scene = if place == 0.0 { probe.name.to_owned() } else { format!("{}, at {place:e} dx", probe.name) };
    let part = |change: f64, whole: f64| if probe.free { change / whole } else { f64::NAN };
    Ok(Reading {
        scene,
        mean,
        momentum: part((p_now - p).length(), size),
        angular: part((l_now - l).abs(), turn),
        energy: energy(&run.solver) / start - 1.0,
        gain,
    })
}

fn fixed(liquid: Vec<Liquid>) -> Scene {
    let solver = SolverSettings { substeps: Substeps::Fixed(8), ..SolverSettings::default() };
    Scene { spacing: SPACING, solver, liquid, ..Scene::default() }
}

fn water() -> Vec<Liquid> {
    vec![Liquid::new("water", 1000.0)]
}

/// Lengths in spacings.
fn block(from: [f64; 2], to: [f64; 2]) -> Block {
    Block { jitter: 0.1, ..Block::new("water", from.map(|x| x * SPACING), to.map(|x| x * SPACING)) }
}

fn tank(from: [f64; 2], to: [f64; 2]) -> Tank {
    Tank::new(from.map(|x| x * SPACING), to.map(|x| x * SPACING))
}

fn rest(x: f64) -> Scene {
    let (block, tank) = (block([x, 0.0], [x + 24.0, 24.0]), tank([x, 0.0], [x + 24.0, 48.0]));
    Scene { block: vec![block], tank: vec![tank], ..fixed(water()) }
}

fn dam_break(x: f64) -> Scene {
    let (block, tank) = (block([x, 0.0], [x + 20.0, 40.0]), tank([x, 0.0], [x + 80.0, 80.0]));
    Scene { block: vec![block], tank: vec![tank], ..fixed(water()) }
}

/// Two drops of unequal mass, one off the line of the other.
fn drops(x: f64) -> Scene {
    let drop = |material: &str, center: [f64; 2], velocity: [f64; 2]| Disc {
        material: material.to_owned(),
        center: center.map(|x| x * SPACING),
        radius: 8.0 * SPACING,
        velocity,
        jitter: 0.1,
        temperature: 0.0,
    };
    Scene {
        gravity: [0.0; 2],
        disc: vec![drop("heavy", [x, 0.0], [1.5, 0.5]), drop("light", [x + 20.0, 7.0], [-1.5, 0.2])],
        ..fixed(vec![Liquid::new("heavy", 1000.0), Liquid::new("light", 400.0)])
    }
}

/// The same dam break at both ends of a wide domain, the other one mirrored.
fn both_ends(_: f64) -> Scene {
    Scene {
        block: vec![block([0.0, 0.0], [20.0, 40.0]), block([FAR - 20.0, 0.0], [FAR, 40.0])],
        tank: vec![tank([0.0, 0.0], [FAR, 80.0])],
        ..fixed(water())
    }
}

/// One line per reading, exact.
pub fn lines(readings: &[Reading]) -> String {
    readings.iter().fold(String::new(), |mut text, r| {
        let _ = writeln!(text, "{};{:e};{:e};{:e};{:e};{:e}", r.scene, r.mean, r.momentum, r.angular, r.energy, r.gain);
        text
    })
}

/// Reads what [`lines`] wrote.
pub fn parse(text: &str) -> Option<Vec<Reading>> {
    let reading = |line: &str| {
        let mut words = line.split(';');
        let scene = words.next()?.to_owned();
        let mut number = || words.next()?.parse::<f64>().ok();
        Some(Reading {
            scene,
            mean: number()?,
            momentum: number()?,
            angular: number()?,
            energy: number()?,
            gain: number()?,
        })
    };
    text.lines().map(reading).collect()
}

/// The readings of the f64 build, which Cargo makes and runs.
///
/// # Errors
/// When it cannot be built or fails.
pub fn measure_double() -> Result<Vec<Reading>, Failure> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let features = ["--no-default-features", "--features", "f64"];
    let arguments = ["run", "--quiet", "--manifest-path", manifest, "--example", "precision"];
    let output =
        Command::new(cargo).args(arguments).args(features).output().map_err(|error| Failure(error.to_string()))?;
    let readings = String::from_utf8(output.stdout).ok().filter(|_| output.status.success());
    readings
        .and_then(|text| parse(&text))
        .ok_or_else(|| Failure(format!("the f64 build fails: {}", String::from_utf8_lossy(&output.stderr))))
}

/// The body of the section.
pub fn section(single: &[Reading], double: &[Reading]) -> String {
    let mut text = format!("Made by `cargo run --release -p unipbd-validation -- --precision`, {}: ", stamp());
    text.push_str(
        "the same scenes in f32, the build that ships, and by `unipbd-core-f64`, at 8 substeps. Mean C is taken over particles and frames; momentum is \
         its change over the sum of m |v| at the start, angular momentum likewise; energy is its change from start to \
         end. The spacing is 1/8 m, so that walls and lattices lie at the same places in both.\n\n\
         At 1e5 dx a position in f32 is rounded to 0.008 dx. From 4096 dx on the density is therefore summed over \
         positions from the middle of all particles, with the digits that rounding keeps out of the columns, from the first \
         places on: without that mean C was 3 % lower at 1e5 dx and that of the drops 12 %. Two tanks far apart have no \
         middle that is near both. Walls still see the rounded positions. The angular \
         momentum changes alike in both, with the length of a substep: forces act along the lines between predicted \
         positions.\n\n\
         | scene | mean C, f32 | f64 | f32 over f64 | momentum, f32 | f64 | angular, f32 | f64 | energy, f32 | f64 |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    let small = |value: f64| if value.is_nan() { "walls".to_owned() } else { format!("{value:.1e}") };
    for (s, d) in single.iter().zip(double) {
        let _ = writeln!(
            text,
            "| {} | {:.4e} | {:.4e} | {:.4} | {} | {} | {} | {} | {:+.3} % | {:+.3} % |",
            s.scene,
            s.mean,
            d.mean,
            s.mean / d.mean,
            small(s.momentum),
            small(d.momentum),
            small(s.angular),
            small(d.angular),
            100.0 * s.energy,
            100.0 * d.energy
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_come_back_from_their_lines() {
        let reading =
            Reading { scene: "a b".to_owned(), mean: 0.1, momentum: 1e-17, angular: 2.0, energy: -0.25, gain: 0.0 };
        assert_eq!(parse(&lines(&[reading.clone(), reading.clone()])), Some(vec![reading.clone(), reading]));
        assert_eq!(parse("nonsense"), None);
    }
}
