//! From messages back to frames.

use prost::Message;
use unipbd_core::math::Vector64;
use unipbd_core::observe::{Event, Severity};
use unipbd_core::phase::{MaterialIndex, Phase};
use unipbd_core::rigid::{Body, BodyKind, CollisionFilter, Surface};

use super::{Frame, guard};
use crate::record::schema::{Bodies, BodyShape, BodyState, ParticleColumns};
use crate::record::{Level, Log, POINT_STRIDE, PointCloud, Topic, kind_name, read_diagnostics, unpack_position};
use crate::snapshot::Snapshot;

/// Collects the messages of a frame, and keeps what a log writes only when it changes.
pub(crate) struct Assembler {
    /// Number of materials of the run.
    known_materials: usize,
    ids: Vec<u32>,
    materials: Vec<MaterialIndex>,
    phases: Vec<Phase>,
    shapes: Vec<BodyShape>,
    /// The asked fields of this frame.
    fields: ParticleColumns,
    /// Frame in the making.
    frame: Frame,
}

impl Assembler {
    pub(crate) fn new(known_materials: usize) -> Self {
        Assembler {
            known_materials,
            ids: Vec::new(),
            materials: Vec::new(),
            phases: Vec::new(),
            shapes: Vec::new(),
            fields: ParticleColumns::default(),
            frame: Frame::default(),
        }
    }

    /// Adds a message; returns the frame that it completes. Errors say what is wrong.
    pub(crate) fn add(&mut self, topic: Topic, time: u64, data: &[u8]) -> Result<Option<Frame>, String> {
        guard::check(topic, data)?;
        match topic {
            Topic::Particles => return self.complete(time, &decode(topic, data)?).map(Some),
            Topic::Columns => self.take_columns(decode(topic, data)?)?,
            Topic::Bodies => self.take_bodies(decode(topic, data)?)?,
            Topic::Diagnostics => {
                let (diagnostics, hash) = read_diagnostics(data).map_err(|error| undecodable(topic, &error))?;
                (self.frame.diagnostics, self.frame.state_hash) = (Some(diagnostics), hash);
            }
            Topic::Log => self.frame.events.push(event(&decode(topic, data)?)),
            // The same again, for viewers.
            Topic::Boundary | Topic::BodySamples | Topic::Scene | Topic::Transforms | Topic::Gauges => {}
        }
        Ok(None)
    }

    fn take_columns(&mut self, mut columns: ParticleColumns) -> Result<(), String> {
        if !columns.id.is_empty() {
            if columns.material.len() != columns.id.len() || columns.phase.len() != columns.id.len() {
                return Err("particle columns differ in length".to_owned());
            }
            self.materials.clear();
            for (material, phase) in columns.material.iter().zip(&columns.phase) {
                let index = MaterialIndex::try_from(*material).ok();
                // Samples of bodies that came to a run without any have a material that it did not begin with.
                let known = self.known_materials + usize::from(*phase == Phase::Rigid as u32);
                let index = index.filter(|index| usize::from(*index) < known);
                self.materials.push(index.ok_or_else(|| format!("there is no material {material}"))?);
            }
            self.phases.clear();
            for code in &columns.phase {
                let phase = u8::try_from(*code).ok().and_then(Phase::from_code);
                self.phases.push(phase.ok_or_else(|| format!("there is no phase {code}"))?);
            }
            self.ids = std::mem::take(&mut columns.id);
        }
        self.fields = columns;
        Ok(())
    }

    fn take_bodies(&mut self, message: Bodies) -> Result<(), String> {
        if !message.shapes.is_empty() || message.bodies.is_empty() {
            self.shapes = message.shapes;
        }
        let bodies = message.bodies.into_iter().map(|state| {
            let shape = self.shapes.get(state.id as usize).filter(|shape| shape.id == state.id);
            body(shape.ok_or_else(|| format!("body {} has no shape", state.id))?, state)
        });
        self.frame.snapshot.bodies = bodies.collect::<Result<_, String>>()?;
        Ok(())
    }

