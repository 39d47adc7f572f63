//! The properties that a state and the restored run must share, as text for error messages.

use crate::math::Real;
use crate::phase::Phase;
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
    ];
    // Samples of bodies come with the first body.
    let materials = || parts.materials.iter().filter(|material| material.phase != Phase::Rigid);
    lines.push(format!("{} materials", materials().count()));
    let material = |material: &crate::observe::Material| {
        format!("a {} \"{}\" of density {}", material.phase.name(), material.name, material.density)
    };
    lines.extend(materials().map(material));
    lines.push(format!("{} temperatures", if optional.temperature { "particles with" } else { "no" }));
    lines.push(format!("{} ages", if optional.age { "particles with" } else { "no" }));
    lines.push(format!("liquids that {}sleep", if optional.rest { "" } else { "do not " }));
    let emitters = parts.scene_emitters.as_deref().unwrap_or_default();
    lines.push(format!("{} emitters with {emitters:?} columns", emitters.len()));
    lines.push(format!("bodies and joints of the scene, mark {:x}", parts.scene_mark));
    lines.push(format!("{} ropes", parts.scene_ropes));
    let (before, behind) = (&parts.groups[..parts.rope_groups.start], &parts.groups[parts.rope_groups.end..]);
    lines.push(format!("{} constraint groups", before.len() + behind.len()));
    lines.extend(before.iter().chain(behind).map(|group| format!("a constraint group \"{}\"", group.name())));
    lines
}
