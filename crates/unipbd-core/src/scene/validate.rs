//! Semantic checks: values that parse but make no sense.

use super::{KeyPath, Problems, Scene};

impl Scene {
    /// Lists everything that is wrong with the scene; empty when it can be built.
    pub fn validate(&self) -> Problems {
        let mut problems = Problems::default();
        if !(self.spacing > 0.0 && self.spacing.is_finite()) {
            problems.add_with_hint(
                KeyPath::key("spacing"),
                format!("must be a positive length, found {}", self.spacing),
                "the distance between particles in metres, such as 0.1",
            );
        }
        problems
    }
}
