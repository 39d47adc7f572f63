//! Kinds of gauges: what a scene asks for, and a reading tells.

use serde::{Deserialize, Serialize};

/// What a gauge reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GaugeKind {
    /// Distance from `at` to the surface along `direction`, on the line through both \[m].
    #[default]
    Level,
    /// Pressure at `at` [N/m].
    Pressure,
    /// Mean force over the last frame `on` a wall or body: its component along `direction`, or its size \[N].
    Force,
    /// Area that crosses `line` per time [m^2/s].
    FlowRate,
    /// Distance from `at` to the farthest point along `direction`, wherever it is \[m].
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
