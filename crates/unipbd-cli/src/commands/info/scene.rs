//! Information about the contents of a scene.

use std::path::Path;

use serde_json::json;
use unipbd_core::BuildOptions;
use unipbd_core::observe::Diagnostics;
use unipbd_core::rigid::{Body, BodyKind};
use unipbd_core::scene::Scene;

use super::super::check::pressure_grid;
use super::super::estimate::{emitted, particles as particle_object};
use super::super::scene::load;
use crate::args::SceneChanges;
use crate::exit::{Exit, Failure};
use crate::report::format::{count, plural};
use crate::report::{Console, Form};
use crate::scene_file::LoadedScene;
use crate::simulation::{Simulation, stage_names, title};

pub(super) fn info(path: &Path, changes: &SceneChanges, console: Console) -> Result<Exit, Failure> {
    let loaded = load(path, changes)?;
    let simulation = Simulation::new(&loaded.scene, BuildOptions::default());
    match console.form {
        Form::Json => console.object(&object(&loaded, &simulation))?,
        Form::Text => console.line(text(&loaded, &simulation))?,
    }
    Ok(Exit::Success)
}

fn text(loaded: &LoadedScene, simulation: &Simulation) -> String {
    let scene = &loaded.scene;
    let diagnostics = simulation.solver.diagnostics();
    let mut lines = vec![title(scene, &loaded.path)];
    if !scene.description.is_empty() {
        lines.push(format!("  {}", scene.description.trim()));
    }
    lines.push(format!(
        "  duration    {} s, {} of 1/{} s",
        scene.duration,
        plural(simulation.frames, "frame"),
        scene.fps
    ));
    lines
        .push(format!("  spacing     {} m, gravity [{}, {}] m/s^2", scene.spacing, scene.gravity[0], scene.gravity[1]));
    lines.push(format!("  particles   {}", particles(scene, &diagnostics)));
    lines.extend(materials(simulation, &diagnostics));
    if let Some(bodies) = bodies(simulation, scene) {
        lines.push(format!("  bodies      {bodies}"));
    }
    lines.push(format!("  walls       {}", walls(scene)));
    if let Some(axes) = periodic_axes(scene) {
        lines.push(format!("  periodic    {axes}"));
    }
    lines.push(format!("  grid        {}", pressure_grid(scene)));
    lines.push(format!("  stages      {}", stage_names(&simulation.solver).join(" > ")));
    lines.push(format!("  seed        {}", simulation.solver.seed()));
    lines.push(format!("  sha256      {}", loaded.sha256));
    lines.join("\n")
}

fn particles(scene: &Scene, diagnostics: &Diagnostics) -> String {
    let mut text = format!("{} at the start", count(diagnostics.particles()));
    if !scene.emitter.is_empty() {
        text += &format!(", up to {} from {}", count(emitted(scene)), plural(scene.emitter.len() as u64, "emitter"));
    }
    text
}

fn materials(simulation: &Simulation, diagnostics: &Diagnostics) -> Vec<String> {
    let lines = simulation.solver.materials().iter().map(|material| {
        let [red, green, blue] = material.color;
        let held =
            diagnostics.materials.iter().find(|entry| entry.name == material.name).map_or(0, |entry| entry.count);
        let density = if material.density > 0.0 { format!(", {} kg/m^2", material.density) } else { String::new() };
        format!(
            "    {:<10} {}{density}, #{red:02x}{green:02x}{blue:02x}, {} at the start",
            material.name,
            material.phase.name(),
            count(held)
        )
    });
    lines.collect()
}

/// Bodies and joints, where there are bodies.
pub(in crate::commands) fn bodies(simulation: &Simulation, scene: &Scene) -> Option<String> {
    let kind = |body: &&Body| body.kind != BodyKind::Dynamic;
    let all = simulation.solver.bodies();
    let mut text = count(all.len() as u64);
    match all.iter().filter(kind).count() {
        0 => (),
        number => text += &format!(" ({number} kinematic or static)"),
    }
    if !scene.joint.is_empty() {
        text += &format!(", {}", plural(scene.joint.len() as u64, "joint"));
    }
    (!all.is_empty()).then_some(text)
}

fn walls(scene: &Scene) -> String {
    let kinds =
        [(scene.half_plane.len(), "half-plane"), (scene.tank.len(), "tank"), (scene.obstacle.len(), "obstacle")];
    let named: Vec<String> =
        kinds.into_iter().filter(|(number, _)| *number > 0).map(|(number, noun)| plural(number as u64, noun)).collect();
    if named.is_empty() { "none".into() } else { named.join(", ") }
}

fn periodic_axes(scene: &Scene) -> Option<String> {
    let axes = [("x", scene.domain.periodic_x), ("y", scene.domain.periodic_y)];
    let named: Vec<String> = axes
        .into_iter()
        .filter_map(|(axis, range)| range.map(|[from, to]| format!("{axis} from {from} to {to} m")))
        .collect();
    (!named.is_empty()).then(|| named.join(", "))
}

fn object(loaded: &LoadedScene, simulation: &Simulation) -> serde_json::Value {
    let (scene, grid) = (&loaded.scene, loaded.scene.pressure_grid());
    let diagnostics = simulation.solver.diagnostics();
    let materials: Vec<_> = simulation
        .solver
        .materials()
        .iter()
        .map(|material| {
            let held = diagnostics.materials.iter().find(|entry| entry.name == material.name);
            json!({
                "name": material.name,
                "phase": material.phase.name(),
                "density": material.density,
                "color": material.color,
                "count": held.map_or(0, |entry| entry.count),
            })
        })
        .collect();
    json!({
        "type": "scene",
        "path": loaded.path.display().to_string(),
        "name": title(scene, &loaded.path),
        "description": scene.description,
        "sha256": loaded.sha256,
        "duration": scene.duration,
        "fps": scene.fps,
        "frames": simulation.frames,
        "spacing": scene.spacing,
        "gravity": scene.gravity,
        "seed": simulation.solver.seed(),
        "particles": particle_object(scene),
        "materials": materials,
        "emitters": scene.emitter.len(),
        "bodies": simulation.solver.bodies().len(),
        "joints": scene.joint.len(),
        "walls": {
            "half_plane": scene.half_plane.len(),
            "tank": scene.tank.len(),
            "obstacle": scene.obstacle.len(),
        },
        "periodic": { "x": scene.domain.periodic_x, "y": scene.domain.periodic_y },
        "pressure_grid": { "used": grid.used, "reason": grid.reason },
        "stages": stage_names(&simulation.solver),
    })
}
