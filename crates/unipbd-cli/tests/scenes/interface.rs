//! Two liquids: how an interface grows, and how close they lie.

use std::f64::consts::TAU;

use unipbd_core::Solver;

use crate::support::{run_until, solver};

const SPACING: f64 = 0.02;
const WIDTH: f64 = 1.28;
const DEPTH: f64 = 1.28;
/// Two spacings, a fifth of the wavelength over 2 pi: shallow, and above the noise of the start.
const AMPLITUDE: f64 = 0.04;

/// Heavy over light in a box as wide as one wave, closed above and below, periodic to the sides.
fn heavy_over_light(ratio: f64) -> Solver {
    let (top, heavy) = (2.0 * DEPTH, 1000.0 * ratio);
    solver(&format!(
        r#"
        spacing = {SPACING}
        [domain]
        periodic_x = [0.0, {WIDTH}]
        [[liquid]]
        name = "heavy"
        density = {heavy}
        [[liquid]]
        name = "light"
        [[block]]
        material = "light"
        min = [0.0, 0.0]
        max = [{WIDTH}, {DEPTH}]
        [[block]]
        material = "heavy"
        min = [0.0, {DEPTH}]
        max = [{WIDTH}, {top}]
        [[wave]]
        level = {DEPTH}
        amplitude = {AMPLITUDE}
        wavelength = {WIDTH}
        phase_deg = 0.0
        bottom = 0.0
        top = {top}
        [[tank]]
        min = [0.0, 0.0]
        max = [{WIDTH}, {top}]
        open = ["left", "right"]
        "#
    ))
}

/// Amplitude of the interface: the heavy liquid above each stretch of the floor, as a cosine.
fn amplitude(solver: &Solver) -> f64 {
    let k = TAU / WIDTH;
    let heavy = (0..solver.positions().len()).filter(|&row| solver.material_indices()[row] == 0);
    let sum: f64 = heavy.map(|row| (k * f64::from(solver.positions()[row].x)).cos()).sum();
    -2.0 * sum * SPACING * SPACING / WIDTH
}

/// Distance of the nearest light particle, averaged over the heavy ones that have one within 1.5 spacings.
fn gap(solver: &Solver) -> f64 {
    let of = |material: u16| {
        let rows = (0..solver.positions().len()).filter(move |&row| solver.material_indices()[row] == material);
        rows.map(|row| solver.positions()[row]).collect::<Vec<_>>()
    };
    let (heavy, light) = (of(0), of(1));
    let nearest = |x: &unipbd_core::Vector| light.iter().map(|y| (*x - *y).length()).fold(f32::INFINITY, f32::min);
    let near: Vec<f64> = heavy.iter().map(nearest).map(f64::from).filter(|d| *d < 1.5 * SPACING).collect();
    near.iter().sum::<f64>() / near.len() as f64
}

fn check_growth(ratio: f64) {
    let mut solver = heavy_over_light(ratio);
    let atwood = (ratio - 1.0) / (ratio + 1.0);
    let k = TAU / WIDTH;
    let theory = (atwood * 9.81 * k * (k * DEPTH).tanh()).sqrt();
    let start = amplitude(&solver);
    assert!((start / AMPLITUDE - 1.0).abs() < 0.05, "the wave starts with amplitude {start}");
    // From rest the amplitude grows as cosh: measured while the wave is still shallow.
    let time = 1.5 / theory;
    run_until(&mut solver, time);
    let growth = (amplitude(&solver) / start).acosh() / solver.time();
    let spacing = gap(&solver) / SPACING;
    println!("ratio {ratio}: growth {:.3} of theory, heavy to light {spacing:.3} spacings", growth / theory);
    assert!((0.75..=1.05).contains(&(growth / theory)), "growth {} of theory", growth / theory);
    assert!(spacing <= 1.05, "the interface opens: {spacing} spacings");
}

#[test]
fn heavy_over_light_grows_as_the_linear_theory_says_at_ratio_two() {
    check_growth(2.0);
}

#[test]
fn heavy_over_light_grows_as_the_linear_theory_says_at_ratio_1_6() {
    check_growth(1.6);
}

#[test]
fn two_liquids_that_change_places_keep_their_areas() {
    let mut solver = solver(
        r#"
        spacing = 0.05
        [[liquid]]
        name = "heavy"
        density = 2000.0
        xsph = 0.02
        [[liquid]]
        name = "light"
        xsph = 0.02
        [[block]]
        material = "light"
        min = [0.0, 0.0]
        max = [1.0, 1.2]
        [[block]]
        material = "heavy"
        min = [1.0, 0.0]
        max = [2.0, 1.2]
        [[tank]]
        min = [0.0, 0.0]
        max = [2.0, 2.5]
        open = ["top"]
        "#,
    );
    let count = |solver: &Solver| solver.diagnostics().materials.iter().map(|of| of.count).collect::<Vec<_>>();
    let start = count(&solver);
    for _ in 0..16 {
        let next = solver.time() + 0.25;
        run_until(&mut solver, next);
        assert_eq!(count(&solver), start);
        for material in solver.diagnostics().materials {
            // The area is count dx^2/(1 + C).
            let shrunk = material.density_error_mean / (1.0 + material.density_error_mean);
            assert!(shrunk < 0.015, "{} has lost {:.2} % of its area", material.name, 100.0 * shrunk);
        }
    }
    let mean = |material: u16| {
        let rows = (0..solver.positions().len()).filter(|&row| solver.material_indices()[row] == material);
        let heights: Vec<f64> = rows.map(|row| f64::from(solver.positions()[row].y)).collect();
        heights.iter().sum::<f64>() / heights.len() as f64
    };
    println!("heavy at {:.2} m, light at {:.2} m", mean(0), mean(1));
    assert!(mean(1) > mean(0) + 0.4, "the light liquid lies on the heavy one");
}
