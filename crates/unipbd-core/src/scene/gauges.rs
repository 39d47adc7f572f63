use serde::{Deserialize, Serialize};

/// A gauge: one number per frame, read from the run without changing it. `nan` where it has nothing to read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// Name in logs and tables: letters, digits and `_`, a letter first.
    pub name: String,
    /// What it reads.
    pub kind: GaugeKind,
    /// Material that it reads; left out, all liquids, and for pressure and flow rate gases too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Point on the line of a level, place of a pressure, point from which a front counts (the origin if left out) [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// Direction of a level (up if left out), of a front, of the component of a force (left out, the whole force);
    /// need not have length 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 2]>,
    /// Radius around `at` over which a pressure is averaged; left out, three spacings [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Wall with a name (a side of a tank is `NAME left`) or body of a force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// Which forces it counts.
    #[serde(default)]
    pub of: ForcePart,
    /// Ends of the line of a flow rate; what crosses it to the right of the way from the first to the second counts
    /// as positive [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<[[f64; 2]; 2]>,
}

/// What a gauge reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GaugeKind {
    /// Distance from `at` to the surface along `direction`, on the line through both [m].
    #[default]
    Level,
    /// Pressure at `at` [N/m].
    Pressure,
    /// Mean force over the last frame `on` a wall or body: its component along `direction`, or its size [N].
    Force,
    /// Area that crosses `line` per time [m^2/s].
    FlowRate,
    /// Distance from `at` to the farthest point along `direction`, wherever it is [m].
    Front,
}

impl GaugeKind {
    /// All kinds.
    pub const ALL: [GaugeKind; 5] =
        [GaugeKind::Level, GaugeKind::Pressure, GaugeKind::Force, GaugeKind::FlowRate, GaugeKind::Front];

    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            GaugeKind::Level => "level",
            GaugeKind::Pressure => "pressure",
            GaugeKind::Force => "force",
            GaugeKind::FlowRate => "flow_rate",
            GaugeKind::Front => "front",
        }
    }

    /// Unit of its readings. A pressure is a force per length: times one metre of depth, pascals.
    pub const fn unit(self) -> &'static str {
        match self {
            GaugeKind::Level | GaugeKind::Front => "m",
            GaugeKind::Pressure => "N/m",
            GaugeKind::Force => "N",
            GaugeKind::FlowRate => "m^2/s",
        }
    }
}

/// Which forces on a wall or body a gauge counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ForcePart {
    /// Those of fluids and contacts.
    #[default]
    All,
    /// Those of fluids.
    Fluids,
    /// Those of contacts, and on a body of joints.
    Contacts,
}

impl Gauge {
    /// A gauge of this name and kind, to be filled in.
    pub fn new(name: &str, kind: GaugeKind) -> Self {
        Gauge {
            name: name.to_owned(),
            kind,
            material: None,
            at: None,
            direction: None,
            radius: None,
            on: None,
            of: ForcePart::All,
            line: None,
        }
    }
}
