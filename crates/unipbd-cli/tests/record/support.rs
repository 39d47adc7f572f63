//! Made-up runs for the tests of logs: enough of everything a log can hold.

use std::f64::consts::TAU;

use unipbd_cli::record::Header;
use unipbd_cli::snapshot::{Setting, Snapshot};
use unipbd_core::Vector64;
use unipbd_core::observe::{
    Diagnostics, Event, GroupDiagnostics, Material, MaterialDiagnostics, Severity, WallOutline,
};
use unipbd_core::phase::Phase;
use unipbd_core::rigid::{Body, BodyKind, CollisionFilter, Surface};

/// A run with a liquid, gas, smoke, walls and two bodies.
pub fn header() -> Header {
    let material = |name: &str, phase, density, color| Material { name: name.to_owned(), phase, density, color };
    let corners = [[-1.0, -1.0], [3.0, -1.0], [3.0, 2.0 / 3.0], [-1.0, 2.0]].map(Vector64::from);
    Header {
        setting: Setting {
            name: "Everything at once".to_owned(),
            spacing: 0.1,
            materials: vec![
                material("water", Phase::Liquid, 1000.0, [40, 110, 210]),
                material("air", Phase::Gas, 1.2, [180, 190, 200]),
                material("smoke", Phase::Smoke, 0.0, [240, 240, 240]),
            ],
            walls: vec![
                WallOutline { points: corners.to_vec(), closed: true, endless: false },
                WallOutline { points: corners[..2].to_vec(), closed: false, endless: true },
            ],
            view: Some(([-1.0, -1.0], [3.0, 1.0 / 3.0])),
        },
        scene_text: "name = \"Everything at once\"\n".to_owned(),
        overrides: vec!["spacing=0.1".to_owned(), "name=\"Everything, at once\"".to_owned()],
        seed: u64::MAX - 3,
        fps: 60.0,
        gravity: [0.0, -9.81],
    }
}

/// The same without walls.
pub fn open_header() -> Header {
    let mut header = header();
    header.setting.walls.clear();
    header
}

fn noise(id: u32, frame: u32) -> f64 {
    let mixed = id.wrapping_mul(2_654_435_761).wrapping_add(frame.wrapping_mul(40_503)).rotate_left(13);
    f64::from(mixed.wrapping_mul(2_246_822_519)) / f64::from(u32::MAX)
}

/// Frame `frame` of a run whose particles are re-sorted every frame, and of which some leave and
/// some come every fourth frame.
pub fn snapshot(count: u32, frame: u32) -> Snapshot {
    let generation = frame / 4;
    let first = 3 * generation;
    let mut ids: Vec<u32> = (first..first + count + generation).collect();
    ids.sort_by(|a, b| noise(*a, frame).total_cmp(&noise(*b, frame)));
    let time = f64::from(frame) / 60.0;
    let angle = |id: u32| TAU * noise(id, 0) + time;
    let materials: Vec<u16> = ids.iter().map(|id| (id % 3) as u16).collect();
    Snapshot {
        time,
        positions: ids.iter().map(|id| [angle(*id).cos() as f32, angle(*id).sin() as f32]).collect(),
        phases: ids.iter().map(|id| [Phase::Liquid, Phase::Gas, Phase::Smoke][*id as usize % 3]).collect(),
        materials,
        velocities: Some(ids.iter().map(|id| [-angle(*id).sin() as f32, angle(*id).cos() as f32]).collect()),
        density_errors: Some(ids.iter().map(|id| 0.01 * noise(*id, frame) as f32).collect()),
        temperatures: Some(ids.iter().map(|id| noise(*id, 7) as f32).collect()),
        bodies: bodies(time),
        ids,
    }
}

/// The same without bodies.
pub fn bodiless_snapshot(count: u32, frame: u32) -> Snapshot {
    Snapshot { bodies: Vec::new(), ..snapshot(count, frame) }
}

fn bodies(time: f64) -> Vec<Body> {
    let square = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]].map(Vector64::from).to_vec();
    let samples = [[-0.1, 0.0], [0.1, 0.0]].map(Vector64::from).to_vec();
    let body = Body {
        name: "box".to_owned(),
        kind: BodyKind::Dynamic,
        position: Vector64::new(1.0, 1.0 - time),
        angle: 1.5 * time,
        velocity: Vector64::new(0.0, -1.0),
        angular_velocity: 1.5,
        mass: 3.0,
        inertia: 0.25,
        outline: square,
        radius: 0.0,
        samples,
        fluid_force: Vector64::new(0.5, 9.81),
        fluid_torque: -0.125,
        sample_area: 0.01,
        surface: Surface { rolling_friction: 0.01, restitution: 0.3, ..Surface::default() },
        filter: CollisionFilter { layers: 2, collides_with: 5 },
        asleep: time > 0.1,
        contact_force: Vector64::new(-0.5, 3.0),
        contact_torque: 0.75,
    };
    let disc = Body {
        name: "disc".to_owned(),
        kind: BodyKind::Kinematic,
        outline: Vec::new(),
        radius: 0.3,
        position: Vector64::new(2.0, 0.1 + time),
        ..body.clone()
    };
    vec![body, disc]
}

/// Numbers about a frame.
pub fn diagnostics(snapshot: &Snapshot, frame: u32) -> Diagnostics {
    let mut count_by_phase = [0; Phase::ALL.len()];
    snapshot.phases.iter().for_each(|phase| count_by_phase[*phase as usize] += 1);
    let material = |name: &str| MaterialDiagnostics {
        name: name.to_owned(),
        count: 7,
        density_error_mean: 0.001,
        density_error_max: 0.02,
        density_error_min: -0.1,
    };
    Diagnostics {
        time: snapshot.time,
        frame: u64::from(frame),
        step: 8 * u64::from(frame),
        substeps: 8,
        iterations: 8,
        list_builds: 2,
        count_by_phase,
        density_error_mean: 0.003,
        density_error_max: 0.06,
        density_error_min: -0.5,
        pressure_max: 39.0,
        kinetic_energy: 10.0 * noise(1, frame),
        potential_energy: 20.0,
        momentum: Vector64::new(0.0, -1.25),
        angular_momentum: 2.5,
        speed_max: 1.0 + noise(2, frame),
        materials: vec![material("water"), material("air")],
        groups: vec![GroupDiagnostics { name: "density".to_owned(), violation: 0.06 }],
        ..Diagnostics::default()
    }
}

/// A warning shortly before a frame, every fifth frame.
pub fn events(frame: u32) -> Vec<Event> {
    if frame % 5 != 2 {
        return Vec::new();
    }
    let time = (f64::from(frame) - 0.5) / 60.0;
    let message = format!("substeps capped at 256 in frame {frame}");
    let note = Event { time, severity: Severity::Info, message: "note".to_owned() };
    vec![note, Event { time, severity: Severity::Warning, message }]
}
