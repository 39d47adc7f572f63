use serde::{Deserialize, Serialize};

/// A rope: points in a row, each tied to the next. The pieces are about a spacing long.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rope {
    /// Name of what its points are made of: a solid, which no fluid feels, or a liquid, which all fluids
    /// feel and which floats in a heavier one.
    pub material: String,
    /// First end \[m].
    pub from: [f64; 2],
    /// Last end \[m].
    pub to: [f64; 2],
    /// Length, at least the distance of the ends; left out, that distance \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Inverse stiffness of each piece, 0 does not stretch [m/N].
    #[serde(default)]
    pub compliance: f64,
    /// Ends that are held where they start.
    #[serde(default)]
    pub held: Held,
    /// What a piece keeps.
    #[serde(default)]
    pub link: Link,
    /// Whether every point is also tethered to the held ends, so that a long rope does not stretch at few
    /// substeps.
    #[serde(default)]
    pub tethers: Tethers,
    /// Name of a body that the last end is fixed to. The body never comes farther from the first end than the rope is
    /// long, where that end is held, carried by a script, or fixed to another body; the rope's own weight does not pull
    /// at the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Name of a body that the first end is fixed to, in the same way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_body: Option<String>,
}

/// Ends of a rope that are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Held {
    /// The first.
    #[default]
    From,
    /// The last.
    To,
    /// Both.
    Both,
    /// None.
    Neither,
}

/// What a piece of a rope keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Link {
    /// Its ends never come farther apart than it is long.
    #[default]
    Rope,
    /// Its ends keep their distance.
    Rod,
}

/// Which points of a rope are tethered to its held ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Tethers {
    /// None.
    #[default]
    None,
    /// All, by the length of rope between (long-range attachments, Kim et al. 2012).
    All,
}

impl Held {
    /// Whether the first end is held.
    pub fn first(self) -> bool {
        matches!(self, Held::From | Held::Both)
    }

    /// Whether the last end is held.
    pub fn last(self) -> bool {
        matches!(self, Held::To | Held::Both)
    }
}

impl Rope {
    /// Length of the whole rope \[m].
    pub(crate) fn full_length(&self) -> f64 {
        let distance = libm::hypot(self.to[0] - self.from[0], self.to[1] - self.from[1]);
        self.length.unwrap_or(distance)
    }

    /// Number of pieces, about a spacing long each.
    pub(crate) fn pieces(&self, spacing: f64) -> f64 {
        (self.full_length() / spacing).round().max(1.0)
    }
}
