//! The same state, to the last bit, whatever runs beside it.

use std::io;
use std::path::Path;

use unipbd_cli::record::{Fields, Header, Recorder};
use unipbd_cli::scene_file::LoadedScene;
use unipbd_cli::simulation::Simulation;
use unipbd_core::{BuildOptions, Solver};
use unipbd_tests::{build, load, run, shipped};

/// Two gases in a closed box, one of them hot, with conduction and confinement.
const WARM_BOX: &str = r#"
spacing = 0.02
gravity = [0.0, -9.81]
[[gas]]
name = "air"
vorticity = 2.0
conductivity = 0.0004
[[gas]]
name = "fume"
density = 2.0
[[block]]
material = "air"
min = [-0.6, 0.0]
max = [0.0, 1.0]
temperature = 1.0
jitter = 0.1
[[block]]
material = "fume"
min = [0.0, 0.0]
max = [0.6, 1.0]
jitter = 0.1
[[tank]]
min = [-0.6, 0.0]
max = [0.6, 1.0]
"#;

/// Boxes and a disc that fall into water.
const SPLASH: &str = r#"
spacing = 0.05
[[liquid]]
name = "water"
xsph = 0.05
[[block]]
material = "water"
min = [0.0, 0.0]
max = [4.0, 1.0]
[[tank]]
min = [0.0, 0.0]
max = [4.0, 3.0]
open = ["top"]
[[body]]
size = [0.5, 0.3]
position = [1.0, 1.3]
angle_deg = 20.0
density = 500.0
[[body]]
size = [0.4, 0.4]
position = [1.1, 1.9]
density = 700.0
[[body]]
radius = 0.25
position = [2.9, 1.4]
velocity = [0.5, -2.0]
density = 1500.0
"#;

/// Kinds of scene and the frames after which to compare.
fn scenes() -> [(&'static str, LoadedScene, u64); 4] {
    [
        ("dam break", shipped("dam_break.toml"), 20),
        ("open plume", shipped("open_gas.toml"), 30),
        ("warm box", load(WARM_BOX), 10),
        ("bodies in water", load(SPLASH), 40),
    ]
}

#[test]
fn the_state_is_the_same_on_any_number_of_threads() {
    for (name, loaded, frames) in scenes() {
        let hash = |threads: usize| {
            let mut solver = build(&loaded.scene, threads);
            run(&mut solver, frames, |_| ());
            solver.state_hash()
        };
        let one = hash(1);
        for threads in [2, 3, 8] {
            assert_eq!(hash(threads), one, "{name} on {threads} threads");
        }
    }
}

/// The hash after some frames with every column of every frame recorded.
fn hash_recorded(loaded: &LoadedScene, frames: u64) -> u64 {
    let options = BuildOptions { threads: Some(2), seed: None };
    let mut simulation = Simulation::new(&loaded.scene, options);
    let header = Header {
        setting: simulation.setting(&loaded.scene, &loaded.path),
        scene_text: loaded.text.clone(),
        overrides: Vec::new(),
        seed: simulation.solver.seed(),
        fps: loaded.scene.fps,
        gravity: loaded.scene.gravity,
        gauges: Vec::new(),
    };
    let fields = Fields::ALL;
    let mut recorder = Recorder::to_writer(io::sink(), Path::new("nowhere"), &header, fields).expect("it starts");
    for _ in 0..frames {
        simulation.solver.step_frame().expect("the run goes on");
        let (diagnostics, events) = (simulation.solver.diagnostics(), simulation.solver.take_events());
        let hash = simulation.solver.state_hash();
        recorder.record(&simulation.snapshot(fields), Some(&diagnostics), Some(hash), &events).expect("it writes");
    }
    assert_eq!(recorder.finish().expect("it ends").frames, frames);
    simulation.solver.state_hash()
}

/// A heap large enough for contacts that stay in their lanes from search to search.
fn heap() -> String {
    let body = |k: i32| {
        let shape = if k % 5 == 0 { "radius = 0.2" } else { "size = [0.4, 0.4]" };
        let at = [0.3 + 0.44 * f64::from(k % 30) + 0.05 * f64::from(k % 3), 0.25 + 0.45 * f64::from(k / 30)];
        format!("[[body]]\n{shape}\nposition = {at:?}\n")
    };
    let bodies: String = (0..600).map(body).collect();
    format!(
        "spacing = 0.05\n[contacts]\niterations = 1\n[solver]\nsubsteps = 2\n\
         [[tank]]\nmin = [0.0, 0.0]\nmax = [14.0, 20.0]\nfriction = 0.5\n{bodies}"
    )
}

#[test]
fn a_large_heap_has_the_same_bits_on_any_number_of_threads_and_after_a_restore_at_any_frame() {
    let scene = unipbd_tests::scene(&heap());
    let hashes = |solver: &mut Solver, frames: u64| {
        let mut hashes = Vec::new();
        run(solver, frames, |solver| hashes.push(solver.state_hash()));
        hashes
    };
    let mut one = build(&scene, 1);
    let mut states = Vec::new();
    run(&mut one, 40, |solver| states.push((solver.save(), solver.state_hash())));
    for threads in [2, 3] {
        assert_eq!(hashes(&mut build(&scene, threads), 40), states.iter().map(|(_, hash)| *hash).collect::<Vec<_>>());
    }
    for from in (0..36).step_by(5) {
        let mut restored = build(&scene, 2);
        restored.restore(&states[from].0).expect("it is a state of this scene");
        let expected: Vec<u64> = states[from + 1..from + 4].iter().map(|(_, hash)| *hash).collect();
        assert_eq!(hashes(&mut restored, 3), expected, "from frame {from}");
    }
}

#[test]
fn recording_changes_nothing() {
    for (name, loaded, frames) in scenes() {
        let mut solver = build(&loaded.scene, 1);
        run(&mut solver, frames, |_| ());
        assert_eq!(hash_recorded(&loaded, frames), solver.state_hash(), "{name}");
    }
}

#[test]
fn the_seed_matters_where_anything_is_random() {
    let hash = |seed: u64| {
        let options = BuildOptions { threads: Some(1), seed: Some(seed) };
        let mut solver = shipped("open_gas.toml").scene.build(options);
        run(&mut solver, 10, |_| ());
        solver.state_hash()
    };
    assert_eq!(hash(1), hash(1));
    assert_ne!(hash(1), hash(2));
}
