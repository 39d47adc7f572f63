use serde::{Deserialize, Serialize};

/// What a scene is expected to do: `unipbd expect` runs it and names every line that does not hold.
/// What is left out is not checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// Largest mean density error over the run, after `settled`, as a fraction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_error_mean: Option<f64>,
    /// Largest density error of any particle over the run, after `settled`, as a fraction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_error_max: Option<f64>,
    /// Time from which density errors count \[s].
    pub settled: f64,
    /// Largest growth of the energy over its start, as a fraction of the energy that the start can
    /// give away: kinetic, and potential above the lowest point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_growth: Option<f64>,
    /// Whether every particle and body stays out of the walls at all times.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contained: Option<bool>,
    /// Most substeps in any frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub substeps_max: Option<u32>,
    /// Largest speed of any particle or body at any frame [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_max: Option<f64>,
    /// Materials at the end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub material: Vec<MaterialExpectation>,
    /// Bodies at the end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub body: Vec<BodyExpectation>,
}

/// What is expected of a material at the end. Ranges are `[from, to]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct MaterialExpectation {
    /// Its name.
    pub name: String,
    /// Number of particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<[f64; 2]>,
    /// Mean x of its particles \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_x: Option<[f64; 2]>,
    /// Mean y of its particles \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_y: Option<[f64; 2]>,
    /// The y that a twentieth of its particles lie above \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high_y: Option<[f64; 2]>,
}

/// What is expected of a body at the end. Ranges are `[from, to]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct BodyExpectation {
    /// Its name; a name with copies stands for each of them.
    pub name: String,
    /// x of its centre of mass \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<[f64; 2]>,
    /// y of its centre of mass \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<[f64; 2]>,
    /// Rotation, counter-clockwise, whole turns included \[degrees].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<[f64; 2]>,
    /// Speed of its centre of mass [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<[f64; 2]>,
    /// Angular velocity, counter-clockwise [degrees/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_deg: Option<[f64; 2]>,
}
