//! A page that plays a run in any browser: one file, no server.
//!
//! The page holds a description of the scene as JSON and its frames as gzip in base64. A frame is the number of particles
//! (u32) and a mark of whether they are those of the frame before; if not, the row that each had there (the largest
//! for a new one; as a u32 that is added to the row of the particle before plus one) and its material (u8). Then, for x and y, how far each particle is from where it would be had it gone
//! on as before, in quanta, folded to an unsigned number (0, -1, 1, -2 ...) of 16 bits: all low bytes, then all high
//! ones. Then a byte per particle for each recorded column, and x, y and angle of each body (f32, NaN for one that is
//! gone).

mod describe;
mod motion;

use std::io::Write;
use std::path::Path;

use base64::Engine as _;
use flate2::Compression;
use flate2::write::GzEncoder;

use super::error::RenderError;
use super::options::RenderOptions;
use super::view::View;
use crate::snapshot::{Setting, Snapshot};
use describe::Description;
use motion::Motion;

const PAGE: &str = include_str!("page.html");
const PLAYER: &str = include_str!("player.js");

/// Frames a second of simulated time in a page, at most: it draws what is between them.
pub(super) const MOST_FPS: f64 = 30.0;

/// Collects frames and writes them as a page.
pub(super) struct Replay<'a> {
    setting: &'a Setting,
    options: &'a RenderOptions,
    motion: Motion,
    times: Vec<f64>,
    /// Bodies of the frame that had most of them: their shapes.
    bodies: Vec<unipbd_core::rigid::Body>,
    poses: Vec<Vec<[f32; 3]>>,
    columns: [Column; 2],
}

/// A recorded column of all frames.
struct Column {
    name: &'static str,
    unit: &'static str,
    factor: f32,
    values: Vec<Vec<f32>>,
    recorded: bool,
}

impl<'a> Replay<'a> {
    /// A page of this region.
    pub fn new(setting: &'a Setting, options: &'a RenderOptions, view: View) -> Replay<'a> {
        let column = |name, unit, factor| Column { name, unit, factor, values: Vec::new(), recorded: false };
        Replay {
            setting,
            options,
            motion: Motion::new(view, setting.spacing),
            times: Vec::new(),
            bodies: Vec::new(),
            poses: Vec::new(),
            columns: [column("density error", "%", 100.0), column("temperature", "", 1.0)],
        }
    }

    /// Adds a frame.
    pub fn push(&mut self, frame: &Snapshot) {
        self.times.push(frame.time);
        self.motion.push(frame);
        if frame.bodies.len() > self.bodies.len() {
            self.bodies.clone_from(&frame.bodies);
        }
        let pose = |body: &unipbd_core::rigid::Body| {
            let there = if body.removed { f64::NAN } else { 1.0 };
            [body.position.x * there, body.position.y * there, body.angle * there].map(|value| value as f32)
        };
        self.poses.push(frame.bodies.iter().map(pose).collect());
        let recorded = [&frame.density_errors, &frame.temperatures];
        for (column, values) in self.columns.iter_mut().zip(recorded) {
            let values = values.as_ref().filter(|values| values.len() == frame.positions.len());
            column.recorded |= values.is_some();
            column.values.push(values.map_or_else(|| vec![0.0; frame.positions.len()], Clone::clone));
        }
    }

    /// Number of frames.
    pub fn frames(&self) -> u64 {
        self.times.len() as u64
    }

    /// Writes the page, with a mark of where it comes from.
    pub fn finish(self, path: &Path, mark: &str) -> Result<(), RenderError> {
        let failed = |source| RenderError::Write { path: path.to_owned(), source };
        let columns: Vec<&Column> = self.columns.iter().filter(|column| column.recorded).collect();
        let ranges: Vec<[f32; 2]> = columns.iter().map(|column| column.range()).collect();
        let described = Description {
            setting: self.setting,
            options: self.options,
            motion: &self.motion,
            times: &self.times,
            bodies: &self.bodies,
        };
        let shown = columns.iter().zip(&ranges).map(|(column, range)| {
            serde_json::json!({
                "name": column.name, "unit": column.unit, "range": range.map(|end| f64::from(end * column.factor)),
            })
        });
        let head = described.json(shown.collect());
        let data = self.packed(&columns, &ranges).map_err(failed)?;
        // A closing tag inside the text would end it.
        let head = head.to_string().replace("</", "<\\/");
        let page =
            PAGE.replace("@MARK@", mark).replace("@PLAYER@", PLAYER).replace("@HEAD@", &head).replace("@DATA@", &data);
        std::fs::write(path, page).map_err(failed)
    }

    fn packed(&self, columns: &[&Column], ranges: &[[f32; 2]]) -> std::io::Result<String> {
        let mut output = GzEncoder::new(Vec::new(), Compression::best());
        for number in 0..self.times.len() {
            output.write_all(self.motion.frame(number))?;
            for (column, [low, high]) in columns.iter().zip(ranges) {
                let byte = |value: &f32| (255.0 * (value - low) / (high - low)).clamp(0.0, 255.0).round() as u8;
                let bytes: Vec<u8> = column.values[number].iter().map(byte).collect();
                output.write_all(&bytes)?;
            }
            let there = self.poses[number].iter().copied().chain(std::iter::repeat([f32::NAN; 3]));
            for value in there.take(self.bodies.len()).flatten() {
                output.write_all(&value.to_le_bytes())?;
            }
        }
        Ok(base64::engine::general_purpose::STANDARD.encode(output.finish()?))
    }
}

impl Column {
    /// Ends of the colours: all but the outermost percent at either end of every tenth value.
    fn range(&self) -> [f32; 2] {
        let mut some: Vec<f32> = self.values.iter().flatten().step_by(10).copied().filter(|v| v.is_finite()).collect();
        some.sort_unstable_by(f32::total_cmp);
        let Some(last) = some.len().checked_sub(1) else { return [0.0, 1.0] };
        let [low, high] = [some[last / 100], some[last - last / 100]];
        if low < high { [low, high] } else { [low, low + 1.0] }
    }
}
