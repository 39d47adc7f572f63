use serde::{Deserialize, Serialize};

/// A rectangle (`min`, `max`) or a disc (`center`, `radius`).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Region {
    /// Lower left corner \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<[f64; 2]>,
    /// Upper right corner \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<[f64; 2]>,
    /// Centre \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
    /// Radius \[m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
}

/// Puts particles at random places of a region, at a rate. Smoke goes anywhere; liquid and gas
/// only where there is room, so a full region takes none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Injector {
    /// Name of the material.
    pub material: String,
    /// Where.
    pub region: Region,
    /// Particles tried per second [1/s].
    pub rate: f64,
    /// Velocity of a new particle [m/s]; smoke takes that of its carrier at once.
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Temperature of new gas.
    #[serde(default)]
    pub temperature: f64,
    /// Time at which it starts \[s].
    #[serde(default)]
    pub start: f64,
    /// Time at which it stops \[s]; left out, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Adds nothing while there are this many particles of the material; left out, no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capacity: Option<u32>,
}

/// Removes particles from a region, once per frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sink {
    /// Where.
    pub region: Region,
    /// Names of the materials it takes; left out, all liquids, gases and smokes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<String>,
    /// Most particles removed per second [1/s]; left out, no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Time at which it starts \[s].
    #[serde(default)]
    pub start: f64,
    /// Time at which it stops \[s]; left out, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
}

/// Warms or cools the gas of a region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Heater {
    /// Where.
    pub region: Region,
    /// Temperature that the gas takes; 1 is hot, 0 is ambient.
    #[serde(default = "hot")]
    pub temperature: f64,
    /// How fast it takes it [1/s].
    #[serde(default = "quick")]
    pub rate: f64,
}

impl Region {
    /// Whether a point lies inside.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        match (self.min, self.max, self.center, self.radius) {
            (Some(min), Some(max), _, _) => x >= min[0] && x <= max[0] && y >= min[1] && y <= max[1],
            (_, _, Some(center), Some(radius)) => {
                let (dx, dy) = (x - center[0], y - center[1]);
                dx * dx + dy * dy <= radius * radius
            }
            _ => false,
        }
    }

    /// The smallest rectangle around it, as lower left and upper right corner.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        match (self.min, self.max, self.center, self.radius) {
            (Some(min), Some(max), _, _) => [min, max],
            (_, _, Some(center), Some(radius)) => {
                [center.map(|value| value - radius), center.map(|value| value + radius)]
            }
            _ => [[0.0; 2]; 2],
        }
    }
}

fn hot() -> f64 {
    1.0
}

fn quick() -> f64 {
    20.0
}
