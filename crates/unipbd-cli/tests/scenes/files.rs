//! Every scene file: sound, explained, and as good as its word.

use unipbd_cli::expect::Watch;
use unipbd_core::BuildOptions;
use unipbd_core::scene::Expect;

use crate::support::scenes;

/// Scenes that cost less than this on one core [s] are run by every test run.
const QUICK: f64 = 1.0;
/// Splashes take several times the substeps that the start takes, where their number follows the speed.
const SPLASH: f64 = 6.0;

#[test]
fn every_scene_says_what_it_shows_and_what_to_expect() {
    let scenes = scenes();
    assert!(scenes.len() >= 20, "only {} scenes", scenes.len());
    for (path, text, scene) in scenes {
        let path = path.display();
        let comment = text.lines().take_while(|line| line.starts_with('#')).count();
        assert!(comment >= 3, "{path}: the file begins with a comment on what it shows");
        assert!(text.contains("Watch") || text.contains("Nothing should happen"), "{path}: says what to look at");
        assert!(!scene.name.is_empty() && !scene.description.is_empty(), "{path}: has a name and a description");
        assert!(scene.view.min.is_some() && scene.view.max.is_some(), "{path}: has a view");
        assert!(scene.expect != Expect::default(), "{path}: has an [expect] table");
    }
}

fn check(limit: f64) {
    let mut failures = Vec::new();
    for (path, _, scene) in scenes() {
        let splashes = if scene.uses_pressure_grid() { SPLASH } else { 1.0 };
        if splashes * scene.estimate().cost_seconds > limit {
            continue;
        }
        println!("{}", path.display());
        let mut solver = scene.build(BuildOptions::default());
        let mut watch = Watch::new(&scene);
        watch.observe(&solver);
        while solver.time() < scene.duration * (1.0 - 1e-9) {
            solver.step_frame().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            watch.observe(&solver);
        }
        failures.extend(watch.violations(&solver).into_iter().map(|line| format!("{}: {line}", path.display())));
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn quick_scenes_do_what_they_are_expected_to() {
    check(QUICK);
}

/// The same as `unipbd expect scenes/*.toml`.
#[test]
#[ignore = "runs every scene to its end, which takes minutes"]
fn every_scene_does_what_it_is_expected_to() {
    check(f64::INFINITY);
}
