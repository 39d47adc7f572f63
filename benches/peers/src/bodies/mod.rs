//! Heaps and a pyramid of bodies in several engines: one thread, no sleep, 60 frames a second.

mod box2d;
mod penetration;
mod rapier;
mod table;
mod unipbd;

use cpu_time::ProcessTime;
use penetration::Penetration;

pub use table::{heap_section, pyramid_section};

/// Side of a box and diameter of a disc [m].
const SIZE: f64 = 0.5;
/// Frames per second.
const FPS: f64 = 60.0;
/// Friction of everything.
const FRICTION: f64 = 0.5;
/// Density of the bodies [kg/m^2].
const DENSITY: f64 = 1000.0;
/// Gravity, downwards [m/s^2].
const GRAVITY: f64 = 9.81;

#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Discs,
    Boxes,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Kind::Discs => "discs",
            Kind::Boxes => "boxes",
        }
    }

    /// Mass of a body [kg].
    fn mass(self) -> f64 {
        let area = match self {
            Kind::Boxes => SIZE * SIZE,
            Kind::Discs => std::f64::consts::PI * SIZE * SIZE / 4.0,
        };
        DENSITY * area
    }
}

/// Where a body is.
#[derive(Clone, Copy)]
pub struct Pose {
    pub place: [f64; 2],
    /// [rad]
    pub angle: f64,
}

/// What every engine is given.
pub struct Setup {
    kind: Kind,
    places: Vec<[f64; 2]>,
    /// Distance of two upright walls, the left one at 0; without, there is a floor alone [m].
    width: Option<f64>,
}

impl Setup {
    /// Bodies over the floor of a tank, let fall.
    fn heap(kind: Kind, count: usize) -> Setup {
        let columns = (count as f64 / 2.0).sqrt().round() as usize * 2;
        let pitch = 1.1 * SIZE;
        let at = |k: usize| {
            let (column, row) = (k % columns, k / columns);
            // Every second row is shifted, so that columns do not stay upright.
            let shift = if row % 2 == 0 { 0.0 } else { 0.3 * SIZE };
            [(column as f64 + 0.6) * pitch + shift, (row as f64 + 0.6) * pitch]
        };
        Setup { kind, places: (0..count).map(at).collect(), width: Some(columns as f64 * pitch + 2.0 * SIZE) }
    }

    /// A pyramid of boxes of this many rows on the floor.
    fn pyramid(rows: usize) -> Setup {
        let row = |row: usize| {
            let across = rows - row;
            let at = move |k: usize| 1.05 * SIZE * (k as f64 - 0.5 * (across - 1) as f64);
            (0..across).map(move |k| [at(k), SIZE * (row as f64 + 0.5)])
        };
        Setup { kind: Kind::Boxes, places: (0..rows).flat_map(row).collect(), width: None }
    }
}

/// An engine with a setup in it.
pub trait Engine {
    /// Its name and settings.
    fn name(&self) -> String;
    /// Advances by a frame.
    fn step(&mut self);
    /// Where a body is, by its place in the setup.
    fn pose(&self, body: usize) -> Pose;
}

/// What came of one engine.
pub struct Run {
    pub name: String,
    /// Processor time per frame: mean over the whole run [ms].
    pub milliseconds: f64,
    /// Overlaps at the end.
    pub penetration: Penetration,
    /// Whether the last body stayed where it was put.
    pub stands: bool,
}

/// A run in progress.
struct Timed {
    engine: Box<dyn Engine>,
    seconds: f64,
    frames: u32,
}

impl Timed {
    fn new(engine: Box<dyn Engine>) -> Timed {
        Timed { engine, seconds: 0.0, frames: 0 }
    }

    fn step(&mut self) {
        let begin = ProcessTime::now();
        self.engine.step();
        self.seconds += begin.elapsed().as_secs_f64();
        self.frames += 1;
    }

    /// How far the last body is from its place [m].
    fn lean(&self, setup: &Setup) -> f64 {
        let last = setup.places.len() - 1;
        let (now, start) = (self.engine.pose(last).place, setup.places[last]);
        (now[0] - start[0]).abs().max((now[1] - start[1]).abs())
    }

    /// Fails where a body is nowhere.
    fn done(self, setup: &Setup) -> Result<Run, String> {
        let poses: Vec<Pose> = (0..setup.places.len()).map(|body| self.engine.pose(body)).collect();
        let finite = |pose: &Pose| pose.place.iter().chain([&pose.angle]).all(|number| number.is_finite());
        if !poses.iter().all(finite) {
            return Err(format!("{}: a body is nowhere", self.engine.name()));
        }
        Ok(Run {
            name: self.engine.name(),
            milliseconds: 1e3 * self.seconds / f64::from(self.frames),
            penetration: penetration::measure(setup, &poses),
            stands: self.lean(setup) <= 0.5 * SIZE,
        })
    }
}

/// Runs engines frame by frame in turn, so that a slow moment of the machine hits all of them.
fn together(setup: &Setup, engines: Vec<Box<dyn Engine>>, seconds: f64) -> Result<Vec<Run>, String> {
    let mut runs: Vec<Timed> = engines.into_iter().map(Timed::new).collect();
    for _ in 0..(seconds * FPS) as u32 {
        runs.iter_mut().for_each(Timed::step);
    }
    runs.into_iter().map(|run| run.done(setup)).collect()
}

/// Runs an engine until its last body falls, or the time is over.
fn alone(setup: &Setup, engine: Box<dyn Engine>, seconds: f64) -> Result<Run, String> {
    let mut run = Timed::new(engine);
    for _ in 0..(seconds * FPS) as u32 {
        run.step();
        if run.lean(setup) > 0.5 * SIZE {
            break;
        }
    }
    run.done(setup)
}
