//! What hooks ask for.

use super::pool;
use unipbd_core::math::Vector64;
use unipbd_core::rigid::Twist;
use unipbd_core::scene::BodyDescription;
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

#[test]
fn bodies_that_a_hook_throws_absurdly_far_break_nothing() {
    let mut scene = pool();
    for x in [1.3, 1.6, 1.9] {
        scene.body.push(BodyDescription::disc(0.1, [x - 0.05, 1.5]));
    }
    for speed in [1e12, -1e12, 1e15, -1e15, 1e30, -1e30] {
        let mut solver = scene.build(BuildOptions { threads: Some(1), seed: None }).unwrap();
        for frame in 0..4 {
            let thrown = solver.step_frame_with(|substep| -> Result<(), SolverError> {
                if frame == 1 {
                    let velocity = Twist { linear: Vector64::splat(speed), angular: 0.0 };
                    (0..2).for_each(|body| substep.set_body_velocity(body, velocity));
                }
                Ok(())
            });
            assert!(thrown.is_ok() || matches!(thrown, Err(SolverError::Diverged { .. })), "{thrown:?}");
        }
    }
}
