//! Water that turns in a frictionless drum of two static bodies.

use std::f64::consts::PI;

use crate::outlines::{GRID, deepest, fluid, list};
use unipbd_core::math::Vector64;
use unipbd_core::{Phase, Solver};
use unipbd_tests::{bars, build, run, scene};

/// Half of a ring about the origin.
fn half_ring(inner: f64, outer: f64, from: f64) -> String {
    let corners = 64;
    let arc = |radius: f64, k: usize| Vector64::from_angle(from + PI * k as f64 / corners as f64) * radius;
    // The corners of the inside lie outside of the circle: the sides touch it.
    let inner = inner / (0.5 * PI / corners as f64).cos();
    list((0..=corners).map(|k| arc(outer, k)).chain((0..=corners).rev().map(|k| arc(inner, k))))
}

/// Forty spacings in the radius: with twenty it keeps 0.972 without the grid and 0.944 with it.
const DRUM_SPACING: f64 = 0.01;

/// A drum that is full of turning water.
fn drum(grid: &str) -> Solver {
    let (spacing, radius, spin) = (DRUM_SPACING, 0.4, 4.0);
    let reach = (radius / spacing) as i64;
    let lattice =
        (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| Vector64::new(i as f64, j as f64) * spacing));
    let points: Vec<Vector64> = lattice.filter(|x| x.length() < radius - 0.45 * spacing).collect();
    let velocities = list(points.iter().map(|x| x.perp() * spin));
    let scene = scene(&format!(
        r#"
        spacing = {spacing}
        gravity = [0.0, 0.0]
        [solver]
        pressure_grid = "{grid}"
        [[liquid]]
        name = "water"
        [[points]]
        material = "water"
        positions = [{}]
        velocities = [{velocities}]
        [[body]]
        name = "left"
        kind = "static"
        position = [0.0, 0.0]
        outline = [{}]
        [[body]]
        name = "right"
        kind = "static"
        position = [0.0, 0.0]
        outline = [{}]
        "#,
        list(points.iter().copied()),
        half_ring(radius, 0.6, PI / 2.0),
        half_ring(radius, 0.6, -PI / 2.0),
    ));
    build(&scene, 2)
}

#[test]
fn water_in_a_drum_goes_on_turning() {
    for grid in GRID {
        let mut solver = drum(grid);
        let moment = |solver: &Solver| fluid(solver).map(|(x, v)| x.perp_dot(v)).sum::<f64>();
        let start = moment(&solver);
        run(&mut solver, 60, |_| ());
        bars("frictionless drum", |bars| {
            bars.within(&format!("angular momentum left after 1 s, grid {grid}"), moment(&solver) / start, 0.97, 1.005);
            bars.at_most(
                &format!("depth of water in the wall, grid {grid} [dx]"),
                deepest(&solver) / DRUM_SPACING,
                0.01,
            );
        });
    }
}

#[test]
fn outlines_have_no_samples() {
    let solver = drum("off");
    assert!(solver.phases().iter().all(|&phase| phase != Phase::Rigid));
}
