//! From a frame to the messages of it, in the order in which the log holds them.

use std::io;
use std::ops::Range;

use prost::Message;
use unipbd_core::observe::{Diagnostics, Event, Severity};
use unipbd_core::phase::Phase;
use unipbd_core::rigid::Body;

use super::body_message::bodies_message;
use super::gauge_message::GaugeValues;
use super::messages::{self, Level, Log, POINT_STRIDE, PointCloud};
use super::quantity_message::diagnostics_message;
use super::schema::ParticleColumns;
use super::shapes;
use super::topic::{Topic, Topics};
use super::{Fields, Header};
use crate::snapshot::{Setting, Snapshot};

/// The messages of one frame, encoded one behind the other.
#[derive(Debug, Default)]
pub(crate) struct EncodedFrame {
    pub(crate) messages: Vec<EncodedMessage>,
    pub(crate) bytes: Vec<u8>,
}

/// Where a message lies in [`EncodedFrame::bytes`].
#[derive(Debug)]
pub(crate) struct EncodedMessage {
    pub(crate) topic: Topic,
    /// Simulated time \[ns].
    pub(crate) time: u64,
    pub(crate) range: Range<usize>,
}

impl EncodedFrame {
    fn push(&mut self, topic: Topic, time: u64, message: &impl Message) {
        let start = self.bytes.len();
        self.bytes.reserve(message.encoded_len());
        // Writing into a vector fails only when memory ends.
        let _ = message.encode(&mut self.bytes);
        self.messages.push(EncodedMessage { topic, time, range: start..self.bytes.len() });
    }
}

/// Data of a frame.
pub(crate) struct FrameState<'a> {
    pub(crate) snapshot: &'a Snapshot,
    pub(crate) diagnostics: Option<&'a Diagnostics>,
    pub(crate) state_hash: Option<u64>,
    /// Events since the last frame.
    pub(crate) events: &'a [Event],
}

/// Turns frames into messages and remembers what the reader was told already.
pub(crate) struct Encoder {
    setting: Setting,
    fields: Fields,
    /// Time of the last message \[ns].
    time: u64,
    /// Topics of which the reader has yet to be told what stays the same.
    unsaid: Topics,
    /// Bodies as last described.
    described: Vec<Body>,
    /// Ids, materials and phases as last written, and the asked fields of this frame.
    columns: ParticleColumns,
    /// Rows of a snapshot in the order of their ids, with the id in the high half.
    order: Vec<u64>,
    cloud: PointCloud,
}

impl Encoder {
    pub(crate) fn new(header: &Header, fields: Fields) -> Self {
        Encoder {
            setting: header.setting.clone(),
            fields,
            time: 0,
            unsaid: Topics::ALL,
            described: Vec::new(),
            columns: ParticleColumns::default(),
            order: Vec::new(),
            cloud: messages::empty_cloud(messages::WORLD.to_owned()),
        }
    }

    /// Has the next frame say again what stays the same in these topics: walls, shapes, ids.
    #[cfg(feature = "live")]
    pub(crate) fn say_again(&mut self, topics: Topics) {
        self.unsaid.extend(topics);
    }

    /// Encodes the wanted topics of a frame into `frame`, whose memory is reused. `/particles` comes last: where it is,
    /// the frame is whole.
    pub(crate) fn encode(
        &mut self,
        state: &FrameState<'_>,
        wanted: Topics,
        frame: &mut EncodedFrame,
    ) -> io::Result<()> {
        let snapshot = state.snapshot;
        check_columns(snapshot)?;
        frame.messages.clear();
        frame.bytes.clear();
        let now = nanoseconds(snapshot.time).max(self.time);
        if wanted.contains(Topic::Log) {
            self.encode_events(state.events, now, frame);
        }
        self.time = now;
        self.encode_shapes(&snapshot.bodies, wanted, frame);
        self.sort_by_id(&snapshot.ids);
        if wanted.contains(Topic::Columns) {
            self.encode_columns(snapshot, frame);
        }
        if let Some(diagnostics) = state.diagnostics.filter(|_| wanted.contains(Topic::Diagnostics)) {
            frame.push(Topic::Diagnostics, now, &diagnostics_message(diagnostics, state.state_hash));
        }
        let gauges = state.diagnostics.filter(|diagnostics| !diagnostics.gauges.is_empty());
        if let Some(diagnostics) = gauges.filter(|_| wanted.contains(Topic::Gauges)) {
            frame.push(Topic::Gauges, now, &GaugeValues::of(diagnostics));
        }
        if wanted.contains(Topic::Particles) {
            self.encode_particles(snapshot, frame);
        }
        self.unsaid.remove(wanted);
        Ok(())
    }

