//! The command of the suite.

use std::ops::Range;
use std::path::Path;
use std::process::ExitCode;

use unipbd_core::scene::{GradientPoint, LegacyKernel, PressureGridUse, SolverSettings, Substeps};
use unipbd_validation::case::Trial;
use unipbd_validation::document::{with_introduction, with_section};
use unipbd_validation::plan::{Line, lines};
use unipbd_validation::report::{Entry, with_notes};
use unipbd_validation::stress::map::MAPS;
use unipbd_validation::stress::{
    Ending, NAMED, Quiet, chart, endure_random, fuzz, quiet, random_scene, shrink, summary,
};
use unipbd_validation::{cases, precision, report, sweep};

const HELP: &str =
    "usage: unipbd-validation [--quick | --full [CASE...] | --sweep [--full] [CASE...] | --stress [--full] | --fuzz FROM TO | --map | --precision | CASE [RESOLUTION] [SETTING=VALUE...]]
  --quick   every case at its quick size (default)
  --full    every case at three resolutions and three targets, or those named; writes docs/accuracy.md; a line that
            fails makes the command fail
  --sweep   run time against error for four cases, or those named; writes docs/accuracy/*.csv and *.svg
  --stress  scenes that ask too much, a pool at rest for 20,000 steps (a million with --full), and 100 random
            scenes (2000 with --full); one that breaks is shrunk and kept
  --fuzz FROM TO  the random scenes of these seeds, every second of them with the pressure grid: the even ones
  --map     what is stable: density ratio, depth and speed against substeps; its part of docs/accuracy.md and
            docs/images/stability.svg (--full does it too)
  --precision  f32 against f64 (built by cargo); its part of docs/accuracy.md (--full does it too)
  CASE      one case; settings are target, substeps, iterations, tolerance, kernel, kernel_radius, relaxation, shifting,
            gradients, constraint_mixing, artificial_pressure";

/// Scenes that once broke.
const REGRESSIONS: &str = "crates/unipbd-validation/regressions";
/// The accuracy sheet.
const SHEET: &str = "docs/accuracy.md";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let done = if has("--help") {
        println!("{HELP}");
        Ok(true)
    } else if has("--fuzz") {
        seeds(&arguments).map(fuzz_all)
    } else if has("--stress") {
        Ok(if has("--full") { run_stress(2000, 1_000_000) } else { run_stress(100, 20_000) })
    } else if has("--map") {
        run_map()
    } else if has("--precision") {
        run_precision()
    } else if has("--sweep") {
        run_sweeps(has("--full"), &arguments)
    } else if has("--full") {
        run_full(&arguments)
    } else if let Some(name) = arguments.first().filter(|name| *name != "--quick") {
        run_one(name, &arguments[1..])
    } else {
        Ok(run_quick())
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn show(entry: &Entry) {
    println!("{}: {}", entry.line, entry.verdict());
    let Ok(outcome) = &entry.result else { return };
    for figure in &outcome.figures {
        let mark = if figure.holds() { " " } else { "!" };
        println!("  {mark} {}: {:.5e} ({})", figure.what, figure.value, figure.band);
    }
    println!(
        "    {} particles, {} substeps, {:.2} s, {:.2e} pair visits",
        outcome.cost.particles,
        outcome.cost.substeps,
        outcome.cost.wall.as_secs_f64(),
        outcome.cost.pair_visits
    );
}

fn run_quick() -> bool {
    let entries = cases::ALL.iter().map(|case| Entry::run(Line::quick(case)));
    entries.inspect(show).filter(|entry| entry.verdict() != "holds").count() == 0
}

fn run_one(name: &str, rest: &[String]) -> Result<bool, Box<dyn std::error::Error>> {
    let case = cases::find(name).ok_or_else(|| {
        let names: Vec<&str> = cases::ALL.iter().map(|case| case.name).collect();
        format!("there is no case \"{name}\"; the cases are {}", names.join(", "))
    })?;
    let mut trial = Trial::new(case.quick, SolverSettings::default());
    for argument in rest {
        match argument.split_once('=') {
            None => trial.resolution = argument.parse()?,
            Some((key, value)) => set(&mut trial, key, value)?,
        }
    }
    let (resolution, target) = (trial.resolution, trial.solver.target_compression);
    let line = Line { case, resolution, target, grid: trial.solver.pressure_grid != PressureGridUse::Off };
    let entry = Entry { line, result: case.run_trial(&trial) };
    show(&entry);
    Ok(entry.verdict() == "holds")
}

fn grid_use(word: &str) -> Result<PressureGridUse, String> {
    match word {
        "auto" => Ok(PressureGridUse::Auto),
        "on" => Ok(PressureGridUse::On),
        "off" => Ok(PressureGridUse::Off),
        _ => Err(format!("pressure_grid is \"auto\", \"on\" or \"off\", not \"{word}\"")),
    }
}

/// Sets a key of the solver, or an option for comparison.
fn set(trial: &mut Trial, key: &str, value: &str) -> Result<(), Box<dyn std::error::Error>> {
    let (solver, legacy) = (&mut trial.solver, &mut trial.legacy);
    match key {
        "target" => solver.target_compression = value.parse()?,
        "substeps" => solver.substeps = Substeps::Fixed(value.parse()?),
        "iterations" => solver.iterations = value.parse()?,
        "tolerance" => solver.tolerance = value.parse()?,
        "pressure_grid" => solver.pressure_grid = grid_use(value)?,
        "kernel_radius" => solver.kernel_radius = value.parse()?,
        "shifting" => solver.shifting = Some(value.parse()?),
        "relaxation" => solver.relaxation = Some(value.parse()?),
        "constraint_mixing" => legacy.constraint_mixing = value.parse()?,
        "artificial_pressure" => legacy.artificial_pressure = value.parse()?,
        "gradients" => {
            solver.gradients = Some(match value {
                "start" => GradientPoint::Start,
                "early" => GradientPoint::Early,
                "predicted" => GradientPoint::Predicted,
                _ => return Err("gradients are start, early or predicted".into()),
            });
        }
        "kernel" => {
            legacy.kernel = match value {
                "wendland_c2" => LegacyKernel::WendlandC2,
                "cubic_spline" => LegacyKernel::CubicSpline,
                "poly6_spiky" => LegacyKernel::Poly6Spiky,
                _ => return Err("kernels are wendland_c2, cubic_spline, poly6_spiky".into()),
            };
        }
        _ => return Err(format!("there is no setting {key}").into()),
    }
    Ok(())
}

/// Writes the section of a case as soon as it is measured: a run that is cut off leaves what it has.
fn run_full(arguments: &[String]) -> Result<bool, Box<dyn std::error::Error>> {
    std::fs::create_dir_all("docs")?;
    let names = names(arguments);
    let mut failed = Vec::new();
    for case in cases::ALL.iter().filter(|case| names.is_empty() || names.contains(&case.name)) {
        let entries: Vec<Entry> = lines(case).into_iter().map(Entry::run).inspect(show).collect();
        if let Some((heading, body)) = report::section(&entries) {
            write_section(&heading, &body)?;
        }
        let fails = |entry: &&Entry| entry.result.is_err();
        failed.extend(entries.iter().filter(fails).map(|entry| format!("{}: {}", entry.line, entry.verdict())));
    }
    if names.is_empty() {
        let charts = sweep::NORMS.iter().map(|norm| format!("accuracy/{}.svg", norm.picture));
        let charts: Vec<String> = charts.filter(|path| Path::new("docs").join(path).exists()).collect();
        write_section(report::CHARTS, &report::charts_section(&charts))?;
        run_precision()?;
        run_map()?;
    }
    failed.iter().for_each(|line| eprintln!("{line}"));
    Ok(failed.is_empty())
}

/// The arguments that are no flags.
fn names(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).filter(|argument| !argument.starts_with("--")).collect()
}

/// Runs the same scenes in f32 and f64; writes the section of the sheet.
fn run_precision() -> Result<bool, Box<dyn std::error::Error>> {
    let body = precision::section(&precision::measure()?, &precision::measure_double()?);
    println!("{body}");
    write_section(precision::HEADING, &body)?;
    Ok(true)
}

/// Surveys all maps; writes the picture and the section of the sheet.
fn run_map() -> Result<bool, Box<dyn std::error::Error>> {
    let surveyed: Vec<chart::Surveyed<'_>> = MAPS
        .iter()
        .map(|map| {
            let row = |value: &f64| {
                let cells = map.row(*value);
                println!("{} {value}: {cells:?}", map.name);
                cells
            };
            (map, map.rows.iter().map(row).collect())
        })
        .collect();
    let picture = Path::new("docs").join(chart::PICTURE);
    picture.parent().map_or(Ok(()), std::fs::create_dir_all)?;
    std::fs::write(picture, chart::picture(&surveyed))?;
    write_section(chart::HEADING, &chart::section(&surveyed))?;
    Ok(true)
}

/// Puts a section into the sheet, and the introduction and notes as they are now; the rest of it stays.
fn write_section(heading: &str, body: &str) -> std::io::Result<()> {
    let document = std::fs::read_to_string(SHEET).unwrap_or_default();
    let document = with_section(&with_introduction(&document, report::INTRODUCTION), heading, body);
    std::fs::write(SHEET, with_notes(&document))
}

fn run_sweeps(full: bool, arguments: &[String]) -> Result<bool, Box<dyn std::error::Error>> {
    std::fs::create_dir_all("docs/accuracy")?;
    let names = names(arguments);
    for (case, resolution) in sweep::cases(full) {
        if !names.is_empty() && !names.contains(&case.name) {
            continue;
        }
        let swept = sweep::sweep(case, resolution, |line| println!("{line}"));
        for norm in sweep::NORMS.iter().filter(|norm| norm.case == case.name) {
            let (curves, rows) = swept.curves(norm);
            print!("{rows}");
            std::fs::write(format!("docs/accuracy/{}.csv", norm.picture), sweep::HEADER.to_owned() + &rows)?;
            std::fs::write(format!("docs/accuracy/{}.svg", norm.picture), sweep::picture(norm, &curves))?;
        }
    }
    Ok(true)
}

/// Shrinks a scene that breaks and writes it where the tests find it.
fn keep(seed: u64, what: &str) {
    let small = shrink(&random_scene(seed), |scene| !endure_random(scene).is_good());
    let path = Path::new(REGRESSIONS).join(format!("seed_{seed}.toml"));
    let text = toml::to_string(&small).map_err(std::io::Error::other);
    match text.and_then(|text| std::fs::write(&path, format!("# Seed {seed}: {what}\n{text}"))) {
        Ok(()) => println!("    shrunk to {}: {}", path.display(), summary(&small)),
        Err(error) => println!("    {}: {error}", path.display()),
    }
}

fn run_stress(scenes: u64, steps: u64) -> bool {
    let quiet = quiet(steps);
    let mut good = quiet.as_ref().is_ok_and(Quiet::is_good);
    println!("a pool at rest: {quiet:?}");
    for stress in NAMED {
        let ending = (stress.run)();
        good &= ending.is_good();
        println!("{}: {ending:?}", stress.name);
    }
    fuzz_all(0..scenes) && good
}

/// The seeds between two numbers.
fn seeds(arguments: &[String]) -> Result<Range<u64>, Box<dyn std::error::Error>> {
    match &arguments[1..] {
        [from, to] => Ok(from.parse()?..to.parse()?),
        _ => Err("--fuzz takes two seeds".into()),
    }
}

/// Runs random scenes; those that break are shrunk and kept.
fn fuzz_all(seeds: Range<u64>) -> bool {
    let counts = fuzz(seeds, |seed, ending| {
        if let Ending::Broken(what) = ending {
            println!("seed {seed}: {what}\n    {}", summary(&random_scene(seed)));
            keep(seed, what);
        }
    });
    println!(
        "random scenes: {} sound, {} refused, {} stopped, {} broken",
        counts.sound,
        counts.refused,
        counts.stopped.len(),
        counts.broken.len()
    );
    counts
        .stopped
        .iter()
        .for_each(|(seed, error)| println!("seed {seed} stopped: {error}\n    {}", summary(&random_scene(*seed))));
    counts.broken.is_empty()
}
