//! Constant data of a run.

use serde_json::{Map, Value, json};
use unipbd_core::Solver;
use unipbd_core::rigid::{Body, BodyKind};
use unipbd_scene_file::Override;

use crate::Session;

/// Scene, materials, walls and bodies, and the part of the world to show.
pub fn session(session: &Session) -> Value {
    let (solver, scene) = (&session.solver, &session.scene);
    let (low, high) = extent(solver);
    let walls = solver.wall_outlines().iter().filter(|wall| !wall.points.is_empty()).map(|wall| {
        let points: Vec<[f64; 2]> = wall.points.iter().map(|point| point.to_array()).collect();
        json!({ "points": points, "closed": wall.closed })
    });
    let materials = solver.materials().iter().map(|material| {
        json!({
            "name": material.name,
            "phase": material.phase.name(),
            "density": material.density,
            "color": material.color,
        })
    });
    json!({
        "name": scene.name,
        "description": scene.description,
        "spacing": scene.spacing,
        "duration": scene.duration,
        "frameTime": solver.frame_time(),
        "view": { "min": scene.view.min.unwrap_or(low), "max": scene.view.max.unwrap_or(high) },
        "materials": materials.collect::<Vec<_>>(),
        "walls": walls.collect::<Vec<_>>(),
        "bodies": solver.bodies().iter().map(body).collect::<Vec<_>>(),
        "scene": session.tree,
    })
}

fn body(body: &Body) -> Value {
    let outline: Vec<[f64; 2]> = body.outline.iter().map(|point| point.to_array()).collect();
    let fixed = body.kind == BodyKind::Static;
    json!({ "name": body.name, "radius": body.radius, "outline": outline, "mass": body.mass, "fixed": fixed })
}

/// The corners of all that is there \[m].
fn extent(solver: &Solver) -> ([f64; 2], [f64; 2]) {
    let ends = solver.wall_outlines().iter().filter(|wall| !wall.endless);
    let walls = ends.flat_map(|wall| wall.points.iter().map(|point| point.to_array()));
    let particles = solver.positions().iter().map(|place| [f64::from(place.x), f64::from(place.y)]);
    let bodies = solver.bodies().iter().flat_map(|body| {
        let reach = body.outline.iter().map(|point| point.length()).fold(body.radius, f64::max);
        [-reach, reach].map(|by| [body.position.x + by, body.position.y + by])
    });
    let margin = 2.0 * solver.spacing();
    let all = walls.chain(particles).chain(bodies);
    let wider = |(low, high): ([f64; 2], [f64; 2]), [x, y]: [f64; 2]| {
        let low = [low[0].min(x - margin), low[1].min(y - margin)];
        (low, [high[0].max(x + margin), high[1].max(y + margin)])
    };
    let found = all.fold(([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]), wider);
    if found.0[0].is_finite() { found } else { ([0.0; 2], [1.0; 2]) }
}

/// The keys that a scene gives, as JSON, with its overrides under their keys in `set`.
pub fn tree(text: &str, overrides: &[Override]) -> Value {
    let table = toml::from_str::<toml::Table>(text).unwrap_or_default();
    let mut tree = serde_json::to_value(table).unwrap_or_default();
    let set: Map<String, Value> = overrides.iter().map(|one| (one.key().to_owned(), one.value().into())).collect();
    if let (Value::Object(root), false) = (&mut tree, set.is_empty()) {
        root.insert("set".to_owned(), Value::Object(set));
    }
    tree
}
