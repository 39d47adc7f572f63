//! The specification of a body.

use super::{BodyKind, Motion, Pose, Twist};
use crate::math::Vector64;
use crate::scene::FrictionRule;
use crate::shapes::Shape;

/// Friction and restitution of a surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Surface {
    /// Coulomb coefficient of static friction.
    pub static_friction: f64,
    /// Coulomb coefficient of kinetic friction.
    pub kinetic_friction: f64,
    /// Rolling resistance of a disc: largest moment over (normal force x radius).
    pub rolling_friction: f64,
    /// Rebound speed over impact speed, 0 to 1.
    pub restitution: f64,
    /// Speed of the surface along the outline, counter-clockwise around the solid: a conveyor belt [m/s].
    pub speed: f64,
    /// Whether viscous fluids move with it.
    pub no_slip: bool,
}

impl Default for Surface {
    fn default() -> Self {
        Surface::with_friction(0.5)
    }
}

impl Surface {
    /// One coefficient for sticking and sliding, no rebound, no rolling resistance.
    pub const fn with_friction(coefficient: f64) -> Surface {
        Surface {
            static_friction: coefficient,
            kinetic_friction: coefficient,
            rolling_friction: 0.0,
            restitution: 0.0,
            speed: 0.0,
            no_slip: false,
        }
    }

    /// The same with a coefficient of restitution.
    pub const fn with_restitution(self, restitution: f64) -> Surface {
        Surface { restitution, ..self }
    }

    /// The friction impulse under this normal impulse; the impulse `stop` would end the sliding
    /// (Macklin et al. 2014, equation 24).
    pub fn held_back(&self, stop: f64, normal: f64) -> f64 {
        let (sticks, drag) = (self.static_friction * normal, self.kinetic_friction * normal);
        if stop.abs() < sticks { stop } else { stop.clamp(-drag, drag) }
    }

    /// The combined coefficients of two surfaces: friction by the rule, the larger restitution, the larger rolling
    /// friction, the sum of the surface speeds.
    pub fn combined(&self, other: &Surface, rule: FrictionRule) -> Surface {
        let kinetic = rule.combine(self.kinetic_friction, other.kinetic_friction);
        Surface {
            static_friction: rule.combine(self.static_friction, other.static_friction).max(kinetic),
            kinetic_friction: kinetic,
            rolling_friction: self.rolling_friction.max(other.rolling_friction),
            restitution: self.restitution.max(other.restitution),
            speed: self.speed + other.speed,
            no_slip: self.no_slip || other.no_slip,
        }
    }
}

/// Collision filter: two bodies collide if each of them lists a layer of the other; a common group overrides that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct CollisionFilter {
    /// Layers the body is in, one bit each.
    pub layers: u32,
    /// Layers it collides with.
    pub collides_with: u32,
    /// Bodies of the same group above 0 always collide, below 0 never.
    pub group: i32,
}

impl Default for CollisionFilter {
    fn default() -> Self {
        CollisionFilter { layers: 1, collides_with: u32::MAX, group: 0 }
    }
}

impl CollisionFilter {
    /// Whether two bodies collide.
    pub const fn allows(&self, other: &CollisionFilter) -> bool {
        if self.group != 0 && self.group == other.group {
            return self.group > 0;
        }
        self.layers & other.collides_with != 0 && other.layers & self.collides_with != 0
    }
}

/// Mass of a body, direct or by density.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum MassSpec {
    /// Mass per area [kg/m^2].
    Density(f64),
    /// Mass \[kg].
    Mass(f64),
}

/// Elasticity of a body with shape matching.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Elasticity {
    /// Displacement of the samples from the shape per force spread over all of them; 0 is rigid [m/N].
    pub compliance: f64,
    /// Fraction of its oscillation that is damped in 1/60 s, 0 to 1.
    pub damping: f64,
}

/// Rates at which the velocity of a body decays.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Damping {
    /// Of the velocity of the centre of mass [1/s].
    pub linear: f64,
    /// Of the angular velocity [1/s].
    pub angular: f64,
}

impl Damping {
    /// The displacement of a substep of length `dt` \[s] from a velocity and an acceleration by gravity: the exact decay
    /// of v' = g - c v, so that the terminal speed is g/c at every number of substeps.
    pub(crate) fn moved(&self, velocity: &Twist, pull: Vector64, dt: f64) -> Twist {
        let mut moved = velocity.scaled(dt);
        let mut push = dt * dt;
        if self.linear > 0.0 {
            let kept = libm::exp(-self.linear * dt);
            moved.linear *= kept;
            push = dt * -libm::expm1(-self.linear * dt) / self.linear;
        }
        if self.angular > 0.0 {
            moved.angular *= libm::exp(-self.angular * dt);
        }
        moved.linear += pull * push;
        moved
    }
}

/// Whether a dynamic body may turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Rotation {
    /// It turns freely.
    #[default]
    Free,
    /// It keeps its angle.
    Locked,
}

/// The specification of a body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BodySpec {
    /// Name.
    pub name: String,
    /// Type of motion.
    pub kind: BodyKind,
    /// Outline; its origin is placed at the pose, wherever the centre of mass is.
    pub shape: Shape,
    /// Where the origin of the outline starts.
    pub pose: Pose,
    /// Velocity of the centre of mass and angular velocity at the start; a kinematic body without a prescribed motion
    /// keeps both.
    pub velocity: Twist,
    /// Mass or density.
    pub mass: MassSpec,
    /// Friction and restitution.
    pub surface: Surface,
    /// Collision filter.
    pub filter: CollisionFilter,
    /// Whether it may turn.
    pub rotation: Rotation,
    /// Elasticity of a dynamic body with shape matching; `None` for a rigid body.
    pub matched: Option<Elasticity>,
    /// Factor on gravity.
    pub gravity_factor: f64,
    /// Rates at which its velocity decays.
    pub damping: Damping,
    /// Whether it reports what it touches and pushes nothing.
    pub sensor: bool,
    /// A number of the caller's own.
    pub user_data: u64,
    /// Prescribed motion of a kinematic body, for the origin of its outline.
    pub motion: Motion,
}

impl BodySpec {
    /// A dynamic body of water's density, at rest at the origin.
    pub fn new(shape: Shape) -> BodySpec {
        BodySpec {
            name: String::new(),
            kind: BodyKind::Dynamic,
            shape,
            pose: Pose::default(),
            velocity: Twist::ZERO,
            mass: MassSpec::Density(1000.0),
            surface: Surface::default(),
            filter: CollisionFilter::default(),
            rotation: Rotation::Free,
            matched: None,
            gravity_factor: 1.0,
            damping: Damping::default(),
            sensor: false,
            user_data: 0,
            motion: Motion::Still,
        }
    }
}