    /// Events carry their own time, but log time never runs backwards.
    fn encode_events(&mut self, events: &[Event], now: u64, frame: &mut EncodedFrame) {
        for event in events {
            self.time = nanoseconds(event.time).clamp(self.time, now);
            let level = match event.severity {
                Severity::Info => Level::Info,
                Severity::Warning => Level::Warning,
            };
            let message = Log {
                timestamp: Some(messages::timestamp(nanoseconds(event.time))),
                level: level as i32,
                message: event.message.clone(),
                name: "unipbd".to_owned(),
                ..Default::default()
            };
            frame.push(Topic::Log, self.time, &message);
        }
    }

    /// Walls once, bodies when their shapes changed, poses every frame.
    fn encode_shapes(&mut self, bodies: &[Body], wanted: Topics, frame: &mut EncodedFrame) {
        let now = self.time;
        let walls = &self.setting.walls;
        let said_before = self.described.len();
        if !same_shapes(&self.described, bodies) {
            self.described = bodies.to_vec();
            self.unsaid.extend([Topic::Scene, Topic::Transforms, Topic::Bodies].into_iter().collect());
        }
        let unsaid = |topic: Topic| wanted.contains(topic) && self.unsaid.contains(topic);
        if unsaid(Topic::Boundary) && !walls.is_empty() {
            let samples = shapes::boundary_samples(walls, self.setting.spacing);
            let cloud = messages::cloud(messages::WORLD.to_owned(), now, &samples, shapes::WALL_COLOR);
            frame.push(Topic::Boundary, now, &cloud);
        }
        let anything = said_before > 0 || !bodies.is_empty();
        if unsaid(Topic::Scene) && (anything || !walls.is_empty()) {
            let update = shapes::scene_update(now, walls, bodies, said_before);
            frame.push(Topic::Scene, now, &update);
        }
        if wanted.contains(Topic::BodySamples) && bodies.iter().any(|body| !body.samples.is_empty()) {
            let samples = shapes::body_samples(bodies);
            let cloud = messages::cloud(messages::WORLD.to_owned(), now, &samples, shapes::BODY_COLOR);
            frame.push(Topic::BodySamples, now, &cloud);
        }
        if wanted.contains(Topic::Transforms) && anything {
            frame.push(Topic::Transforms, now, &messages::transforms(now, bodies));
        }
        if wanted.contains(Topic::Bodies) && anything {
            frame.push(Topic::Bodies, now, &bodies_message(bodies, unsaid(Topic::Bodies)));
        }
    }

    /// Rows in the order of their ids: the log's order stays while rows of the solver are re-sorted.
    fn sort_by_id(&mut self, ids: &[u32]) {
        self.order.clear();
        self.order.extend(ids.iter().zip(0u64..).map(|(id, row)| u64::from(*id) << 32 | row));
        if !self.order.is_sorted() {
            self.order.sort_unstable();
        }
    }

    fn encode_columns(&mut self, snapshot: &Snapshot, frame: &mut EncodedFrame) {
        let changed = self.update_ids(snapshot);
        let columns = &mut self.columns;
        let rows = || self.order.iter().map(|key| row(*key));
        for values in [&mut columns.velocity_x, &mut columns.velocity_y] {
            values.clear();
        }
        columns.density_error.clear();
        columns.temperature.clear();
        if let (true, Some(velocities)) = (self.fields.velocity, &snapshot.velocities) {
            columns.velocity_x.extend(rows().map(|row| velocities[row][0]));
            columns.velocity_y.extend(rows().map(|row| velocities[row][1]));
        }
        if let (true, Some(errors)) = (self.fields.density, &snapshot.density_errors) {
            columns.density_error.extend(rows().map(|row| errors[row]));
        }
        if let (true, Some(temperatures)) = (self.fields.temperature, &snapshot.temperatures) {
            columns.temperature.extend(rows().map(|row| temperatures[row]));
        }
        if changed || self.unsaid.contains(Topic::Columns) {
            frame.push(Topic::Columns, self.time, columns);
        } else if self.fields.any() {
            let kept = [&mut columns.id, &mut columns.material, &mut columns.phase].map(std::mem::take);
            frame.push(Topic::Columns, self.time, columns);
            [columns.id, columns.material, columns.phase] = kept;
        }
    }

