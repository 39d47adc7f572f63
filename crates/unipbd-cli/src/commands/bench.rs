//! `bench`: how long a scene takes, by stage and number of threads.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use unipbd_core::{BuildOptions, SolverError};

use super::scene::load;
use crate::args::BenchArgs;
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::report::format::{bytes, count, plural};
use crate::report::{Console, Form};
use crate::scene_file::LoadedScene;
use crate::simulation::{Simulation, title};

/// Frames in a row of one number of threads: a pool that waits for the others between any two is not what users see.
const ROUND: u64 = 10;

pub(super) fn bench(arguments: &BenchArgs, console: Console) -> Result<Exit, Failure> {
    let loaded = load(&arguments.scene, &arguments.changes)?;
    interrupt::listen();
    let threads = thread_counts(&arguments.threads);
    let mut runs = threads.iter().map(|&threads| Timed::new(&loaded, threads)).collect::<Result<Vec<_>, _>>()?;
    let frames = arguments.frames;
    if !step_in_rounds(&mut runs, arguments.warm_up)? {
        return Ok(interrupt::requested().unwrap_or(Exit::Interrupted));
    }
    runs.iter_mut().for_each(Timed::start);
    if !step_in_rounds(&mut runs, frames)? {
        return Ok(interrupt::requested().unwrap_or(Exit::Interrupted));
    }
    let results: Vec<Measured> = runs.iter().map(Timed::measured).collect();
    match console.form {
        Form::Json => {
            for result in &results {
                console.object(&result.object(&title(&loaded.scene, &loaded.path), frames, &results[0]))?;
            }
        }
        Form::Text => console.line(text(&title(&loaded.scene, &loaded.path), frames, &results))?,
    }
    Ok(Exit::Success)
}

/// Steps all runs by so many frames, in turn; false if interrupted.
fn step_in_rounds(runs: &mut [Timed], frames: u64) -> Result<bool, Failure> {
    for begun in (0..frames).step_by(ROUND as usize) {
        for run in &mut *runs {
            for _ in begun..frames.min(begun + ROUND) {
                if interrupt::requested().is_some() {
                    return Ok(false);
                }
                run.frame().map_err(|error| Failure::new(Exit::Diverged, error.to_string()))?;
            }
        }
    }
    Ok(true)
}

/// The numbers asked for, each once; otherwise 1 and all there are.
fn thread_counts(given: &[usize]) -> Vec<usize> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts = if given.is_empty() { vec![1, all] } else { given.to_vec() };
    let mut seen = Vec::new();
    counts.retain(|count| {
        let new = !seen.contains(count);
        seen.push(*count);
        new
    });
    counts
}

/// A simulation and the time it took since `start`.
struct Timed {
    simulation: Simulation,
    threads: usize,
    before: Vec<(&'static str, Duration)>,
    wall: Duration,
    fastest: Duration,
    substeps: u64,
    list_builds: u64,
    particle_substeps: u64,
}

impl Timed {
    fn new(loaded: &LoadedScene, threads: usize) -> Result<Self, Failure> {
        let simulation = Simulation::new(&loaded.scene, BuildOptions { threads: Some(threads), seed: None });
        Ok(Timed {
            simulation,
            threads,
            before: Vec::new(),
            wall: Duration::ZERO,
            fastest: Duration::MAX,
            substeps: 0,
            list_builds: 0,
            particle_substeps: 0,
        })
    }

    /// Forgets what was measured so far.
    fn start(&mut self) {
        self.before = self.simulation.solver.timings().to_vec();
        (self.wall, self.fastest) = (Duration::ZERO, Duration::MAX);
        (self.substeps, self.list_builds, self.particle_substeps) = (0, 0, 0);
    }

    /// One frame, beyond the end of the scene if need be.
    fn frame(&mut self) -> Result<(), SolverError> {
        let begin = Instant::now();
        let report = self.simulation.solver.step_frame()?;
        let time = begin.elapsed();
        self.wall += time;
        self.fastest = self.fastest.min(time);
        self.substeps += u64::from(report.substeps);
        self.list_builds += u64::from(report.list_builds);
        self.particle_substeps += u64::from(report.substeps) * self.simulation.solver.positions().len() as u64;
        Ok(())
    }

