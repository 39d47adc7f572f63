//! What a scene, a hook or an edit asks for is refused with the limit, or warned of, before it does harm.

mod crowds;
mod density_warning;
mod extremes;
mod hooks;
mod sizes;
mod twins;

use unipbd_core::scene::{Block, Liquid, Scene, Tank};

/// A column of water in a tank.
fn pool() -> Scene {
    Scene {
        spacing: 0.1,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [1.0, 1.0])],
        tank: vec![Tank::new([0.0, 0.0], [2.0, 2.0])],
        ..Scene::default()
    }
}

/// The problems of a scene that is changed, each with its path.
fn problems(change: impl FnOnce(&mut Scene)) -> Vec<String> {
    let mut scene = pool();
    change(&mut scene);
    scene.validate().0.iter().map(ToString::to_string).collect()
}

/// Whether the scene is refused at this place, and for nothing else.
#[track_caller]
fn is_refused(path: &str, words: &str, change: impl FnOnce(&mut Scene)) {
    let found = problems(change);
    assert!(found.iter().any(|problem| problem.starts_with(path) && problem.contains(words)), "{path}: {found:?}");
}
