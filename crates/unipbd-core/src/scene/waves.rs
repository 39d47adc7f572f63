use serde::{Deserialize, Serialize};

/// A wave in the outlines of all blocks at the start: they are filled up to where the potential-flow mode
/// cos(2 pi x/wavelength + phase) would have moved them. The lattice within stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Height of the surface or interface that becomes wavy \[m].
    pub level: f64,
    /// Amplitude there, at least one spacing: the lattice shows no less \[m].
    pub amplitude: f64,
    /// Wavelength \[m].
    pub wavelength: f64,
    /// Phase at x = 0 \[degrees]; between walls it must be 0 or 180, and the walls half a wavelength apart or more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase_deg: Option<f64>,
    /// Height of the floor, where nothing moves up or down; left out, far below \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bottom: Option<f64>,
    /// Height of the lid; left out, far above \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<f64>,
}