    fn measured(&self) -> Measured {
        let solver = &self.simulation.solver;
        let before = |name| self.before.iter().find(|(known, _)| *known == name).map_or(Duration::ZERO, |(_, t)| *t);
        let stages = solver.timings().iter().map(|&(name, time)| (name, time - before(name)));
        Measured {
            threads: self.threads,
            particles: solver.positions().len() as u64,
            wall: self.wall,
            fastest: self.fastest,
            substeps: self.substeps,
            list_builds: self.list_builds,
            particle_substeps: self.particle_substeps,
            memory: solver.memory_bytes() as u64,
            state_hash: solver.state_hash(),
            stages: stages.collect(),
        }
    }
}

/// Result for one number of threads.
struct Measured {
    threads: usize,
    particles: u64,
    wall: Duration,
    fastest: Duration,
    substeps: u64,
    list_builds: u64,
    particle_substeps: u64,
    memory: u64,
    state_hash: u64,
    stages: Vec<(&'static str, Duration)>,
}

impl Measured {
    fn milliseconds_per_frame(&self, frames: u64) -> f64 {
        1e3 * self.wall.as_secs_f64() / frames as f64
    }

    fn milliseconds_per_substep(&self) -> f64 {
        1e3 * self.wall.as_secs_f64() / self.substeps.max(1) as f64
    }

    /// Nanoseconds per particle and substep.
    fn per_particle(&self, time: Duration) -> f64 {
        1e9 * time.as_secs_f64() / self.particle_substeps.max(1) as f64
    }

    fn speed_up(&self, first: &Measured) -> f64 {
        first.wall.as_secs_f64() / self.wall.as_secs_f64()
    }

    fn bytes_per_particle(&self) -> f64 {
        self.memory as f64 / self.particles.max(1) as f64
    }

    fn object(&self, scene: &str, frames: u64, first: &Measured) -> Value {
        let stages: serde_json::Map<String, Value> =
            self.stages.iter().map(|&(name, time)| (name.to_owned(), json!(self.per_particle(time)))).collect();
        json!({
            "type": "bench",
            "scene": scene,
            "threads": self.threads,
            "particles": self.particles,
            "frames": frames,
            "substeps": self.substeps,
            "list_builds": self.list_builds,
            "ms_per_frame": self.milliseconds_per_frame(frames),
            "ms_fastest_frame": 1e3 * self.fastest.as_secs_f64(),
            "ms_per_substep": self.milliseconds_per_substep(),
            "ns_per_particle_substep": self.per_particle(self.wall),
            "speed_up": self.speed_up(first),
            "bytes_per_particle": self.bytes_per_particle(),
            "state_hash": format!("{:016x}", self.state_hash),
            "stages": stages,
        })
    }
}

fn text(scene: &str, frames: u64, results: &[Measured]) -> String {
    let first = &results[0];
    let mut lines = vec![
        format!(
            "{scene}: {}, {}, {:.1} substeps and {:.1} list builds a frame, {} a particle of {} in all",
            plural(first.particles, "particle"),
            plural(frames, "frame"),
            first.substeps as f64 / frames as f64,
            first.list_builds as f64 / frames as f64,
            bytes(first.bytes_per_particle().round() as u64),
            bytes(first.memory),
        ),
        row("threads", results.iter().map(|result| count(result.threads as u64))),
        row("ms per frame", results.iter().map(|result| format!("{:.3}", result.milliseconds_per_frame(frames)))),
        row("ms per substep", results.iter().map(|result| format!("{:.3}", result.milliseconds_per_substep()))),
        row("speed-up", results.iter().map(|result| format!("{:.2}", result.speed_up(first)))),
        "ns per particle and substep".into(),
        row("  all", results.iter().map(|result| format!("{:.1}", result.per_particle(result.wall)))),
    ];
    for (index, (name, _)) in first.stages.iter().enumerate() {
        let cells = results.iter().map(|result| match result.stages.get(index) {
            Some(&(_, time)) => format!("{:.1}", result.per_particle(time)),
            None => String::new(),
        });
        lines.push(row(&format!("  {name}"), cells));
    }
    lines.push(row("state hash", results.iter().map(|result| format!("{:016x}", result.state_hash))));
    lines.join("\n")
}

fn row(name: &str, cells: impl Iterator<Item = String>) -> String {
    cells.fold(format!("{name:22}"), |line, cell| line + &format!(" {cell:>16}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thread_counts_are_tried_once_each_in_the_order_given() {
        assert_eq!(thread_counts(&[2, 1, 2]), [2, 1]);
        assert_eq!(thread_counts(&[])[0], 1);
    }
}
