//! Tables of text: one row per particle and frame, per body and frame, per frame.

use std::fs::File;
use std::path::{Path, PathBuf};

use csv::Writer;
use unipbd_core::observe::{Diagnostics, Material, Quantity, Table, Value};
use unipbd_core::rigid::Body;

use super::{ExportError, Exporter, at, gauge_column, prepare_folder};
use crate::read::{Frame, Log};
use crate::record::Fields;

const PARTICLES: &str = "particles.csv";
const BODIES: &str = "bodies.csv";
const DIAGNOSTICS: &str = "diagnostics.csv";

/// The tables `particles.csv`, `bodies.csv` and `diagnostics.csv` in a folder; the last two only where there is
/// something to say.
pub struct Csv {
    folder: PathBuf,
    fields: Fields,
    materials: Vec<Material>,
    particles: Writer<File>,
    bodies: Option<Writer<File>>,
    diagnostics: Option<Writer<File>>,
}

impl Csv {
    /// Starts the tables.
    pub fn new(folder: &Path, replace: bool, log: &Log) -> Result<Self, ExportError> {
        prepare_folder(folder, &[PARTICLES, BODIES, DIAGNOSTICS], replace)?;
        let fields = log.fields();
        let mut columns = vec!["frame", "time", "id", "phase", "material", "x", "y"];
        columns.extend(if fields.velocity { &["velocity_x", "velocity_y"][..] } else { &[] });
        columns.extend(fields.density.then_some("density_error"));
        columns.extend(fields.temperature.then_some("temperature"));
        let particles = start(&folder.join(PARTICLES), columns)?;
        let materials = log.setting().materials.clone();
        Ok(Csv { folder: folder.to_owned(), fields, materials, particles, bodies: None, diagnostics: None })
    }

    fn add_particles(&mut self, number: u64, frame: &Frame) -> csv::Result<()> {
        let snapshot = &frame.snapshot;
        let (number, time) = (number.to_string(), snapshot.time.to_string());
        for row in 0..snapshot.positions.len() {
            let material = self.materials.get(usize::from(snapshot.materials[row])).map_or("", |of| of.name.as_str());
            let output = &mut self.particles;
            output.write_field(&number)?;
            output.write_field(&time)?;
            output.write_field(snapshot.ids[row].to_string())?;
            output.write_field(snapshot.phases[row].name())?;
            output.write_field(material)?;
            let mut number = |value: Option<f32>| output.write_field(value.map_or(String::new(), |v| v.to_string()));
            let [x, y] = snapshot.positions[row];
            number(Some(x))?;
            number(Some(y))?;
            if self.fields.velocity {
                let velocity = snapshot.velocities.as_ref().map(|values| values[row]);
                number(velocity.map(|velocity| velocity[0]))?;
                number(velocity.map(|velocity| velocity[1]))?;
            }
            if self.fields.density {
                number(snapshot.density_errors.as_ref().map(|values| values[row]))?;
            }
            if self.fields.temperature {
                number(snapshot.temperatures.as_ref().map(|values| values[row]))?;
            }
            self.particles.write_record(None::<&[u8]>)?;
        }
        Ok(())
    }

    fn add_bodies(&mut self, number: u64, frame: &Frame) -> Result<(), ExportError> {
        let snapshot = &frame.snapshot;
        if snapshot.bodies.is_empty() {
            return Ok(());
        }
        let path = self.folder.join(BODIES);
        let output = match &mut self.bodies {
            Some(output) => output,
            none => none.insert(start(&path, BODY_COLUMNS.to_vec())?),
        };
        for (id, body) in snapshot.bodies.iter().enumerate() {
            let words = [number.to_string(), snapshot.time.to_string(), id.to_string(), body.name.clone()];
            let numbers = body_numbers(body).map(|value| value.to_string());
            output.write_record(words.into_iter().chain(numbers)).map_err(io).map_err(at(&path))?;
        }
        Ok(())
    }

    fn add_diagnostics(&mut self, diagnostics: &Diagnostics) -> Result<(), ExportError> {
        let path = self.folder.join(DIAGNOSTICS);
        let output = match &mut self.diagnostics {
            Some(output) => output,
            none => none.insert(start(&path, columns_of(diagnostics))?),
        };
        let values = Diagnostics::QUANTITIES.iter().flat_map(|quantity| (quantity.read)(diagnostics).columns());
        let gauges = diagnostics.gauges.iter().map(|gauge| Value::Number(gauge.value));
        output.write_record(values.chain(gauges).map(text)).map_err(io).map_err(at(&path))
    }
}

/// Columns of the table of bodies.
pub(super) const BODY_COLUMNS: [&str; 16] = [
    "frame",
    "time",
    "id",
    "name",
    "x",
    "y",
    "angle",
    "velocity_x",
    "velocity_y",
    "angular_velocity",
    "fluid_force_x",
    "fluid_force_y",
    "fluid_torque",
    "contact_force_x",
    "contact_force_y",
    "contact_torque",
];

impl Exporter for Csv {
    fn add(&mut self, number: u64, frame: &Frame) -> Result<(), ExportError> {
        self.add_particles(number, frame).map_err(io).map_err(at(&self.folder.join(PARTICLES)))?;
        self.add_bodies(number, frame)?;
        frame.diagnostics.as_ref().map_or(Ok(()), |diagnostics| self.add_diagnostics(diagnostics))
    }

    fn finish(self: Box<Self>) -> Result<Vec<PathBuf>, ExportError> {
        let Csv { folder, particles, bodies, diagnostics, .. } = *self;
        let tables = [(PARTICLES, Some(particles)), (BODIES, bodies), (DIAGNOSTICS, diagnostics)];
        let mut written = Vec::new();
        for (name, table) in tables {
            let Some(mut table) = table else { continue };
            let path = folder.join(name);
            table.flush().map_err(at(&path))?;
            written.push(path);
        }
        Ok(written)
    }
}

fn start<C: AsRef<[u8]>>(path: &Path, columns: Vec<C>) -> Result<Writer<File>, ExportError> {
    let mut output = Writer::from_path(path).map_err(io).map_err(at(path))?;
    output.write_record(columns).map_err(io).map_err(at(path))?;
    Ok(output)
}

/// The last twelve columns of the table of bodies.
pub(super) fn body_numbers(body: &Body) -> [f64; 12] {
    let (place, velocity) = (body.position, body.velocity);
    let [fluid, contact] = [body.fluid_force, body.contact_force];
    [
        place.x,
        place.y,
        body.angle,
        velocity.x,
        velocity.y,
        body.angular_velocity,
        fluid.x,
        fluid.y,
        body.fluid_torque,
        contact.x,
        contact.y,
        body.contact_torque,
    ]
}

/// Names of the columns of the diagnostics, those of gauges at the end.
pub(super) fn columns_of(diagnostics: &Diagnostics) -> Vec<String> {
    let gauges = diagnostics.gauges.iter().map(|gauge| gauge_column(&gauge.name));
    Diagnostics::QUANTITIES.iter().flat_map(Quantity::columns).chain(gauges).collect()
}

fn io(error: csv::Error) -> std::io::Error {
    error.into()
}

fn text(value: Value<'_>) -> String {
    match value {
        Value::Count(count) => count.to_string(),
        // Empty where there is nothing to read, as pandas has it.
        Value::Number(number) if number.is_nan() => String::new(),
        Value::Number(number) => number.to_string(),
        Value::Word(word) => word.to_owned(),
        Value::Vector(_) | Value::ByPhase(_) => String::new(),
    }
}
