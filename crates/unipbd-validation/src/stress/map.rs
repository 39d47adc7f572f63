//! The map of what is stable: density ratio, depth and speed, each against the number of substeps.

use unipbd_core::scene::{Block, Liquid, Scene, SolverSettings, Substeps, Tank};
use unipbd_core::{BuildOptions, Solver};

use super::unsound;
use crate::runner::energy;

/// Energy may grow by this part of that of the start.
pub const GAIN: f64 = 0.005;
/// Rest distance of all maps \[m]; frames take 1/60 s.
const SPACING: f64 = 0.1;

/// Result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Most substeps of a frame.
    pub substeps: u32,
    /// Largest density error C seen after a frame.
    pub worst: f64,
    /// Largest growth of the energy over that of the start, as a part of it.
    pub gain: f64,
    /// The failure that broke or stopped the run, if any.
    pub broken: Option<String>,
}

impl Cell {
    /// Finite, contained, and with energy that never grows.
    pub fn is_sound(&self) -> bool {
        self.broken.is_none() && self.gain <= GAIN
    }
}

/// One table: scenes by rows, substeps per frame by columns, `auto` as the last one.
pub struct Map {
    /// The quantity that changes from row to row.
    pub name: &'static str,
    /// The scene of all rows.
    pub setup: &'static str,
    /// The values of the rows.
    pub rows: &'static [f64],
    /// Frames of each run.
    pub frames: u32,
    scene: fn(f64, SolverSettings) -> Scene,
}

/// Substeps per frame of the columns before `auto`.
pub const SUBSTEPS: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// The maps.
pub const MAPS: [Map; 3] = [
    Map {
        name: "density ratio",
        setup: "5 dx of the heavy liquid on top of 5 dx of the light one, 16 dx wide, 1 s",
        rows: &[1.0, 2.0, 10.0, 100.0, 1000.0],
        frames: 60,
        scene: heavy_on_top,
    },
    Map {
        name: "depth [dx]",
        setup: "water at rest in a tank 8 dx wide, 2 s",
        rows: &[10.0, 30.0, 100.0, 300.0],
        frames: 120,
        scene: deep,
    },
    Map {
        name: "speed [dx per frame]",
        setup: "water in half of a closed tank of 16 x 16 dx, thrown at its far wall, 1 s",
        rows: &[0.0, 1.0, 10.0, 100.0, 1000.0],
        frames: 60,
        scene: thrown,
    },
];

impl Map {
    /// Runs one cell.
    pub fn cell(&self, row: f64, substeps: Substeps) -> Cell {
        // `auto` may take what it asks for up to 64.
        let solver = SolverSettings { substeps, max_substeps: 64, ..SolverSettings::default() };
        survey(&(self.scene)(row, solver), self.frames)
    }

    /// Runs all cells of a row: the fixed numbers, then `auto`.
    pub fn row(&self, row: f64) -> Vec<Cell> {
        let fixed = SUBSTEPS.into_iter().map(Substeps::Fixed);
        fixed.chain([Substeps::Auto]).map(|substeps| self.cell(row, substeps)).collect()
    }
}

/// Runs a scene to its end, or to where it breaks.
pub fn survey(scene: &Scene, frames: u32) -> Cell {
    let mut cell = Cell { substeps: 0, worst: 0.0, gain: f64::NEG_INFINITY, broken: None };
    let options = BuildOptions { threads: Some(1), ..BuildOptions::default() };
    let mut solver = match scene.build(options) {
        Ok(solver) => solver,
        Err(problems) => {
            cell.broken = Some(format!("refused: {problems:?}"));
            return cell;
        }
    };
    let start = energy(&solver);
    for _ in 0..frames {
        cell.broken = step(&mut solver, scene, &mut cell.substeps).err();
        if cell.broken.is_some() {
            return cell;
        }
        cell.worst = cell.worst.max(solver.diagnostics().density_error_max);
        cell.gain = cell.gain.max(energy(&solver) / start - 1.0);
    }
    cell
}

fn step(solver: &mut Solver, scene: &Scene, most: &mut u32) -> Result<(), String> {
    let report = solver.step_frame().map_err(|error| format!("stops: {error}"))?;
    *most = (*most).max(report.substeps);
    unsound(solver, scene).map_or(Ok(()), Err)
}

fn scene(solver: SolverSettings, width: f64, height: f64) -> Scene {
    let tank = Tank::new([0.0, 0.0], [width * SPACING, height * SPACING]);
    Scene { spacing: SPACING, solver, tank: vec![Tank { open: Vec::new(), ..tank }], ..Scene::default() }
}

fn block(material: &str, from: [f64; 2], to: [f64; 2]) -> Block {
    Block::new(material, from.map(|x| x * SPACING), to.map(|x| x * SPACING))
}

fn heavy_on_top(ratio: f64, solver: SolverSettings) -> Scene {
    Scene {
        liquid: vec![Liquid::new("light", 1.0), Liquid::new("heavy", ratio)],
        block: vec![block("light", [0.0, 0.0], [16.0, 5.0]), block("heavy", [0.0, 5.0], [16.0, 10.0])],
        ..scene(solver, 16.0, 16.0)
    }
}

fn deep(depth: f64, solver: SolverSettings) -> Scene {
    Scene {
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![block("water", [0.0, 0.0], [8.0, depth])],
        ..scene(solver, 8.0, 1.5 * depth)
    }
}

fn thrown(speed: f64, solver: SolverSettings) -> Scene {
    let mut water = block("water", [0.0, 0.0], [8.0, 16.0]);
    water.velocity = [speed * SPACING * 60.0, 0.0];
    Scene { liquid: vec![Liquid::new("water", 1000.0)], block: vec![water], ..scene(solver, 16.0, 16.0) }
}
