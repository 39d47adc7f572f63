//! Accelerations of hooks.

use super::pool;
use unipbd_core::{BuildOptions, SolverError, Vector};

#[test]
fn an_absurd_acceleration_is_an_error_with_its_value_and_the_run_goes_on() {
    let options = || BuildOptions { threads: Some(1), seed: None };
    let (mut solver, mut other) = (pool().build(options()).unwrap(), pool().build(options()).unwrap());
    for wrong in [1e30, -1e30, 1e12, f32::INFINITY, f32::NAN] {
        let refused = solver.step_frame_with(|substep| -> Result<(), SolverError> {
            substep.add_acceleration(7, Vector::new(wrong as _, 0.0));
            Ok(())
        });
        let error = refused.unwrap_err();
        assert!(matches!(error, SolverError::Hook { particle, .. } if particle == substep_id(&solver)), "{error:?}");
        assert!(error.to_string().contains("\"water\" by (") && error.to_string().contains("limit"), "{error}");
    }
    let fine = |substep: &mut unipbd_core::SubstepView<'_>| -> Result<(), SolverError> {
        substep.add_acceleration(7, Vector::new(3.0, 0.0));
        Ok(())
    };
    for _ in 0..3 {
        solver.step_frame_with(fine).unwrap();
        other.step_frame_with(fine).unwrap();
    }
    assert_eq!(solver.state_hash(), other.state_hash(), "the refused substeps left nothing behind");
}

fn substep_id(solver: &unipbd_core::Solver) -> u32 {
    solver.ids()[7]
}
