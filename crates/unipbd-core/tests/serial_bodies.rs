//! A run on one thread asks no pool for help, many bodies or not. In a process of its own, which has one global pool.

use unipbd_core::BuildOptions;
use unipbd_core::scene::{Block, BodyDescription, Copies, HalfPlane, Heap, Liquid, Scene, SolverSettings, Substeps};

#[test]
fn contacts_of_a_run_on_one_thread_never_ask_the_global_pool() {
    let copies = Copies { columns: 60, rows: 60, step: [0.2, 0.2], heap: Heap::Grid };
    let scene = Scene {
        spacing: 0.1,
        half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
        body: vec![BodyDescription { copies: Some(copies), ..BodyDescription::disc(0.1, [0.0, 0.1]) }],
        ..Scene::default()
    };
    let liquid = Scene {
        spacing: 0.01,
        liquid: vec![Liquid::new("water", 1000.0)],
        block: vec![Block::new("water", [0.0, 0.0], [0.7, 0.7])],
        solver: SolverSettings { settle_substeps: Some(1), substeps: Substeps::Fixed(1), ..SolverSettings::default() },
        ..Scene::default()
    };
    let hash = |threads| {
        let mut solver = scene.build(BuildOptions { threads: Some(threads), seed: None }).unwrap();
        (0..2).for_each(|_| assert_eq!(solver.step_frame().unwrap().emitted, 0));
        assert!(solver.diagnostics().contact_penetration >= 0.0);
        solver.state_hash()
    };
    let serial = hash(1);
    assert_eq!(hash(3), serial, "threads change nothing");
    let mut pool = liquid.build(BuildOptions { threads: Some(2), seed: None }).unwrap();
    pool.step_frame().unwrap();
    pool.set_threads(1);
    let found = pool.diagnostics();
    assert!(found.counts.iter().sum::<u64>() > 4096 && found.kinetic_energy.is_finite());
    // Only the first who asks can set up the global pool.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nobody has asked for the global pool");
}
