//! Made-up runs for the tests of logs: enough of everything a log can hold.

use std::f64::consts::TAU;

use unipbd_cli::record::Header;
use unipbd_cli::snapshot::{Setting, Snapshot};
use unipbd_core::Vector64;
use unipbd_core::observe::{
    Diagnostics, Event, GaugeReading, GroupDiagnostics, Material, MaterialDiagnostics, Severity, SubstepReason, Table,
    Value, WallForce, WallOutline,
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
        gauges: vec!["level_left".to_owned(), "force".to_owned()],
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
        filter: CollisionFilter { layers: 2, collides_with: 5, group: 0 },
        gravity_factor: 0.5,
        sensor: false,
        user_data: 0,
        removed: false,
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

/// Numbers about a frame; every quantity has a value of its own.
pub fn diagnostics(snapshot: &Snapshot, frame: u32) -> Diagnostics {
    let mut counts = [0; Phase::ALL.len()];
    snapshot.phases.iter().for_each(|phase| counts[*phase as usize] += 1);
    let mut diagnostics: Diagnostics = filled(frame);
    diagnostics.time = snapshot.time;
    diagnostics.counts = counts;
    diagnostics.materials =
        ["water", "air"].map(|name| MaterialDiagnostics { name: name.to_owned(), ..filled(frame) }).to_vec();
    diagnostics.groups = vec![GroupDiagnostics { name: "density".to_owned(), ..filled(frame) }];
    diagnostics.gauges =
        ["level_left", "force"].map(|name| GaugeReading { name: name.to_owned(), ..filled(frame) }).to_vec();
    diagnostics.walls = vec![WallForce { name: "tank left".to_owned(), ..filled(frame) }];
    diagnostics
}

/// A table whose quantities all differ, from each other and from frame to frame.
fn filled<T: Table>(frame: u32) -> T {
    let mut table = T::default();
    for (quantity, number) in T::QUANTITIES.iter().zip(1..) {
        let value = match (quantity.read)(&table) {
            Value::Count(_) => Value::Count(u64::from(1000 * frame + number)),
            Value::Number(_) => Value::Number(noise(number, frame)),
            Value::Vector(_) => Value::Vector(Vector64::new(noise(number, frame), -noise(number, frame))),
            Value::Word(_) => Value::Word(SubstepReason::ALL[frame as usize % SubstepReason::ALL.len()].name()),
            Value::ByPhase(_) => Value::ByPhase([1, 2, 3, 4, 5].map(|count| count * u64::from(number))),
        };
        if let Some(write) = quantity.write {
            write(&mut table, value);
        }
    }
    table
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
