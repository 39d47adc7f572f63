use serde::{Deserialize, Serialize};

/// Most samples of a motion or an acceleration.
pub const MOST_SAMPLES: usize = 100_000;

/// Script of a kinematic body: one kind of motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MotionDescription {
    /// Constant velocity [m/s].
    pub velocity: [f64; 2],
    /// Constant angular velocity, counter-clockwise [degrees/s].
    pub spin_deg: f64,
    /// Largest displacement of an oscillation [m].
    pub amplitude: [f64; 2],
    /// Largest rotation of an oscillation [degrees].
    pub swing_deg: f64,
    /// Frequency of the oscillation [1/s].
    pub frequency: f64,
    /// Phase of the oscillation at time 0 [degrees].
    pub phase_deg: f64,
    /// Stations of a path by increasing time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<Station>,
    /// Begins the path anew after its last station.
    pub repeat_path: bool,
    /// CSV file of a smooth motion, beside the scene file. Its first line names the columns: `time`, and one or more of
    /// `x`, `y` and `angle_deg`, in the units of `table`.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// Samples of a smooth motion, in place of a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<MotionTable>,
}

/// A station of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// When [s].
    pub time: f64,
    /// Displacement from the start [m].
    #[serde(default)]
    pub offset: [f64; 2],
    /// Rotation from the start [degrees].
    #[serde(default)]
    pub turn_deg: f64,
}

/// Samples of a motion. Between them it is smooth: cubics whose slopes at a sample are those of the parabola through it
/// and its neighbours, so that velocities are continuous. It rests before the first and after the last, and between two
/// that are equal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MotionTable {
    /// Times, increasing [s].
    pub time: Vec<f64>,
    /// Displacements from the start, along x; left out, none [m].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<f64>,
    /// Displacements from the start, along y; left out, none [m].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub y: Vec<f64>,
    /// Rotations from the start; left out, none [degrees].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub angle_deg: Vec<f64>,
}

/// An acceleration that is added to gravity over time: of a tank that is shaken, seen from within. A tank that moves
/// with the acceleration a feels -a.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Shaking {
    /// CSV file, beside the scene file. Its first line names the columns: `time`, and `ax`, `ay` or both, in the units of
    /// `table`.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub file: String,
    /// Samples, in place of a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<AccelerationTable>,
}

/// Samples of an acceleration, smooth between them as those of a motion; the first holds before, the last behind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct AccelerationTable {
    /// Times, increasing [s].
    pub time: Vec<f64>,
    /// Accelerations along x; left out, none [m/s^2].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ax: Vec<f64>,
    /// Accelerations along y; left out, none [m/s^2].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ay: Vec<f64>,
}

impl MotionTable {
    /// The columns beside time, with their names.
    pub(crate) fn columns(&self) -> [(&'static str, &[f64]); 3] {
        [("x", &self.x), ("y", &self.y), ("angle_deg", &self.angle_deg)]
    }
}

impl AccelerationTable {
    /// The columns beside time, with their names.
    pub(crate) fn columns(&self) -> [(&'static str, &[f64]); 2] {
        [("ax", &self.ax), ("ay", &self.ay)]
    }
}
