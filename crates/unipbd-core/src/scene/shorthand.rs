//! Short ways to write scenes in Rust.

use super::{Block, BodyDescription, BodySolver, HalfPlane, Liquid, Obstacle, RotationRule, Side, Slip, Smoke, Tank};
use crate::scene::bodies::{BodyKind, FRICTION};

impl Liquid {
    /// A liquid of this rest density [kg/m^2], everything else as by default.
    pub fn new(name: &str, density: f64) -> Self {
        Liquid { name: name.to_owned(), density, ..Liquid::default() }
    }
}

impl Smoke {
    /// A smoke that stays.
    pub fn new(name: &str) -> Self {
        Smoke { name: name.to_owned(), ..Smoke::default() }
    }
}

impl Block {
    /// A rectangle of a material at rest, from its lower left to its upper right corner \[m].
    pub fn new(material: &str, min: [f64; 2], max: [f64; 2]) -> Self {
        Block { material: material.to_owned(), min, max, velocity: [0.0; 2], jitter: 0.0, temperature: 0.0 }
    }
}

impl HalfPlane {
    /// A wall at rest through a point \[m]; the normal points towards the particles.
    pub fn new(point: [f64; 2], normal: [f64; 2]) -> Self {
        HalfPlane { name: String::new(), point, normal, velocity: [0.0; 2], friction: None, slip: Slip::Free }
    }
}

impl Tank {
    /// A container, open at the top, from its lower left to its upper right corner \[m].
    pub fn new(min: [f64; 2], max: [f64; 2]) -> Self {
        let (open, without_slip) = (vec![Side::Top], Vec::new());
        Tank { name: String::new(), min, max, open, friction: None, slip: Slip::Free, without_slip }
    }
}

impl Obstacle {
    /// A solid rectangle, from its lower left to its upper right corner \[m].
    pub fn new(min: [f64; 2], max: [f64; 2]) -> Self {
        Obstacle { name: String::new(), min, max, friction: None, slip: Slip::Free }
    }
}

impl BodyDescription {
    /// A box of this width and height about a place \[m], of water's density.
    pub fn rectangle(size: [f64; 2], position: [f64; 2]) -> Self {
        BodyDescription { size: Some(size), ..BodyDescription::at(position) }
    }

    /// A disc about a place \[m], of water's density.
    pub fn disc(radius: f64, position: [f64; 2]) -> Self {
        BodyDescription { radius: Some(radius), ..BodyDescription::at(position) }
    }

    /// A polygon whose corners are seen from a place \[m], of water's density.
    pub fn polygon(outline: Vec<[f64; 2]>, position: [f64; 2]) -> Self {
        BodyDescription { outline: Some(outline), ..BodyDescription::at(position) }
    }

    /// A body of water's density at a place \[m], its outline still to be set.
    pub fn at(position: [f64; 2]) -> Self {
        BodyDescription {
            name: String::new(),
            kind: BodyKind::Dynamic,
            solver: BodySolver::Pose,
            compliance: 0.0,
            damping: 0.1,
            radius: None,
            size: None,
            outline: None,
            position,
            angle_deg: 0.0,
            velocity: [0.0; 2],
            spin_deg: 0.0,
            density: 1000.0,
            mass: None,
            friction: FRICTION,
            kinetic_friction: None,
            rolling_friction: 0.0,
            restitution: 0.0,
            surface_speed: 0.0,
            slip: Slip::Free,
            layers: vec![0],
            collides_with: None,
            rotation: RotationRule::Free,
            gravity_factor: 1.0,
            linear_damping: 0.0,
            angular_damping: 0.0,
            collision_group: 0,
            sensor: false,
            user_data: 0,
            motion: None,
            copies: None,
        }
    }
}
