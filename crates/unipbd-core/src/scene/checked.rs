use std::ops::Deref;

use serde::Serialize;

use super::{Problems, Scene};

/// A scene without problems. It can be read like a [`Scene`], but not be changed: so it is checked once.
///
/// ```
/// use unipbd_core::scene::{Block, Liquid, Scene};
/// let mut scene = Scene { liquid: vec![Liquid::new("water", 1000.0)], ..Scene::default() };
/// assert!(scene.clone().check().is_err(), "a scene without particles");
/// scene.block.push(Block::new("water", [0.0, 0.0], [1.0, 1.0]));
/// let mut solver = scene.check()?.build(Default::default());
/// solver.step_frame()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckedScene(Scene);

impl Scene {
    /// The scene, free of problems.
    ///
    /// # Errors
    /// All [`Problems`] of a faulty scene.
    pub fn check(self) -> Result<CheckedScene, Problems> {
        let problems = self.validate();
        if problems.0.is_empty() { Ok(CheckedScene(self)) } else { Err(problems) }
    }
}

impl CheckedScene {
    /// The scene, to be changed.
    pub fn into_scene(self) -> Scene {
        self.0
    }
}

impl Deref for CheckedScene {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.0
    }
}
