//! The options that are there for comparison: those of the program that this project grew from show its faults.

use unipbd_core::Solver;

use crate::support::{run_until, solver};

/// The solver of the program, up to its density.
const SEED: &str = r#"
    [solver]
    substeps = 1
    iterations = 3
    kernel_radius = 3.2258
    gradients = "predicted"
    settle_substeps = 0
    [legacy]
    kernel = "poly6_spiky_3d"
"#;

/// Two liquids side by side.
fn two_liquids() -> Solver {
    solver(&format!(
        r#"
        spacing = 0.62
        gravity = [0.0, -9.8]
        {SEED}
        mass_density = {{}}
        [[liquid]]
        name = "light"
        density = 1.0
        particle_mass = 1.0
        surface = "none"
        [[liquid]]
        name = "heavy"
        density = 2.0
        particle_mass = 1.0
        surface = "none"
        [[block]]
        material = "light"
        min = [-6.2, 0.0]
        max = [0.0, 12.4]
        [[block]]
        material = "heavy"
        min = [0.0, 0.0]
        max = [6.2, 12.4]
        [[tank]]
        min = [-6.2, 0.0]
        max = [6.2, 12.4]
        open = ["top"]
        "#
    ))
}

/// Density errors of a material, inside alone: at least a kernel radius from every surface.
fn inside(solver: &Solver, material: u16) -> Vec<f64> {
    let rows = (0..solver.positions().len()).filter(|&row| solver.material_indices()[row] == material);
    let deep = rows.filter(|&row| {
        let x = solver.positions()[row];
        x.x.abs() > 2.0 && x.x.abs() < 4.2 && x.y > 2.0 && x.y < 10.4
    });
    deep.map(|row| f64::from(solver.density_errors()[row])).collect()
}

#[test]
fn the_seed_starts_far_from_its_rest_densities_and_gains_energy() {
    let mut seed = two_liquids();
    let mean = |errors: Vec<f64>| errors.iter().sum::<f64>() / errors.len() as f64;
    let (light, heavy) = (mean(inside(&seed, 0)), mean(inside(&seed, 1)));
    println!("the start is off by {:+.0} % and {:+.0} %", 100.0 * light, 100.0 * heavy);
    assert!((light - 0.6).abs() < 0.02 && (heavy + 0.2).abs() < 0.01, "{light} {heavy}");
    let energy = |solver: &Solver| solver.diagnostics().kinetic_energy + solver.diagnostics().potential_energy;
    let start = energy(&seed);
    run_until(&mut seed, 0.3);
    assert!(energy(&seed) > 1.1 * start, "{} J from {start} J", energy(&seed));
    run_until(&mut seed, 1.0);
    let highest = seed.positions().iter().map(|x| x.y).fold(0.0, f32::max);
    assert!(highest > 15.0, "the light liquid is thrown up, to {highest} m");
}

#[test]
fn momentum_is_kept_without_averaging_and_lost_with_it() {
    let momentum = |averaging: &str| {
        let mut drops = solver(&format!(
            r#"
            spacing = 0.62
            gravity = [0.0, 0.0]
            {SEED}
            mass_density = {{ averaging = "{averaging}" }}
            [[liquid]]
            name = "light"
            density = 1.0
            particle_mass = 1.0
            [[liquid]]
            name = "heavy"
            density = 2.0
            particle_mass = 3.0
            [[disc]]
            material = "light"
            center = [-3.0, 0.3]
            radius = 3.0
            velocity = [1.0, 0.0]
            [[disc]]
            material = "heavy"
            center = [3.0, 0.0]
            radius = 2.0
            "#
        ));
        let start = drops.diagnostics().momentum;
        run_until(&mut drops, 0.5);
        (drops.diagnostics().momentum - start).length() / start.length()
    };
    let (kept, lost) = (momentum("none"), momentum("neighbors"));
    println!("momentum changes by {kept:.1e} without averaging, {lost:.1e} with it");
    assert!(kept < 1e-4, "{kept}");
    assert!(lost > 1e-2, "averaging by neighbours does not keep momentum: {lost}");
}

/// Worst compression of a column 12 deep after two seconds, with these keys of the legacy table.
fn compression(keys: &str) -> f64 {
    let mut column = solver(&format!(
        r#"
        spacing = 0.1
        [solver]
        substeps = 8
        gradients = "predicted"
        [legacy]
        {keys}
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [1.2, 1.2]
        [[tank]]
        min = [0.0, 0.0]
        max = [1.2, 2.4]
        "#
    ));
    run_until(&mut column, 2.0);
    column.diagnostics().density_error_max
}

#[test]
fn a_column_stands_with_other_kernels_and_is_softer_with_constraint_mixing() {
    let [wendland, same, spline] = ["", "kernel = \"wendland_c2\"", "kernel = \"cubic_spline\""].map(compression);
    let [mixed, pressed, boiling] =
        ["constraint_mixing = 1.0", "artificial_pressure = 0.02", "kernel = \"poly6_spiky\""].map(compression);
    println!("compressed by {wendland}, {spline} (spline), {mixed} (mixing), {pressed} (pressure), {boiling} (poly6)");
    assert_eq!(wendland, same);
    assert!(wendland < 0.01 && spline < 0.02 && spline != wendland, "{wendland} {spline}");
    assert!(mixed > 1.2 * wendland && mixed < 0.05, "{mixed}");
    assert!(pressed != wendland && pressed < 0.05, "{pressed}");
    assert!(boiling > 2.0 * wendland, "{boiling}");
}
