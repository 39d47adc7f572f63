//! Arrays of NumPy in one file.
//!
//! | array | shape | type | |
//! |---|---|---|---|
//! | `time` | (T,) | f64 | simulated time [s] |
//! | `position` | (T, N, 2) | f32 | places [m]; NaN where a particle is not there |
//! | `velocity`, `density_error`, `temperature` | (T, N, 2), (T, N), (T, N) | f32 | what the log was asked to hold |
//! | `id`, `phase`, `material` | (N,) | u32, u8, u16 | of each column; the phase by its number |
//! | `body_pose`, `body_velocity` | (T, B, 3) | f64 | x, y, angle, and their rates |
//! | a quantity of the diagnostics | (T,) | f64 | as `kinetic_energy` |
//! | `gauge_NAME` | (T,) | f64 | the reading of a gauge; NaN where it has nothing to read |

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use npyz::{AutoSerialize, WriterBuilder};
use unipbd_core::observe::{Diagnostics, Table};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::{ExportError, Exporter, at, gauge_column};
use crate::read::Frame;

/// All frames in memory, written at the end.
pub struct Npz {
    path: PathBuf,
    /// Column of each id, with its phase and material.
    columns: BTreeMap<u32, Column>,
    frames: Vec<Held>,
}

#[derive(Clone, Copy)]
struct Column {
    phase: u8,
    material: u16,
}

/// A frame without what all share.
struct Held {
    time: f64,
    ids: Vec<u32>,
    position: Vec<[f32; 2]>,
    velocity: Option<Vec<[f32; 2]>>,
    density_error: Option<Vec<f32>>,
    temperature: Option<Vec<f32>>,
    pose: Vec<[f64; 3]>,
    motion: Vec<[f64; 3]>,
    diagnostics: Option<Diagnostics>,
}

impl Npz {
    /// Starts an archive.
    pub fn new(path: &Path, replace: bool) -> Result<Self, ExportError> {
        if !replace && path.symlink_metadata().is_ok() {
            return Err(ExportError::Exists(path.to_owned()));
        }
        Ok(Npz { path: path.to_owned(), columns: BTreeMap::new(), frames: Vec::new() })
    }

    fn write(&self, path: &Path) -> std::io::Result<()> {
        let mut archive = Archive(ZipWriter::new(BufWriter::new(File::create(path)?)));
        let (times, count) = (self.frames.len() as u64, self.columns.len() as u64);
        archive.add("time", &[times], self.frames.iter().map(|frame| frame.time))?;
        archive.add("id", &[count], self.columns.keys().copied())?;
        archive.add("phase", &[count], self.columns.values().map(|column| column.phase))?;
        archive.add("material", &[count], self.columns.values().map(|column| column.material))?;
        let pairs = [times, count, 2];
        let positions = |frame: &Held| Some(frame.position.clone());
        archive.add("position", &pairs, self.by_id(positions, [f32::NAN; 2]).into_iter().flatten())?;
        if self.frames.iter().any(|frame| frame.velocity.is_some()) {
            let values = self.by_id(|frame| frame.velocity.clone(), [f32::NAN; 2]);
            archive.add("velocity", &pairs, values.into_iter().flatten())?;
        }
        let scalars: [(&str, fn(&Held) -> Option<Vec<f32>>); 2] = [
            ("density_error", |frame| frame.density_error.clone()),
            ("temperature", |frame| frame.temperature.clone()),
        ];
        for (name, of) in scalars {
            if self.frames.iter().any(|frame| of(frame).is_some()) {
                archive.add(name, &pairs[..2], self.by_id(of, f32::NAN))?;
            }
        }
        self.write_bodies(&mut archive, times)?;
        self.write_diagnostics(&mut archive, times)?;
        archive.finish()
    }

    fn write_bodies(&self, archive: &mut Archive, times: u64) -> std::io::Result<()> {
        let most = self.frames.iter().map(|frame| frame.pose.len()).max().unwrap_or(0);
        if most == 0 {
            return Ok(());
        }
        let shape = [times, most as u64, 3];
        let padded = |of: fn(&Held) -> &Vec<[f64; 3]>| {
            let rows = self.frames.iter().flat_map(move |frame| {
                let there = of(frame).iter().copied();
                there.chain(std::iter::repeat([f64::NAN; 3])).take(most)
            });
            rows.flatten()
        };
        archive.add("body_pose", &shape, padded(|frame| &frame.pose))?;
        archive.add("body_velocity", &shape, padded(|frame| &frame.motion))
    }

