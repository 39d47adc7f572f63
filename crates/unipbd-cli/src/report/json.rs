//! The JSON lines of `run --json`.

use std::collections::BTreeMap;

use serde::Serialize;
use unipbd_core::observe::Diagnostics;
use unipbd_core::phase::Phase;

/// Particles by phase, each phase by its name.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Counts {
    liquid: u64,
    gas: u64,
    smoke: u64,
    rigid: u64,
    solid: u64,
}

impl From<[u64; Phase::ALL.len()]> for Counts {
    fn from([liquid, gas, smoke, rigid, solid]: [u64; Phase::ALL.len()]) -> Self {
        Counts { liquid, gas, smoke, rigid, solid }
    }
}

/// The diagnostics of one frame, under their names in the API.
#[derive(Debug, Serialize)]
pub struct FrameLine<'a> {
    #[serde(rename = "type")]
    kind: &'static str,
    frame: u64,
    time: f64,
    step: u64,
    substeps: u32,
    substeps_wanted: u32,
    substeps_reason: &'static str,
    iterations: u32,
    list_builds: u32,
    particles: u64,
    counts: Counts,
    density_error_mean: f64,
    density_error_max: f64,
    density_error_min: f64,
    pressure_max: f64,
    kinetic_energy: f64,
    potential_energy: f64,
    momentum: [f64; 2],
    angular_momentum: f64,
    speed_max: f64,
    contact_penetration: f64,
    materials: BTreeMap<&'a str, MaterialEntry>,
    groups: BTreeMap<&'a str, GroupEntry>,
    /// Forces on the walls that have names [N].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    walls: BTreeMap<&'a str, [f64; 2]>,
}

#[derive(Debug, Serialize)]
struct MaterialEntry {
    count: u64,
    density_error_mean: f64,
    density_error_max: f64,
}

#[derive(Debug, Serialize)]
struct GroupEntry {
    violation: f64,
}

impl<'a> From<&'a Diagnostics> for FrameLine<'a> {
    fn from(diagnostics: &'a Diagnostics) -> Self {
        FrameLine {
            kind: "frame",
            frame: diagnostics.frame,
            time: diagnostics.time,
            step: diagnostics.step,
            substeps: diagnostics.substeps,
            substeps_wanted: diagnostics.substeps_wanted,
            substeps_reason: diagnostics.substeps_reason.name(),
            iterations: diagnostics.iterations,
            list_builds: diagnostics.list_builds,
            particles: diagnostics.particles(),
            counts: diagnostics.count_by_phase.into(),
            density_error_mean: diagnostics.density_error_mean,
            density_error_max: diagnostics.density_error_max,
            density_error_min: diagnostics.density_error_min,
            pressure_max: diagnostics.pressure_max,
            kinetic_energy: diagnostics.kinetic_energy,
            potential_energy: diagnostics.potential_energy,
            momentum: diagnostics.momentum.into(),
            angular_momentum: diagnostics.angular_momentum,
            speed_max: diagnostics.speed_max,
            contact_penetration: diagnostics.contact_penetration,
            materials: materials(diagnostics),
            groups: groups(diagnostics),
            walls: diagnostics.walls.iter().map(|wall| (wall.name.as_str(), wall.force.into())).collect(),
        }
    }
}

fn materials(diagnostics: &Diagnostics) -> BTreeMap<&str, MaterialEntry> {
    let entry = |material: &unipbd_core::observe::MaterialDiagnostics| MaterialEntry {
        count: material.count,
        density_error_mean: material.density_error_mean,
        density_error_max: material.density_error_max,
    };
    diagnostics.materials.iter().map(|material| (material.name.as_str(), entry(material))).collect()
}

fn groups(diagnostics: &Diagnostics) -> BTreeMap<&str, GroupEntry> {
    let groups = diagnostics.groups.iter();
    groups.map(|group| (group.name.as_str(), GroupEntry { violation: group.violation })).collect()
}
