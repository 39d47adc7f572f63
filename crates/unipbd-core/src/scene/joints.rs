use serde::{Deserialize, Serialize};

/// A joint between two bodies, or a body and the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointDescription {
    /// Name by which it is changed and read while a scene runs.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What it keeps.
    pub kind: JointRule,
    /// Name of the first body.
    pub body: String,
    /// Name of the second body; left out, the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other: Option<String>,
    /// Anchor on the first body, where the scene starts \[m].
    pub at: [f64; 2],
    /// Anchor on the second body or in the world, where the scene starts; left out, `at` \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other_at: Option<[f64; 2]>,
    /// Length of a rod, a rope, or of the rope of a pulley beside its stretch between the wheels; left out, as the scene
    /// starts \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Inverse stiffness of a rod or rope, 0 is rigid [m/N].
    #[serde(default)]
    pub compliance: f64,
    /// Damping of a rod or rope with compliance: force per speed at which its anchors part [N s/m].
    #[serde(default)]
    pub damping: f64,
    /// Direction of a slider where the scene starts; need not have length 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 2]>,
    /// Smallest and largest angle of a hinge, of the first body against the second, from where the scene starts
    /// \[degrees].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits_deg: Option<[f64; 2]>,
    /// Smallest and largest way of the first anchor of a slider from the second along the axis \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
    /// Angular velocity that the motor of a hinge wants [degrees/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor_speed_deg: Option<f64>,
    /// Largest torque of the motor of a hinge [N m].
    #[serde(default = "boundless")]
    pub motor_torque: f64,
    /// Speed along the axis that the motor of a slider wants [m/s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor_speed: Option<f64>,
    /// Largest force of the motor of a slider \[N].
    #[serde(default = "boundless")]
    pub motor_force: f64,
    /// Wheel of a pulley on the side of the first body, fixed in the world \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<[f64; 2]>,
    /// Wheel of a pulley on the side of the second body; left out, `wheel` \[m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub other_wheel: Option<[f64; 2]>,
    /// Purchase of a pulley: the second body moves 1/ratio as far, and is pulled ratio times as hard.
    #[serde(default = "one")]
    pub ratio: f64,
    /// Force above which the joint breaks, mean over a frame; left out, never \[N].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub break_force: Option<f64>,
    /// Torque about the first anchor above which the joint breaks, mean over a frame; left out, never [N m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub break_torque: Option<f64>,
    /// Whether the two bodies collide with each other; left out, those at a rope or pulley do, and others do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collide_connected: Option<bool>,
}

impl JointDescription {
    /// A joint between a body and the world at a point \[m].
    pub fn new(kind: JointRule, body: &str, at: [f64; 2]) -> Self {
        JointDescription {
            name: String::new(),
            kind,
            body: body.to_owned(),
            other: None,
            at,
            other_at: None,
            length: None,
            compliance: 0.0,
            damping: 0.0,
            axis: None,
            limits_deg: None,
            limits: None,
            motor_speed_deg: None,
            motor_torque: boundless(),
            motor_speed: None,
            motor_force: boundless(),
            wheel: None,
            other_wheel: None,
            ratio: one(),
            break_force: None,
            break_torque: None,
            collide_connected: None,
        }
    }

    /// Whether the two bodies collide with each other.
    pub fn collide_connected(&self) -> bool {
        self.collide_connected.unwrap_or(matches!(self.kind, JointRule::Rope | JointRule::Pulley))
    }
}

/// What a joint keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum JointRule {
    /// The anchors coincide.
    Hinge,
    /// The anchors keep their distance; with compliance a spring, with damping a damped one.
    Rod,
    /// The anchors never come farther apart than the length.
    Rope,
    /// The anchors coincide, and the bodies keep their angle.
    Weld,
    /// The first anchor stays on a line through the second, and the bodies keep their angle.
    Slider,
    /// A rope over two fixed wheels without mass or friction.
    Pulley,
}

fn one() -> f64 {
    1.0
}

fn boundless() -> f64 {
    1e30
}
