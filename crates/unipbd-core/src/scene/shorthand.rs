//! Short ways to write scenes in Rust.

use super::{Block, Liquid, Side, Slip, Smoke, Tank};

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
    /// A rectangle of a material at rest, from its lower left to its upper right corner [m].
    pub fn new(material: &str, min: [f64; 2], max: [f64; 2]) -> Self {
        Block { material: material.to_owned(), min, max, velocity: [0.0; 2], jitter: 0.0, temperature: 0.0 }
    }
}

impl Tank {
    /// A container without friction, open at the top, from its lower left to its upper right corner [m].
    pub fn new(min: [f64; 2], max: [f64; 2]) -> Self {
        Tank { min, max, open: vec![Side::Top], friction: 0.0, slip: Slip::Free }
    }
}
