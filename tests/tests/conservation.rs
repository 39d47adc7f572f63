//! What a closed system keeps.

use unipbd_core::math::{Vector64, wide};
use unipbd_core::{Phase, Solver};
use unipbd_tests::{Spread, bars, build, run, scene};

/// Two patches of gas, one four times as dense, that meet off centre in empty space.
const COLLISION: &str = r#"
spacing = 0.1
gravity = [0.0, 0.0]
[[gas]]
name = "light"
density = 1.2
[[gas]]
name = "heavy"
density = 4.8
[[block]]
material = "light"
min = [-3.0, -1.0]
max = [0.0, 2.0]
velocity = [3.0, 1.0]
jitter = 0.1
[[block]]
material = "heavy"
min = [0.0, -2.0]
max = [3.0, 1.0]
velocity = [-2.0, 0.0]
jitter = 0.1
"#;

/// Momentum, and the sum of its sizes [kg m/s].
fn momentum(solver: &Solver) -> (Vector64, f64) {
    let masses = solver.particles().inverse_masses().iter().map(|inverse_mass| 1.0 / f64::from(*inverse_mass));
    let each = masses.zip(solver.velocities()).map(|(mass, velocity)| wide(*velocity) * mass);
    each.fold((Vector64::ZERO, 0.0), |(sum, size), momentum| (sum + momentum, size + momentum.length()))
}

#[test]
fn gases_of_unequal_mass_keep_their_momentum() {
    let mut solver = build(&scene(COLLISION), 2);
    let (start, size) = momentum(&solver);
    let energy = solver.diagnostics().kinetic_energy;
    let mut drift = Spread::default();
    run(&mut solver, 120, |solver| {
        let (now, _) = momentum(solver);
        drift.add((now - start).length() / size);
        assert!((solver.diagnostics().momentum - now).length() <= 1e-9 * size, "the diagnostics agree");
    });
    assert_eq!(solver.diagnostics().count(Phase::Gas), 1800);
    bars("collision of two gases", |bars| {
        bars.at_most("drift of the momentum over sum |m v|", drift.max(), 1e-5);
        bars.at_most("kinetic energy left (they did collide)", solver.diagnostics().kinetic_energy / energy, 0.95);
    });
}
