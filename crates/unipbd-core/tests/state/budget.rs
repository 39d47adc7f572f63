//! A most time per frame.

use crate::scenes::{bodies, build, liquid, run};
use std::time::Duration;
use unipbd_core::observe::SubstepReason;
use unipbd_core::scene::{PressureGridUse, Scene, SolverSettings, Substeps};

#[test]
fn a_budget_that_nothing_meets_leaves_one_substep_and_says_so_once() {
    let alone = SolverSettings { pressure_grid: PressureGridUse::Off, ..SolverSettings::default() };
    let fixed = SolverSettings { substeps: Substeps::Fixed(6), ..SolverSettings::default() };
    for (scene, solver) in [(liquid(), alone.clone()), (bodies(), alone), (bodies(), fixed)] {
        let scene = Scene { solver, ..scene };
        let mut solver = build(&scene);
        run(&mut solver, 10);
        let wanted = solver.diagnostics().substeps;
        assert!(wanted > 1 && solver.diagnostics().substeps_reason != SubstepReason::Budget);
        solver.take_events();
        solver.set_budget(Some(Duration::from_nanos(1)));
        assert_eq!(solver.budget(), Some(Duration::from_nanos(1)));
        run(&mut solver, 12);
        let now = solver.diagnostics();
        assert_eq!((now.substeps, now.substeps_reason), (1, SubstepReason::Budget));
        assert!(now.substeps_wanted > 1, "what it wants is still told");
        let told: Vec<String> = solver.take_events().into_iter().map(|event| event.message).collect();
        assert_eq!(told.iter().filter(|message| message.contains("substeps cut")).count(), 1, "{told:?}");
        assert!(!told.iter().any(|message| message.contains("max_substeps")), "{told:?}");
        assert!(solver.velocities().iter().all(|velocity| velocity.is_finite()));
        solver.set_budget(None);
        run(&mut solver, 3);
        let after = solver.diagnostics();
        assert!(after.substeps > 1 && after.substeps_reason != SubstepReason::Budget);
    }
}

#[test]
fn a_budget_that_never_cuts_changes_no_bit() {
    let (mut with, mut without) = (build(&bodies()), build(&bodies()));
    with.set_budget(Some(Duration::from_secs(3600)));
    for _ in 0..20 {
        assert_eq!(with.step_frame(), without.step_frame());
        assert_eq!(with.state_hash(), without.state_hash());
    }
    assert!(with.take_events().iter().all(|event| !event.message.contains("budget")));
}

#[test]
fn a_budget_is_no_part_of_a_state() {
    let mut solver = build(&bodies());
    run(&mut solver, 5);
    let (state, mut twin) = (solver.save(), build(&bodies()));
    solver.set_budget(Some(Duration::from_nanos(1)));
    run(&mut solver, 5);
    assert_eq!(solver.diagnostics().substeps_reason, SubstepReason::Budget);
    for solver in [&mut solver, &mut twin] {
        solver.set_budget(None);
        solver.restore(&state).expect("it is of this run");
        run(solver, 5);
    }
    assert_eq!(solver.state_hash(), twin.state_hash());
}
