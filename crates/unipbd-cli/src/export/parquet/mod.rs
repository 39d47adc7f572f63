//! Tables in columns, for pandas, Polars, DuckDB and Spark: those of [`Csv`](super::Csv), typed and compressed.

mod sheet;

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result};
use unipbd_core::observe::{Diagnostics, Material, Table, Value};

use super::csv::{BODY_COLUMNS, body_numbers, columns_of};
use super::{ExportError, Exporter, at, prepare_folder};
use crate::read::{Frame, Log};
use crate::record::Fields;
use sheet::{Cell, Column, Sheet};

const PARTICLES: &str = "particles.parquet";
const BODIES: &str = "bodies.parquet";
const DIAGNOSTICS: &str = "diagnostics.parquet";

/// The tables `particles.parquet`, `bodies.parquet` and `diagnostics.parquet` in a folder; the last two only where
/// there is something to say. Numbers that are not there are NaN.
pub struct Parquet {
    folder: PathBuf,
    fields: Fields,
    materials: Vec<Material>,
    particles: Sheet,
    bodies: Option<Sheet>,
    diagnostics: Option<Sheet>,
}

impl Parquet {
    /// Starts the tables.
    pub fn new(folder: &Path, replace: bool, log: &Log) -> std::result::Result<Self, ExportError> {
        prepare_folder(folder, &[PARTICLES, BODIES, DIAGNOSTICS], replace)?;
        let fields = log.fields();
        let float = || Column::Float(Vec::new());
        let mut columns = vec![
            ("frame", Column::Long(Vec::new())),
            ("time", Column::Double(Vec::new())),
            ("id", Column::Id(Vec::new())),
            ("phase", Column::Text(Vec::new())),
            ("material", Column::Text(Vec::new())),
            ("x", float()),
            ("y", float()),
        ];
        columns
            .extend(["velocity_x", "velocity_y"].into_iter().filter(|_| fields.velocity).map(|name| (name, float())));
        columns.extend(fields.density.then(|| ("density_error", float())));
        columns.extend(fields.temperature.then(|| ("temperature", float())));
        let columns = columns.into_iter().map(|(name, column)| (name.to_owned(), column));
        let particles = start(&folder.join(PARTICLES), columns.collect())?;
        let materials = log.setting().materials.clone();
        Ok(Parquet { folder: folder.to_owned(), fields, materials, particles, bodies: None, diagnostics: None })
    }

    fn add_particles(&mut self, number: u64, frame: &Frame) -> Result<()> {
        let snapshot = &frame.snapshot;
        let names: Vec<ByteArray> = self.materials.iter().map(|material| material.name.as_str().into()).collect();
        for row in 0..snapshot.positions.len() {
            let material = names.get(usize::from(snapshot.materials[row])).cloned();
            let [x, y] = snapshot.positions[row];
            let mut cells = self.particles.cells();
            cells.put(Cell::Long(number))?;
            cells.put(Cell::Double(snapshot.time))?;
            cells.put(Cell::Id(snapshot.ids[row]))?;
            cells.put(Cell::Text(snapshot.phases[row].name().into()))?;
            cells.put(Cell::Text(material.unwrap_or_else(|| "".into())))?;
            cells.put(Cell::Float(x))?;
            cells.put(Cell::Float(y))?;
            if self.fields.velocity {
                let velocity = snapshot.velocities.as_ref().map_or([f32::NAN; 2], |values| values[row]);
                velocity.into_iter().try_for_each(|part| cells.put(Cell::Float(part)))?;
            }
            let scalars =
                [(self.fields.density, &snapshot.density_errors), (self.fields.temperature, &snapshot.temperatures)];
            for (_, values) in scalars.into_iter().filter(|(asked, _)| *asked) {
                cells.put(Cell::Float(values.as_ref().map_or(f32::NAN, |values| values[row])))?;
            }
            self.particles.end_row()?;
        }
        Ok(())
    }

    fn add_bodies(&mut self, number: u64, frame: &Frame) -> std::result::Result<(), ExportError> {
        let snapshot = &frame.snapshot;
        if snapshot.bodies.is_empty() {
            return Ok(());
        }
        let path = self.folder.join(BODIES);
        let sheet = match &mut self.bodies {
            Some(sheet) => sheet,
            none => none.insert(start(&path, BODY_COLUMNS.map(|name| (name.to_owned(), body_column(name))).to_vec())?),
        };
        for (id, body) in (0_u32..).zip(&snapshot.bodies) {
            let words =
                [Cell::Long(number), Cell::Double(snapshot.time), Cell::Id(id), Cell::Text((*body.name).into())];
            let numbers = body_numbers(body).map(Cell::Double);
            sheet.add(words.into_iter().chain(numbers)).map_err(io).map_err(at(&path))?;
        }
        Ok(())
    }

    fn add_diagnostics(&mut self, diagnostics: &Diagnostics) -> std::result::Result<(), ExportError> {
        let path = self.folder.join(DIAGNOSTICS);
        let values = || Diagnostics::QUANTITIES.iter().flat_map(|quantity| (quantity.read)(diagnostics).columns());
        let gauges = || diagnostics.gauges.iter().map(|gauge| Value::Number(gauge.value));
        let sheet = match &mut self.diagnostics {
            Some(sheet) => sheet,
            none => {
                let kinds = values().chain(gauges()).map(|value| Column::of(&value));
                none.insert(start(&path, columns_of(diagnostics).into_iter().zip(kinds).collect())?)
            }
        };
        sheet.add(values().chain(gauges()).map(Cell::of)).map_err(io).map_err(at(&path))
    }
}

impl Exporter for Parquet {
    fn add(&mut self, number: u64, frame: &Frame) -> std::result::Result<(), ExportError> {
        self.add_particles(number, frame).map_err(io).map_err(at(&self.folder.join(PARTICLES)))?;
        self.add_bodies(number, frame)?;
        frame.diagnostics.as_ref().map_or(Ok(()), |diagnostics| self.add_diagnostics(diagnostics))
    }

    fn finish(self: Box<Self>) -> std::result::Result<Vec<PathBuf>, ExportError> {
        let Parquet { folder, particles, bodies, diagnostics, .. } = *self;
        let sheets = [(PARTICLES, Some(particles)), (BODIES, bodies), (DIAGNOSTICS, diagnostics)];
        let mut written = Vec::new();
        for (name, sheet) in sheets {
            let Some(sheet) = sheet else { continue };
            let path = folder.join(name);
            sheet.finish().map_err(io).map_err(at(&path))?;
            written.push(path);
        }
        Ok(written)
    }
}

fn start(path: &Path, columns: Vec<(String, Column)>) -> std::result::Result<Sheet, ExportError> {
    let file = File::create(path).map_err(at(path))?;
    Sheet::new(file, columns).map_err(io).map_err(at(path))
}

fn body_column(name: &str) -> Column {
    match name {
        "frame" => Column::Long(Vec::new()),
        "id" => Column::Id(Vec::new()),
        "name" => Column::Text(Vec::new()),
        _ => Column::Double(Vec::new()),
    }
}

fn io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(cause) => match cause.downcast::<io::Error>() {
            Ok(cause) => *cause,
            Err(cause) => io::Error::other(cause),
        },
        other => io::Error::other(other),
    }
}
