//! What a body is made from.

use super::{BodyKind, Motion, Pose, Twist};
use crate::shapes::Shape;

/// How a surface rubs and rebounds.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Surface {
    /// Coulomb coefficient below which a contact sticks.
    pub static_friction: f64,
    /// Coulomb coefficient of a contact that slides.
    pub kinetic_friction: f64,
    /// Rolling resistance of a disc: largest moment over (normal force x radius).
    pub rolling_friction: f64,
    /// Rebound speed over impact speed, 0 to 1.
    pub restitution: f64,
}

impl Default for Surface {
    fn default() -> Self {
        Surface::with_friction(0.5)
    }
}

impl Surface {
    /// One coefficient for sticking and sliding, no rebound, no rolling resistance.
    pub const fn with_friction(coefficient: f64) -> Surface {
        Surface { static_friction: coefficient, kinetic_friction: coefficient, rolling_friction: 0.0, restitution: 0.0 }
    }

    /// The same with a coefficient of restitution.
    pub const fn with_restitution(self, restitution: f64) -> Surface {
        Surface { restitution, ..self }
    }

    /// What friction holds back of a sliding that the impulse `stop` would end, under this normal impulse
    /// (Macklin et al. 2014, equation 24).
    pub fn held_back(&self, stop: f64, normal: f64) -> f64 {
        let (sticks, drag) = (self.static_friction * normal, self.kinetic_friction * normal);
        if stop.abs() < sticks { stop } else { stop.clamp(-drag, drag) }
    }

    /// What holds between two surfaces: the geometric mean of the friction coefficients (one smooth
    /// side makes a smooth contact), the larger restitution, the larger rolling friction.
    pub fn combined(&self, other: &Surface) -> Surface {
        let kinetic = (self.kinetic_friction * other.kinetic_friction).sqrt();
        Surface {
            static_friction: (self.static_friction * other.static_friction).sqrt().max(kinetic),
            kinetic_friction: kinetic,
            rolling_friction: self.rolling_friction.max(other.rolling_friction),
            restitution: self.restitution.max(other.restitution),
        }
    }
}

/// Who collides with whom: both must list a layer the other is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct CollisionFilter {
    /// Layers the body is in, one bit each.
    pub layers: u32,
    /// Layers it collides with.
    pub collides_with: u32,
}

impl Default for CollisionFilter {
    fn default() -> Self {
        CollisionFilter { layers: 1, collides_with: u32::MAX }
    }
}

impl CollisionFilter {
    /// Whether two bodies collide.
    pub const fn allows(&self, other: &CollisionFilter) -> bool {
        self.layers & other.collides_with != 0 && other.layers & self.collides_with != 0
    }
}

/// How heavy a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassSpec {
    /// Mass per area [kg/m^2].
    Density(f64),
    /// Mass [kg].
    Mass(f64),
}

/// How a body whose shape is matched deforms.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Elasticity {
    /// Part of its deformation that it takes back in a 60th of a second, 0 to 1.
    pub stiffness: f64,
    /// Part of its wobble that it loses in a 60th of a second, 0 to 1.
    pub damping: f64,
}

/// Whether a dynamic body may turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    /// It turns freely.
    #[default]
    Free,
    /// It keeps its angle.
    Locked,
}

/// What a body is made from.
#[derive(Clone, Debug, PartialEq)]
pub struct BodySpec {
    /// Name.
    pub name: String,
    /// How it moves.
    pub kind: BodyKind,
    /// Outline; its origin is placed at the pose, wherever the centre of mass is.
    pub shape: Shape,
    /// Where the origin of the outline starts.
    pub pose: Pose,
    /// Velocity of the centre of mass and angular velocity at the start.
    pub velocity: Twist,
    /// How heavy it is.
    pub mass: MassSpec,
    /// Friction and restitution.
    pub surface: Surface,
    /// Whom it collides with.
    pub filter: CollisionFilter,
    /// Whether it may turn.
    pub rotation: Rotation,
    /// How a dynamic body whose shape is matched deforms; none for a rigid pose.
    pub matched: Option<Elasticity>,
    /// Factor on gravity.
    pub gravity_factor: f64,
    /// Script of a kinematic body, for the origin of its outline.
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
            motion: Motion::Still,
        }
    }
}
