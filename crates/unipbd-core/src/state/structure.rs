//! The properties that a state and the restored run must share, as text for error messages.

use crate::math::Real;
use crate::step::Solver;

/// One line per fact; two runs with the same lines can exchange their states.
pub(super) fn structure(solver: &Solver) -> Vec<String> {
    let parts = &solver.world.parts;
    let optional = parts.particles.optional();
    let mut lines = vec![
        format!("{}-bit numbers", 8 * size_of::<Real>()),
        format!("spacing {} m", parts.spacing),
        format!("frames of {} s", parts.frame_time),
        format!("seed {}", parts.seed),
        format!("{} materials", parts.materials.len()),
    ];
    let material = |material: &crate::observe::Material| {
        format!("a {} \"{}\" of density {}", material.phase.name(), material.name, material.density)
    };
    lines.extend(parts.materials.iter().map(material));
    lines.push(format!("{} temperatures", if optional.temperature { "particles with" } else { "no" }));
    lines.push(format!("{} ages", if optional.age { "particles with" } else { "no" }));
    lines.push(format!("liquids that {}sleep", if optional.rest { "" } else { "do not " }));
    let emitters = parts.emitters.as_ref().map_or_else(Vec::new, |emitters| emitters.columns().collect());
    lines.push(format!("{} emitters with {emitters:?} columns", emitters.len()));
    lines.push(format!("bodies and joints of the scene, mark {:x}", parts.scene_mark));
    lines.push(format!("{} constraint groups", parts.groups.len()));
    lines.extend(parts.groups.iter().map(|group| format!("a constraint group \"{}\"", group.name())));
    lines
}
