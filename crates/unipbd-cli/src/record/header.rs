use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use unipbd_core::math::Vector64;
use unipbd_core::observe::{Material, WallOutline};
use unipbd_core::phase::Phase;

use super::Fields;
use crate::snapshot::Setting;

/// Name of the metadata record of a log.
pub(crate) const METADATA: &str = "unipbd";
/// Version of the format of logs: it is raised when an older reader would misread a log.
///
/// Logs of this version and of all before are read, newer ones are refused. Logs without the entry are of version 1;
/// a reader passes over unknown data (topics, fields, entries), so that additions raise nothing.
pub(crate) const LOG_FORMAT: u32 = 1;
/// The entry of the metadata with that version.
const FORMAT_ENTRY: &str = "log_format";
/// Name of the attachment that holds the scene.
pub(crate) const SCENE_ATTACHMENT: &str = "scene.toml";

/// Data that a log holds once: the scene, its changes, and the data besides frames that a picture needs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Constant data of the run.
    pub setting: Setting,
    /// Text of the scene file, as read.
    pub scene_text: String,
    /// Changes to the scene from the command line, `key=value`, in order.
    pub overrides: Vec<String>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Frames per simulated second [1/s].
    pub fps: f64,
    /// Gravitational acceleration [m/s^2].
    pub gravity: [f64; 2],
    /// Names of the gauges, in the order in which the diagnostics have them.
    pub gauges: Vec<String>,
}

impl Header {
    /// Length of a frame \[s].
    pub fn dt(&self) -> f64 {
        1.0 / self.fps
    }

    /// SHA-256 of the scene text, as hexadecimal digits.
    pub fn scene_sha256(&self) -> String {
        hexadecimal_sha256(self.scene_text.as_bytes())
    }

    /// SHA-256 of everything that the run follows from, as hexadecimal digits: the same for the same run.
    pub fn run_sha256(&self) -> String {
        hexadecimal_sha256(json(&self.to_metadata(Fields::default())).as_bytes())
    }

    /// The metadata record of a log with these fields.
    pub(crate) fn to_metadata(&self, fields: Fields) -> BTreeMap<String, String> {
        let materials: Vec<MaterialEntry> = self.setting.materials.iter().map(MaterialEntry::from).collect();
        let walls: Vec<WallEntry> = self.setting.walls.iter().map(WallEntry::from).collect();
        let mut entries = BTreeMap::from([
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            (FORMAT_ENTRY, LOG_FORMAT.to_string()),
            ("name", self.setting.name.clone()),
            ("scene_sha256", self.scene_sha256()),
            ("overrides", json(&self.overrides)),
            ("seed", self.seed.to_string()),
            ("dt", self.dt().to_string()),
            ("fps", self.fps.to_string()),
            ("gravity", json(&self.gravity)),
            ("spacing", self.setting.spacing.to_string()),
            ("fields", fields.to_string()),
            ("materials", json(&materials)),
            ("walls", json(&walls)),
        ]);
        if !self.gauges.is_empty() {
            entries.insert("gauges", json(&self.gauges));
        }
        if let Some(view) = &self.setting.view {
            entries.insert("view", json(view));
        }
        entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
    }

    /// Reads a metadata record back; the error names the entry that is missing or wrong.
    pub(crate) fn from_metadata(
        entries: &BTreeMap<String, String>,
        scene_text: String,
    ) -> Result<(Header, Fields), String> {
        let entries = Entries(entries);
        let materials: Vec<MaterialEntry> = entries.json("materials")?;
        let walls: Vec<WallEntry> = entries.json("walls")?;
        let setting = Setting {
            name: entries.text("name")?.to_owned(),
            spacing: entries.parse("spacing")?,
            materials: materials.into_iter().map(MaterialEntry::into_material).collect::<Result<_, _>>()?,
            walls: walls.into_iter().map(WallEntry::into_outline).collect(),
            view: if entries.0.contains_key("view") { Some(entries.json("view")?) } else { None },
        };
        let header = Header {
            setting,
            scene_text,
            overrides: entries.json("overrides")?,
            seed: entries.parse("seed")?,
            fps: entries.parse("fps")?,
            gravity: entries.json("gravity")?,
            gauges: if entries.0.contains_key("gauges") { entries.json("gauges")? } else { Vec::new() },
        };
        Ok((header, entries.parse("fields")?))
    }
}

fn hexadecimal_sha256(bytes: &[u8]) -> String {
    let mut digits = String::with_capacity(64);
    for byte in Sha256::digest(bytes) {
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

/// Version of the format of a log.
pub(crate) fn log_format(entries: &BTreeMap<String, String>) -> Result<u32, String> {
    if entries.contains_key(FORMAT_ENTRY) { Entries(entries).parse(FORMAT_ENTRY) } else { Ok(1) }
}

/// The entries of a metadata record, with errors that name them.
struct Entries<'a>(&'a BTreeMap<String, String>);

impl Entries<'_> {
    fn text(&self, key: &str) -> Result<&str, String> {
        self.0.get(key).map(String::as_str).ok_or_else(|| format!("its metadata has no \"{key}\""))
    }

    fn parse<T: std::str::FromStr>(&self, key: &str) -> Result<T, String> {
        let text = self.text(key)?;
        text.parse().map_err(|_| format!("its metadata has a damaged \"{key}\""))
    }

    fn json<T: for<'de> Deserialize<'de>>(&self, key: &str) -> Result<T, String> {
        serde_json::from_str(self.text(key)?).map_err(|_| format!("its metadata has a damaged \"{key}\""))
    }
}

/// Plain numbers and strings always have a JSON form.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

#[derive(Serialize, Deserialize)]
struct MaterialEntry {
    name: String,
    phase: String,
    density: f64,
    color: [u8; 3],
}

impl From<&Material> for MaterialEntry {
    fn from(material: &Material) -> Self {
        MaterialEntry {
            name: material.name.clone(),
            phase: material.phase.name().to_owned(),
            density: material.density,
            color: material.color,
        }
    }
}

impl MaterialEntry {
    fn into_material(self) -> Result<Material, String> {
        let phase = Phase::ALL.into_iter().find(|phase| phase.name() == self.phase);
        let phase =
            phase.ok_or_else(|| format!("material \"{}\" has the unknown phase \"{}\"", self.name, self.phase))?;
        Ok(Material { name: self.name, phase, density: self.density, color: self.color })
    }
}

#[derive(Serialize, Deserialize)]
struct WallEntry {
    points: Vec<[f64; 2]>,
    closed: bool,
    endless: bool,
}

impl From<&WallOutline> for WallEntry {
    fn from(wall: &WallOutline) -> Self {
        let points = wall.points.iter().map(|point| point.to_array()).collect();
        WallEntry { points, closed: wall.closed, endless: wall.endless }
    }
}

impl WallEntry {
    fn into_outline(self) -> WallOutline {
        let points = self.points.into_iter().map(Vector64::from).collect();
        WallOutline { points, closed: self.closed, endless: self.endless }
    }
}
