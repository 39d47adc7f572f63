//! Scenes that several cases share. dx = 0.1 m and g = 9.81 m/s^2 unless a case says otherwise.

use unipbd_core::scene::{Block, BodyDescription, Emitter, HalfPlane, Liquid, Profile, Scene, Tank};

use crate::case::Trial;

/// Spacing of the free-surface cases \[m].
pub const SPACING: f64 = 0.1;
/// Gravity [m/s^2].
pub const GRAVITY: f64 = 9.81;

/// Water of `size` spacings in the lower left corner of a tank `width` spacings wide.
pub fn pool(size: (f64, f64), width: f64, trial: &Trial) -> Scene {
    let (right, top) = (SPACING * size.0, SPACING * size.1);
    Scene {
        spacing: SPACING,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [right, top])],
        tank: vec![Tank::new([0.0, 0.0], [SPACING * width, 4.0 * top])],
        ..Scene::default()
    }
}

/// A closed tank between two corners \[m], with nothing in it.
pub fn closed_tank(trial: &Trial, low: [f64; 2], high: [f64; 2]) -> Scene {
    Scene {
        spacing: SPACING,
        solver: trial.solver.clone(),
        legacy: trial.legacy.clone(),
        tank: vec![Tank { open: Vec::new(), ..Tank::new(low, high) }],
        ..Scene::default()
    }
}

/// A floor with this friction.
pub fn floor(friction: f64) -> HalfPlane {
    HalfPlane { friction: Some(friction), ..HalfPlane::new([0.0, 0.0], [0.0, 1.0]) }
}

/// A body with an outline of its own to be set, and a name.
pub fn body(name: &str, position: [f64; 2]) -> BodyDescription {
    BodyDescription { name: name.to_owned(), ..BodyDescription::at(position) }
}

/// A nozzle that blows upwards.
pub fn nozzle(material: &str, position: [f64; 2], width: f64, speed: f64) -> Emitter {
    Emitter { profile: Profile::Uniform, ..Emitter::new(material, position, width, speed) }
}
