use crate::scenes::{all, build, build_on, liquid, plume, run};
use unipbd_core::{BuildOptions, State, StateError};

#[test]
fn a_run_goes_on_from_a_saved_state_as_if_it_had_never_stopped() {
    for (name, scene) in all() {
        let mut whole = build(&scene);
        run(&mut whole, 100);

        let mut first = build(&scene);
        run(&mut first, 50);
        let saved = first.save();
        run(&mut first, 50);
        assert_eq!(first.state_hash(), whole.state_hash(), "{name}: saving changed the run");
        first.restore(&saved).unwrap();
        run(&mut first, 50);
        assert_eq!(first.state_hash(), whole.state_hash(), "{name}: restored into the same run");

        let mut fresh = build_on(&scene, 2);
        fresh.restore(&State::from_bytes(&saved.to_bytes()).unwrap()).unwrap();
        assert_eq!((fresh.frame(), fresh.time()), (50, saved.time()));
        run(&mut fresh, 50);
        assert_eq!(fresh.state_hash(), whole.state_hash(), "{name}: restored into a fresh run");
        assert_eq!(fresh.diagnostics(), whole.diagnostics(), "{name}");
        assert_eq!(fresh.positions(), whole.positions(), "{name}: rows stand in the same order");
    }
}

#[test]
fn states_saved_between_two_list_builds_bring_the_list_along() {
    for (name, scene) in all() {
        let mut run = build(&scene);
        let mut between = 0;
        for _ in 0..40 {
            let built = run.step_frame().unwrap().list_builds;
            between += u32::from(built < run.diagnostics().substeps);
            let mut other = build(&scene);
            other.restore(&run.save()).unwrap();
            let mut expected = build(&scene);
            expected.restore(&run.save()).unwrap();
            assert_eq!(other.density_errors(), run.density_errors(), "{name}");
            assert_eq!(other.step_frame(), expected.step_frame(), "{name}");
            let ahead = run.save();
            assert_eq!(run.step_frame().unwrap(), {
                run.restore(&ahead).unwrap();
                run.step_frame().unwrap()
            });
            assert_eq!(other.state_hash(), run.state_hash(), "{name}");
        }
        // Where particles are emitted, each substep has a list of its own.
        let lasting = scene.emitter.is_empty();
        assert!(between > 10 || !lasting, "{name}: lists outlive frames, so some states lie between two builds");
    }
}

#[test]
fn states_of_other_scenes_are_refused_and_change_nothing() {
    let mut run = build(&liquid());
    let hash = run.state_hash();
    let foreign = build(&plume()).save();
    let error = run.restore(&foreign).unwrap_err();
    assert!(matches!(&error, StateError::OtherScene { .. }), "{error}");
    let mut denser = liquid();
    denser.liquid[0].density = 900.0;
    let error = run.restore(&build(&denser).save()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the state is of another scene: it has a liquid \"water\" of density 900, \
         this run has a liquid \"water\" of density 1000"
    );
    let seeded = liquid().build(BuildOptions { seed: Some(5), threads: Some(1) }).unwrap();
    assert!(run.restore(&seeded.save()).unwrap_err().to_string().contains("seed 5"));
    assert_eq!(run.state_hash(), hash);
}
