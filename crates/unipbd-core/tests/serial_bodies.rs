//! A run on one thread asks no pool for help, many bodies or not. In a process of its own, which has one global pool.

use unipbd_core::BuildOptions;
use unipbd_core::scene::{BodyDescription, Copies, HalfPlane, Heap, Scene};

#[test]
fn contacts_of_a_run_on_one_thread_never_ask_the_global_pool() {
    let copies = Copies { columns: 60, rows: 60, step: [0.2, 0.2], heap: Heap::Grid };
    let scene = Scene {
        spacing: 0.1,
        half_plane: vec![HalfPlane::new([0.0, 0.0], [0.0, 1.0])],
        body: vec![BodyDescription { copies: Some(copies), ..BodyDescription::disc(0.1, [0.0, 0.1]) }],
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
    // Only the first who asks can set up the global pool.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nobody has asked for the global pool");
}
