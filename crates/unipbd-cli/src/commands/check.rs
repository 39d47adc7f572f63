//! `check`: is the scene sound, and what will it cost?

use serde_json::{Value, json};
use unipbd_core::BuildOptions;
use unipbd_core::scene::{Emitter, Scene, Substeps};

use super::estimate::{Cost, emitted, particles};
use super::info::bodies;
use super::scene::{read, threads};
use crate::args::CheckArgs;
use crate::exit::{Exit, Failure};
use crate::report::format::{bytes, count, duration, percent, plural};
use crate::report::{Console, Form};
use crate::scene_file::{Diagnostic, Origin};
use crate::simulation::{Simulation, title};

pub(super) fn check(arguments: &CheckArgs, console: Console) -> Result<Exit, Failure> {
    let loaded = match read(&arguments.scene, &arguments.changes)? {
        Err(error) if console.form == Form::Json && !error.problems().is_empty() => {
            console.object(&json!({
                "type": "check",
                "valid": false,
                "problems": error.problems().iter().map(problem).collect::<Vec<_>>(),
            }))?;
            return Ok(Exit::InvalidScene);
        }
        read => read?,
    };
    let mut simulation =
        Simulation::new(&loaded.scene, BuildOptions { threads: threads(arguments.threads)?, seed: None });
    let cost = Cost::of(&loaded.scene, &mut simulation);
    match console.form {
        Form::Json => console.object(&object(&title(&loaded.scene, &loaded.path), &loaded.scene, &cost))?,
        Form::Text => {
            console.line(format_args!("{}: no mistakes found", loaded.path.display()))?;
            console.line(text(&loaded.scene, &simulation, &cost))?;
        }
    }
    for event in simulation.solver.take_events() {
        console.note(&event.message);
    }
    match cost.first_frame {
        Ok(_) => Ok(Exit::Success),
        Err(error) => Err(Failure::new(Exit::Diverged, format!("the first frame fails: {error}"))),
    }
}

fn text(scene: &Scene, simulation: &Simulation, cost: &Cost) -> String {
    let frames = simulation.frames;
    let mut lines = vec![
        format!("  duration       {} s, {} of 1/{} s", scene.duration, plural(frames, "frame"), scene.fps),
        format!("  particles      {} at the start", count(cost.start.particles())),
        format!(
            "  density error  {} mean, {} worst at the start",
            percent(cost.start.density_error_mean),
            percent(cost.start.density_error_max)
        ),
    ];
    if !scene.emitter.is_empty() {
        lines[1] += &format!(", up to {} emitted, at most {} at once", count(emitted(scene)), count(cost.peak));
    }
    if let Some(bodies) = bodies(simulation, scene) {
        lines.insert(2, format!("  bodies         {bodies}"));
    }
    if let Ok(substeps) = cost.first_frame {
        let choice = match scene.solver.substeps {
            Substeps::Auto => format!(" in the first frame (auto, at most {})", scene.solver.max_substeps),
            Substeps::Fixed(_) => " a frame".into(),
        };
        lines.push(format!("  substeps       {substeps}{choice}"));
    }
    lines.push(format!("  pressure grid  {}", pressure_grid(scene)));
    if scene.slows_bodies() {
        // Discs 8 spacings wide, at Reynolds numbers of 1 to 5.
        lines.push(
            "                 without it bodies sink 10 to 25 % too slowly, light ones rise 40 % too slowly".into(),
        );
    }
    lines.extend(scene.emitter.iter().enumerate().filter_map(|(number, emitter)| face(emitter, number, scene.spacing)));
    lines.push(format!(
        "  memory         {} at the start, about {} at the peak",
        bytes(cost.memory_at_start),
        bytes(cost.memory_at_peak)
    ));
    lines.push(format!("  cost           roughly {} of wall-clock time", duration(cost.wall_time)));
    lines.join("\n")
}

fn object(name: &str, scene: &Scene, cost: &Cost) -> Value {
    let grid = scene.pressure_grid();
    json!({
        "type": "check",
        "valid": true,
        "scene": name,
        "duration": scene.duration,
        "fps": scene.fps,
        "particles": particles(scene),
        "density_error_mean": cost.start.density_error_mean,
        "density_error_max": cost.start.density_error_max,
        "substeps": cost.first_frame.as_ref().ok(),
        "pressure_grid": { "used": grid.used, "reason": grid.reason },
        "memory_bytes": { "at_start": cost.memory_at_start, "peak": cost.memory_at_peak },
        "wall_time": cost.wall_time.as_secs_f64(),
    })
}

/// The message about an emitter whose width is not a whole number of particles.
fn face(emitter: &Emitter, number: usize, spacing: f64) -> Option<String> {
    let (columns, apart) = emitter.columns(spacing);
    let name = if emitter.name.is_empty() { number.to_string() } else { format!("{:?}", emitter.name) };
    (apart != spacing).then(|| {
        format!(
            "  emitter        {name}: {columns} columns of particles {apart:.4} m apart keep the flow of its width of {} m",
            emitter.width
        )
    })
}

/// Whether the scene uses the pressure grid, and why.
pub(super) fn pressure_grid(scene: &Scene) -> String {
    let choice = scene.pressure_grid();
    format!("{}: {}", if choice.used { "on" } else { "off" }, choice.reason)
}

fn problem(problem: &Diagnostic) -> Value {
    let (file, change) = match &problem.origin {
        Origin::File(name) => (Some(name), None),
        Origin::Override(text) => (None, Some(text)),
    };
    json!({
        "file": file,
        "override": change,
        "line": problem.line,
        "column": problem.column,
        "key": problem.key,
        "message": problem.message,
        "hint": problem.hint,
    })
}
