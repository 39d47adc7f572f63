//! Every scene of the repository with fluids, by particles alone and with the pressure grid.
//!
//! `cargo run --release -p unipbd-benches --bin plain_and_grid [scenes ...]` measures on this machine and writes
//! `docs/plain_and_grid.md`.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use unipbd_core::scene::{PressureGridUse, Scene, SolverSettings};
use unipbd_validation::Runner;
use unipbd_validation::stamp::{machine, stamp};

/// Of each scene this long is run, at most \[s].
const LONGEST: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let given: Vec<PathBuf> = std::env::args().skip(1).map(PathBuf::from).collect();
    let scenes = if given.is_empty() { shipped(&root.join("scenes"))? } else { given };
    let mut rows = Vec::new();
    for path in scenes {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let scene = unipbd_scene_file::load(&path, &[])?.scene.into_scene();
        if scene.materials().any(|material| material.phase().is_fluid()) {
            let row = Row::measure(name, &scene)?;
            eprint!("{row}");
            rows.push(row);
        }
    }
    let rows: String = rows.iter().map(Row::to_string).collect();
    let page = format!("{INTRODUCTION}\nMeasured {}, on {}.\n\n{HEAD}\n{rows}", stamp(), machine());
    std::fs::write(root.join("docs/plain_and_grid.md"), page)?;
    Ok(())
}

/// The scene files of a folder, by name.
fn shipped(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    Ok(paths)
}

/// A scene, both ways.
struct Row {
    name: String,
    particles: usize,
    plain: Run,
    grid: Run,
    /// Whether the scene as it is uses the grid, and why.
    auto: String,
}

/// What one run took and gave, over all its frames.
struct Run {
    processor: f64,
    substeps: f64,
    error: f64,
}

impl Row {
    fn measure(name: String, scene: &Scene) -> Result<Row, Box<dyn Error>> {
        let (plain, _) = run(scene, PressureGridUse::Off)?;
        let (grid, particles) = run(scene, PressureGridUse::On)?;
        let choice = scene.pressure_grid();
        let auto = format!("{}: {}", if choice.used { "on" } else { "off" }, choice.reason);
        Ok(Row { name, particles, plain, grid, auto })
    }
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Row { name, particles, plain, grid, auto } = self;
        let (time, error) = (plain.processor / grid.processor, plain.error / grid.error);
        let mut line = String::new();
        write!(line, "| {name} | {particles} | {:.2} | {:.2} | {time:.2} ", plain.processor, grid.processor)?;
        write!(line, "| {:.1} | {:.1} ", plain.substeps, grid.substeps)?;
        write!(line, "| {:.2} % | {:.2} % | {:.2} | {auto} |", 100.0 * plain.error, 100.0 * grid.error, time * error)?;
        writeln!(f, "{line}")
    }
}

/// Runs the first seconds of a scene; also says how many particles there are at the end.
fn run(scene: &Scene, pressure_grid: PressureGridUse) -> Result<(Run, usize), Box<dyn Error>> {
    let solver = SolverSettings { pressure_grid, ..scene.solver.clone() };
    let mut runner = Runner::new(&Scene { solver, ..scene.clone() })?;
    let frames = (scene.duration.min(LONGEST) * scene.fps).round();
    let mut error = 0.0;
    runner.frames(frames as u32, |solver| error += solver.diagnostics().density_error_mean_abs / frames)?;
    let cost = runner.cost;
    Ok((
        Run { processor: cost.processor.as_secs_f64(), substeps: cost.substeps as f64 / frames, error },
        cost.particles,
    ))
}

const INTRODUCTION: &str = "\
# Particles alone and with the pressure grid

Written by `cargo run --release -p unipbd-benches --bin plain_and_grid`; do not edit by hand.

The first two seconds of every scene of the repository that has a fluid, once with `solver.pressure_grid = \"off\"` and
once with `\"on\"`, on one thread and otherwise as the file says: processor time of the steps, substeps per frame, and the
mean of |C| over particles and frames. C = rho/rho0 - 1 is that of the solver's own kernel; at a free surface it counts
what is missing there, so jets and spray make it large both ways. As error falls with the number of substeps, one figure
weighs both: the ratio of times multiplied by that of errors, above 1 where the grid is better. What the density does
not show is not in it: [how fast liquids exchange, sink and swirl](accuracy.md).

The last column says what `\"auto\"` does with the scene, and why.
";

const HEAD: &str = "\
| scene | particles | alone [s] | grid [s] | ratio | substeps alone | grid | mean of abs. C alone | grid | both | auto |
|---|---|---|---|---|---|---|---|---|---|---|";
