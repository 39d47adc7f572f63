//! A solitary wave that runs along a channel.

use unipbd_core::Solver;
use unipbd_core::math::Vector64;
use unipbd_core::scene::{Points, Scene};

use crate::case::{Band, Case, Figure, Measured, Trial};
use crate::exact::SolitaryWave;
use crate::runner::{Failure, energy, points};
use crate::scenes::{GRAVITY, SPACING, pool};

/// A channel `resolution` spacings deep.
pub const SOLITARY_WAVE: Case = Case {
    name: "solitary_wave",
    truth: "Grimshaw 1971: a solitary wave of a fifth of the depth keeps its crest and runs at c; over 20 depths",
    quick: 12,
    full: &[12, 20, 30],
    targets: &[0.01],
    run: solitary_wave,
};

/// Height of the crest over the depth.
const CREST: f64 = 0.2;
/// Where the crest starts and ends, and the length of the channel \[depths].
const START: f64 = 10.0;
const END: f64 = 30.0;
const CHANNEL: f64 = 40.0;

fn solitary_wave(trial: &Trial) -> Result<Measured, Failure> {
    let depth = f64::from(trial.resolution) * SPACING;
    let (wave, unit) = (SolitaryWave { crest: CREST }, (GRAVITY * depth).sqrt());
    let place = |x: Vector64| Vector64::new(x.x / depth - START, x.y / depth);
    let mut run = trial.start(&filled(trial, depth, wave))?;
    run.stir(|x| wave.velocity(place(x)) * unit)?;
    let (first, before) = (crest(&run.solver, depth, START), energy(&run.solver));
    let time = (END - START) * depth / (wave.speed() * unit);
    let (mut highest, mut last) = (0.0f64, first);
    let frames = (60.0 * time).round() as u32;
    run.frames(frames, |solver| {
        let expected = START + wave.speed() * unit * solver.time() / depth;
        last = crest(solver, depth, expected);
        highest = highest.max(last.1 / first.1);
    })?;
    let run_so_far = wave.speed() * unit * run.solver.time() / depth;
    // At rest the water of the channel is this deep.
    let level = points(&run.solver).count() as f64 * SPACING * SPACING / (CHANNEL * depth);
    let still = 0.5 * 1000.0 * GRAVITY * CHANNEL * depth * level * level;
    let lost = 1.0 - (energy(&run.solver) - still) / (before - still);
    let figures = vec![
        Figure::new("height of the crest over that of the start", last.1 / first.1, trial.with_grid(BAND)),
        Figure::new("highest crest over that of the start", highest, Band::OPEN),
        Figure::new("speed error", (last.0 - first.0) / run_so_far - 1.0, Band::OPEN),
        Figure::new("crest of the start over the exact one", first.1 / CREST, Band::OPEN),
        Figure::new("energy of the wave lost", lost, Band::OPEN),
    ];
    Ok((figures, run.cost))
}

/// The band allowed for the height of the crest.
const BAND: Band = Band::between(0.92, 1.01);

/// The channel with the wave in it: a pool whose columns are drawn together and stretched where the wave is high, so that
/// each particle keeps its area.
fn filled(trial: &Trial, depth: f64, wave: SolitaryWave) -> Scene {
    let cells = f64::from(trial.resolution);
    let length = CHANNEL * cells;
    let step = 1e-3;
    let (mut positions, mut x, mut area, mut column) = (Vec::new(), 0.0, 0.0, 0.5);
    while x < CHANNEL {
        let height = 1.0 + wave.height(x - START);
        area += step * height;
        if area * cells >= column {
            let rows = (0..trial.resolution).map(|row| (f64::from(row) + 0.5) / cells * height);
            positions.extend(rows.map(|y| [x * depth, y * depth]));
            column += 1.0;
        }
        x += step;
    }
    let water = Points {
        material: "water".to_owned(),
        positions,
        velocity: [0.0; 2],
        velocities: Vec::new(),
        temperature: 0.0,
        motion: Default::default(),
    };
    Scene { block: Vec::new(), points: vec![water], ..pool((length, cells), length, trial) }
}

/// Place of the crest near an expected one, and its height \[depths].
fn crest(solver: &Solver, depth: f64, near: f64) -> (f64, f64) {
    let steps = (-150..=150).map(|step| near + 0.01 * f64::from(step));
    let heights = steps.map(|x| (x, height(solver, depth, x)));
    heights.fold((near, f64::MIN), |highest, here| if here.1 > highest.1 { here } else { highest })
}

/// Half the width over which heights are averaged \[depths].
const WINDOW: f64 = 0.8;

/// Mean height of the surface around a place, over the depth: area of the water by a smooth window \[depths].
fn height(solver: &Solver, depth: f64, place: f64) -> f64 {
    let part = |x: Vector64| {
        let away = (x.x / depth - place) / WINDOW;
        if away.abs() < 1.0 { 0.5 * (1.0 + (std::f64::consts::PI * away).cos()) } else { 0.0 }
    };
    points(solver).map(part).sum::<f64>() * SPACING * SPACING / (WINDOW * depth * depth) - 1.0
}