    /// The numbers of the diagnostics; words are left out.
    fn write_diagnostics(&self, archive: &mut Archive, times: u64) -> std::io::Result<()> {
        if self.frames.iter().all(|frame| frame.diagnostics.is_none()) {
            return Ok(());
        }
        for quantity in Diagnostics::QUANTITIES.iter().filter(|quantity| quantity.name != "time") {
            for (place, name) in quantity.columns().into_iter().enumerate() {
                let value = |frame: &Held| {
                    let values = (quantity.read)(frame.diagnostics.as_ref()?).columns();
                    values.get(place)?.number()
                };
                if self.frames.iter().any(|frame| value(frame).is_some()) {
                    archive.add(&name, &[times], self.frames.iter().map(|frame| value(frame).unwrap_or(f64::NAN)))?;
                }
            }
        }
        let gauges = |frame: &Held| frame.diagnostics.as_ref().map_or(0, |found| found.gauges.len());
        let Some(widest) = self.frames.iter().max_by_key(|frame| gauges(frame)) else { return Ok(()) };
        for (place, gauge) in widest.diagnostics.iter().flat_map(|found| &found.gauges).enumerate() {
            let value = |frame: &Held| Some(frame.diagnostics.as_ref()?.gauges.get(place)?.value);
            let values = self.frames.iter().map(|frame| value(frame).unwrap_or(f64::NAN));
            archive.add(&gauge_column(&gauge.name), &[times], values)?;
        }
        Ok(())
    }

    /// Values of all frames in the order of the ids, `missing` where a particle or a column is not there.
    fn by_id<T: Copy>(&self, of: impl Fn(&Held) -> Option<Vec<T>>, missing: T) -> Vec<T> {
        let mut all = Vec::with_capacity(self.frames.len() * self.columns.len());
        for frame in &self.frames {
            let values = of(frame).unwrap_or_default();
            let mut there = frame.ids.iter().zip(values).peekable();
            for id in self.columns.keys() {
                let found = there.next_if(|(other, _)| *other == id);
                all.push(found.map_or(missing, |(_, value)| value));
            }
        }
        all
    }
}

impl Exporter for Npz {
    fn add(&mut self, _number: u64, frame: &Frame) -> Result<(), ExportError> {
        // The reader gives particles in the order of their ids.
        let snapshot = &frame.snapshot;
        for (row, &id) in snapshot.ids.iter().enumerate() {
            let column = Column { phase: snapshot.phases[row] as u8, material: snapshot.materials[row] };
            self.columns.insert(id, column);
        }
        let bodies = snapshot.bodies.iter();
        self.frames.push(Held {
            time: snapshot.time,
            ids: snapshot.ids.clone(),
            position: snapshot.positions.clone(),
            velocity: snapshot.velocities.clone(),
            density_error: snapshot.density_errors.clone(),
            temperature: snapshot.temperatures.clone(),
            pose: bodies.clone().map(|body| [body.position.x, body.position.y, body.angle]).collect(),
            motion: bodies.map(|body| [body.velocity.x, body.velocity.y, body.angular_velocity]).collect(),
            diagnostics: frame.diagnostics.clone(),
        });
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<Vec<PathBuf>, ExportError> {
        if let Some(folder) = self.path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(at(folder))?;
        }
        let partial = self.path.with_extension("npz.partial");
        self.write(&partial).map_err(at(&partial))?;
        fs::rename(&partial, &self.path).map_err(at(&self.path))?;
        Ok(vec![self.path.clone()])
    }
}

/// An archive being written.
struct Archive(ZipWriter<BufWriter<File>>);

impl Archive {
    fn add<T: AutoSerialize>(
        &mut self,
        name: &str,
        shape: &[u64],
        values: impl IntoIterator<Item = T>,
    ) -> std::io::Result<()> {
        // A fixed date: the same log gives the same bytes.
        let options = SimpleFileOptions::default().large_file(true).last_modified_time(zip::DateTime::default());
        self.0.start_file(format!("{name}.npy"), options)?;
        let array = npyz::WriteOptions::new().default_dtype().shape(shape).writer(&mut self.0);
        let mut array = array.begin_nd()?;
        array.extend(values)?;
        array.finish()
    }

    fn finish(self) -> std::io::Result<()> {
        self.0.finish()?.into_inner().map_err(std::io::IntoInnerError::into_error)?.sync_all()
    }
}