    /// Puts the frame together: `/particles` is its last message.
    fn complete(&mut self, time: u64, cloud: &PointCloud) -> Result<Frame, String> {
        if cloud.point_stride as usize != POINT_STRIDE {
            return Err(format!("points of {} bytes", cloud.point_stride));
        }
        let (points, rest) = cloud.data.as_chunks::<POINT_STRIDE>();
        if points.is_empty() {
            self.ids.clear();
            self.materials.clear();
            self.phases.clear();
        }
        if !rest.is_empty() || points.len() != self.ids.len() {
            return Err(format!("{} bytes of points for {} particles", cloud.data.len(), self.ids.len()));
        }
        let fields = std::mem::take(&mut self.fields);
        let frame = std::mem::take(&mut self.frame);
        let snapshot = Snapshot {
            time: time as f64 / 1e9,
            positions: points.iter().map(unpack_position).collect(),
            ids: self.ids.clone(),
            phases: self.phases.clone(),
            materials: self.materials.clone(),
            velocities: velocities(fields.velocity_x, fields.velocity_y, points.len())?,
            density_errors: column(fields.density_error, points.len())?,
            temperatures: column(fields.temperature, points.len())?,
            bodies: frame.snapshot.bodies,
        };
        Ok(Frame { snapshot, ..frame })
    }
}

fn decode<M: Message + Default>(topic: Topic, data: &[u8]) -> Result<M, String> {
    M::decode(data).map_err(|error| undecodable(topic, &error))
}

fn undecodable(topic: Topic, error: &prost::DecodeError) -> String {
    format!("a message on {} cannot be decoded: {error}", topic.name())
}

/// A column of the log: absent where it is empty.
fn column(values: Vec<f32>, count: usize) -> Result<Option<Vec<f32>>, String> {
    match values.len() {
        0 => Ok(None),
        length if length == count => Ok(Some(values)),
        length => Err(format!("a field has {length} values for {count} particles")),
    }
}

fn velocities(x: Vec<f32>, y: Vec<f32>, count: usize) -> Result<Option<Vec<[f32; 2]>>, String> {
    let pair = |(x, y): (Vec<f32>, Vec<f32>)| x.into_iter().zip(y).map(|(x, y)| [x, y]).collect();
    Ok(column(x, count)?.zip(column(y, count)?).map(pair))
}

fn event(message: &Log) -> Event {
    let time = message.timestamp.map_or(0.0, |time| f64::from(time.sec()) + f64::from(time.nsec()) / 1e9);
    let severity = if message.level == Level::Info as i32 { Severity::Info } else { Severity::Warning };
    Event { time, severity, message: message.message.clone() }
}

fn body(shape: &BodyShape, state: BodyState) -> Result<Body, String> {
    let kinds = [BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Static];
    let kind = kinds.into_iter().find(|kind| kind_name(*kind) == shape.kind);
    let points = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| Vector64::new(*x, *y)).collect();
    Ok(Body {
        name: state.name,
        kind: kind.ok_or_else(|| format!("a body is of the unknown kind \"{}\"", shape.kind))?,
        position: Vector64::new(state.x, state.y),
        angle: state.angle,
        velocity: Vector64::new(state.velocity_x, state.velocity_y),
        angular_velocity: state.angular_velocity,
        mass: shape.mass,
        inertia: shape.inertia,
        outline: points(&shape.outline_x, &shape.outline_y),
        radius: shape.radius,
        samples: points(&shape.sample_x, &shape.sample_y),
        sample_area: shape.sample_area,
        surface: Surface {
            static_friction: shape.static_friction,
            kinetic_friction: shape.kinetic_friction,
            rolling_friction: shape.rolling_friction,
            restitution: shape.restitution,
            speed: 0.0,
            no_slip: false,
        },
        filter: CollisionFilter { layers: shape.layers, collides_with: shape.collides_with, group: 0 },
        sensor: shape.sensor,
        gravity_factor: shape.gravity_factor,
        // A removed body has no shape.
        removed: shape.radius == 0.0 && shape.outline_x.is_empty(),
        asleep: state.asleep,
        fluid_force: Vector64::new(state.fluid_force_x, state.fluid_force_y),
        fluid_torque: state.fluid_torque,
        contact_force: Vector64::new(state.contact_force_x, state.contact_force_y),
        contact_torque: state.contact_torque,
        ..Body::default()
    })
}