    /// Takes over the ids, materials and phases of a snapshot; says whether they changed.
    fn update_ids(&mut self, snapshot: &Snapshot) -> bool {
        let columns = &mut self.columns;
        let same = columns.id.len() == self.order.len()
            && self.order.iter().enumerate().all(|(place, key)| {
                let row = row(*key);
                columns.id[place] == snapshot.ids[row]
                    && columns.material[place] == u32::from(snapshot.materials[row])
                    && columns.phase[place] == snapshot.phases[row] as u32
            });
        if same {
            return false;
        }
        for values in [&mut columns.id, &mut columns.material, &mut columns.phase] {
            values.clear();
        }
        let rows = || self.order.iter().map(|key| row(*key));
        columns.id.extend(rows().map(|row| snapshot.ids[row]));
        columns.material.extend(rows().map(|row| u32::from(snapshot.materials[row])));
        columns.phase.extend(rows().map(|row| snapshot.phases[row] as u32));
        true
    }

    fn encode_particles(&mut self, snapshot: &Snapshot, frame: &mut EncodedFrame) {
        let colors: Vec<[u8; 4]> = self.setting.materials.iter().map(|m| rgba(m.color, m.phase)).collect();
        let mut data = Vec::from(std::mem::take(&mut self.cloud.data));
        data.resize(self.order.len() * POINT_STRIDE, 0);
        for (key, bytes) in self.order.iter().zip(data.chunks_exact_mut(POINT_STRIDE)) {
            let row = row(*key);
            let material = colors.get(usize::from(snapshot.materials[row])).copied();
            let color = match snapshot.phases[row] {
                Phase::Rigid => shapes::BODY_COLOR,
                phase => material.unwrap_or(rgba([200; 3], phase)),
            };
            bytes.copy_from_slice(&messages::pack_point(snapshot.positions[row], color));
        }
        self.cloud.data = data.into();
        self.cloud.timestamp = Some(messages::timestamp(self.time));
        frame.push(Topic::Particles, self.time, &self.cloud);
    }
}

/// The row in a key of [`Encoder::order`].
fn row(key: u64) -> usize {
    (key & u64::from(u32::MAX)) as usize
}

/// Colour of a particle: gas is drawn faintly, so that the smoke in it shows.
fn rgba([red, green, blue]: [u8; 3], phase: Phase) -> [u8; 4] {
    let alpha = match phase {
        Phase::Gas => 80,
        Phase::Smoke => 160,
        _ => 255,
    };
    [red, green, blue, alpha]
}

/// Simulated time as the log holds it: whole nanoseconds from 0.
pub(crate) fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}

fn check_columns(snapshot: &Snapshot) -> io::Result<()> {
    let count = snapshot.positions.len();
    let optional = [
        snapshot.velocities.as_ref().map(Vec::len),
        snapshot.density_errors.as_ref().map(Vec::len),
        snapshot.temperatures.as_ref().map(Vec::len),
    ];
    let needed = [snapshot.ids.len(), snapshot.phases.len(), snapshot.materials.len()];
    if needed.into_iter().chain(optional.into_iter().flatten()).all(|length| length == count) {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, "the columns of a frame differ in length"))
}

fn same_shapes(described: &[Body], bodies: &[Body]) -> bool {
    let same = |(a, b): (&Body, &Body)| {
        a.kind == b.kind
            && a.mass == b.mass
            && a.inertia == b.inertia
            && a.radius == b.radius
            && a.outline == b.outline
            && a.samples == b.samples
            && a.sample_area == b.sample_area
            && a.surface == b.surface
            && a.filter == b.filter
            && a.gravity_factor == b.gravity_factor
    };
    described.len() == bodies.len() && described.iter().zip(bodies).all(same)
}
