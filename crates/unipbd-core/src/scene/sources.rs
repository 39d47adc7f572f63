use serde::{Deserialize, Serialize};

/// A rectangle filled with a lattice of particles at the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Name of the material.
    pub material: String,
    /// Lower left corner \[m]; the first particle sits half a spacing inside. Particles inside bodies are left out.
    pub min: [f64; 2],
    /// Upper right corner \[m].
    pub max: [f64; 2],
    /// Velocity at the start [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Random displacement of each particle, as a fraction of the spacing.
    #[serde(default)]
    pub jitter: f64,
    /// Temperature at the start (gas).
    #[serde(default)]
    pub temperature: f64,
}

/// A disc filled with a lattice of particles at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Name of the material.
    pub material: String,
    /// Centre \[m].
    pub center: [f64; 2],
    /// Radius \[m].
    pub radius: f64,
    /// Velocity at the start [m/s].
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Random displacement of each particle, as a fraction of the spacing.
    #[serde(default)]
    pub jitter: f64,
    /// Temperature at the start (gas).
    #[serde(default)]
    pub temperature: f64,
}

/// A straight nozzle that pushes rows of particles across its face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Emitter {
    /// Name used in messages and logs; left out, the emitter's number.
    #[serde(default)]
    pub name: String,
    /// Name of the material that is emitted.
    pub material: String,
    /// Middle of the face \[m].
    pub position: [f64; 2],
    /// Direction of the flow; need not have length 1.
    #[serde(default = "up")]
    pub direction: [f64; 2],
    /// Width of the face without the sheath \[m].
    ///
    /// The columns of particles are a whole number; they move apart or together, and their rows the other way, so that
    /// the flow is that of the width.
    pub width: f64,
    /// Speed at the face [m/s].
    pub speed: f64,
    /// Shape of the speed across the face.
    #[serde(default)]
    pub profile: Profile,
    /// Temperature of the emitted gas; 1 is hot, 0 is ambient.
    #[serde(default)]
    pub temperature: f64,
    /// Random displacement of emitted particles, as a fraction of the spacing.
    #[serde(default = "emitter_jitter")]
    pub jitter: f64,
    /// Time at which it starts \[s].
    #[serde(default)]
    pub start: f64,
    /// Time at which it stops \[s]; left out, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Slows down when the fluid ahead of the face is compressed.
    #[serde(default = "yes")]
    pub throttle: bool,
    /// A layer of the same material on both sides of the core.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sheath: Option<Sheath>,
    /// Smoke markers emitted with the core.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smoke: Option<SmokeSource>,
}

/// Shape of the speed across the face of an emitter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// The same speed everywhere.
    #[default]
    Uniform,
    /// `speed` in the middle, falling to half of it at the edges as a parabola.
    Parabolic,
}

/// A layer of carrier on both sides of an emitter's core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sheath {
    /// Thickness on each side \[m].
    pub thickness: f64,
    /// Speed at the face [m/s]; left out, the speed of the core.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Temperature of the emitted gas.
    #[serde(default)]
    pub temperature: f64,
}

/// Smoke markers emitted with the core of an emitter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SmokeSource {
    /// Name of the smoke.
    pub material: String,
    /// Markers for each particle of the core.
    #[serde(default = "markers_per_particle")]
    pub per_particle: u32,
}

impl Emitter {
    /// A nozzle that blows upwards from its middle \[m], this wide \[m] and at this speed [m/s], from the start on.
    pub fn new(material: &str, position: [f64; 2], width: f64, speed: f64) -> Self {
        Emitter {
            name: String::new(),
            material: material.to_owned(),
            position,
            direction: up(),
            width,
            speed,
            profile: Profile::default(),
            temperature: 0.0,
            jitter: emitter_jitter(),
            start: 0.0,
            stop: None,
            throttle: yes(),
            sheath: None,
            smoke: None,
        }
    }

    /// Columns of particles across the core, and their distance \[m], for this spacing \[m]. Their number is whole; their
    /// distance makes up for it, so that the flow is that of the width.
    pub fn columns(&self, spacing: f64) -> (usize, f64) {
        columns(self.width, spacing)
    }

    /// The same for each side of the sheath.
    pub(crate) fn sheath_columns(&self, spacing: f64) -> (usize, f64) {
        match &self.sheath {
            Some(sheath) if sheath.thickness >= 0.5 * spacing => columns(sheath.thickness, spacing),
            _ => (0, spacing),
        }
    }

    /// Speed of the sheath [m/s]: its own, or that of the core.
    pub(crate) fn sheath_speed(&self) -> f64 {
        self.sheath.as_ref().and_then(|sheath| sheath.speed).unwrap_or(self.speed)
    }
}

/// Columns closer than half a spacing would stand a row apart that no neighbour reaches.
fn columns(width: f64, spacing: f64) -> (usize, f64) {
    let count = (width / spacing).round().max(1.0);
    let exact = (width / spacing - count).abs() < 1e-9 * count;
    (count as usize, if exact { spacing } else { (width / count).max(0.5 * spacing) })
}

fn up() -> [f64; 2] {
    [0.0, 1.0]
}

fn emitter_jitter() -> f64 {
    0.05
}

fn yes() -> bool {
    true
}

fn markers_per_particle() -> u32 {
    4
}
