//! Quick sizes of the cases against their bands, and a part of the stresses.

use unipbd_core::scene::{GradientPoint, PressureGridUse, Scene, SolverSettings, Substeps};
use unipbd_validation::plan::{Line, lines, settings};
use unipbd_validation::report::{Entry, section};
use unipbd_validation::stress::map::MAPS;
use unipbd_validation::stress::{Ending, NAMED, endure_random, fuzz, quiet};
use unipbd_validation::{cases, precision};

/// Runs a case at its quick size; fails with all figures that miss their bands.
#[track_caller]
fn holds(name: &str) {
    let case = cases::find(name).unwrap_or_else(|| panic!("no case {name}"));
    let outcome = case.run(case.quick, &settings(0.01)).unwrap_or_else(|failure| panic!("{failure}"));
    for figure in &outcome.figures {
        println!("{name}: {}: {:.5e} ({})", figure.what, figure.value, figure.band);
    }
    let missed: Vec<String> =
        outcome.missed().map(|figure| format!("{}: {:.5e} ({})", figure.what, figure.value, figure.band)).collect();
    assert!(missed.is_empty(), "{name} misses:\n  {}", missed.join("\n  "));
}

/// Runs a case at its quick size with the pressure grid; fails with all figures that miss their bands.
#[track_caller]
fn holds_with_grid(name: &str) {
    let case = cases::find(name).unwrap_or_else(|| panic!("no case {name}"));
    let entry = Entry::run(Line::quick(case));
    assert!(entry.line.grid, "{name}");
    let outcome = entry.result.unwrap_or_else(|failure| panic!("{failure}"));
    let missed: Vec<_> = outcome.missed().collect();
    assert!(missed.is_empty(), "{name} misses:\n  {missed:?}");
}

/// The usual target, with the pressure grid.
fn grid() -> SolverSettings {
    SolverSettings { pressure_grid: PressureGridUse::On, ..settings(0.01) }
}

/// A wide kernel with the constraint taken early, at the cost of the default setting.
fn early() -> SolverSettings {
    SolverSettings {
        substeps: Substeps::Fixed(6),
        kernel_radius: 3.0,
        relaxation: Some(0.4),
        gradients: Some(GradientPoint::Early),
        ..SolverSettings::default()
    }
}

/// One figure of a case.
#[track_caller]
fn figure(name: &str, resolution: u32, solver: &SolverSettings, what: &str) -> f64 {
    let case = cases::find(name).unwrap_or_else(|| panic!("no case {name}"));
    let outcome = case.run(resolution, solver).unwrap_or_else(|failure| panic!("{failure}"));
    let figure = outcome.figures.iter().find(|figure| figure.what == what);
    let value = figure.unwrap_or_else(|| panic!("{name} has no figure \"{what}\"")).value;
    println!("{name} at {resolution}: {what}: {value:.5e}");
    value
}

#[test]
fn dam_break_follows_the_experiment() {
    holds("dam_break");
}

#[test]
fn upright_boxes_float_at_their_draft() {
    holds("floating_box");
}

#[test]
fn heavy_over_light_overturns_at_the_known_rate() {
    holds("rayleigh_taylor");
}

#[test]
fn vortices_decay_as_fast_as_their_viscosity_says() {
    let error = |solver: &SolverSettings| figure("taylor_green", 50, solver, "kinetic energy error to t = 1");
    let shifted = error(&settings(0.01));
    assert!(shifted <= 0.06, "{shifted}");
    let plain = error(&SolverSettings { shifting: Some(0.0), ..settings(0.01) });
    assert!(plain >= 2.0 * shifted, "shifting is what keeps the energy: {plain} without");
}

#[test]
fn a_lid_drags_the_fluid_under_it_along() {
    holds("couette");
}

#[test]
fn thin_gas_falls_at_its_terminal_speed() {
    holds("drag");
}

#[test]
fn an_elliptical_drop_keeps_its_axes() {
    let eight = SolverSettings { substeps: Substeps::Fixed(8), ..SolverSettings::default() };
    let outcome = cases::find("elliptical_drop").expect("the case exists").run(50, &eight);
    let outcome = outcome.unwrap_or_else(|failure| panic!("{failure}"));
    let missed: Vec<_> = outcome.missed().collect();
    assert!(missed.is_empty(), "{missed:?}");
}

#[test]
fn taken_early_with_a_wide_kernel_a_wave_loses_less_than_a_sixth_per_period() {
    assert!(figure("standing_wave", 64, &early(), "decay per period") <= 0.17);
    assert!(figure("standing_wave", 64, &early(), "period error").abs() <= 0.045);
    assert!(figure("dam_break", 20, &early(), "worst C") <= 0.06);
    assert!(figure("dam_break", 20, &early(), "energy gain") <= 0.005);
}

#[test]
fn a_column_presses_with_its_weight() {
    let solver = settings(0.01);
    assert!(figure("column", 20, &solver, "pressure slope error").abs() <= 0.02);
    assert!(figure("column", 20, &solver, "error of the force on the floor").abs() <= 0.001);
    assert!(figure("two_layers", 24, &solver, "pressure error of the upper layer").abs() <= 0.02);
    assert!(figure("two_layers", 24, &solver, "pressure error of the lower layer").abs() <= 0.02);
    assert!(figure("two_layers", 24, &solver, "error of the force on the floor").abs() <= 0.002);
}

#[test]
fn with_the_grid_water_runs_out_of_a_hole_as_it_does() {
    holds_with_grid("drain");
    let eight = figure("drain", 8, &grid(), "discharge coefficient");
    assert!((0.60..=0.67).contains(&eight), "{eight}");
}

#[test]
fn with_the_grid_a_disc_that_is_let_go_takes_water_along() {
    holds_with_grid("added_mass");
    let twelve = figure("added_mass", 12, &grid(), "largest acceleration error");
    assert!(twelve < 0.03, "in a ring that does not lie on the grid: {twelve}");
}

#[test]
fn with_the_grid_light_floats_are_calm() {
    holds_with_grid("light_floats");
    let wide = figure("light_floats", 24, &grid(), "speed over sqrt(g b) at density ratio 0.01");
    assert!(wide < 0.03, "a wide one: {wide}");
}

#[test]
fn with_the_grid_a_solitary_wave_keeps_its_crest_over_twenty_depths() {
    holds_with_grid("solitary_wave");
}

#[test]
fn with_the_grid_vortices_carry_each_other_along_in_liquid_and_gas() {
    holds_with_grid("vortex_pair");
    holds_with_grid("vortex_pair_gas");
}

#[test]
fn with_the_grid_loads_on_shut_in_water_and_falling_water_stop() {
    holds_with_grid("piston");
    holds_with_grid("press");
    holds_with_grid("slab");
}

#[test]
fn with_the_grid_vortices_between_walls_decay_nearly_as_their_viscosity_says() {
    let fitted = figure("taylor_green_box", 100, &grid(), "fitted viscosity over the true one");
    assert!((0.9..=1.25).contains(&fitted), "{fitted}");
}

#[test]
fn with_the_grid_what_rests_takes_no_more_substeps_the_more_there_is() {
    let outcome = Entry::run(Line::quick(cases::find("work").expect("the case exists"))).result.expect("it runs");
    for kind in ["two layers", "floats", "closed gas"] {
        let power = outcome.figure(&format!("{kind}: power of the substeps")).expect("it is measured");
        assert!(power <= 0.04, "{kind}: {power}");
    }
}

#[test]
fn too_few_substeps_stay_finite_and_contained_and_enough_keep_the_energy() {
    for (map, row, few, enough) in [(&MAPS[0], 10.0, 2, 8), (&MAPS[1], 30.0, 1, 8), (&MAPS[2], 100.0, 2, 16)] {
        let few = map.cell(row, Substeps::Fixed(few));
        assert_eq!(few.broken, None, "{} {row}: {few:?}", map.name);
        let enough = map.cell(row, Substeps::Fixed(enough));
        assert!(enough.is_sound() && enough.worst < few.worst, "{} {row}: {enough:?} {few:?}", map.name);
    }
}

#[test]
fn single_precision_keeps_up_with_double_near_and_far_from_the_origin() {
    let single = precision::measure().unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(single.iter().filter(|s| !s.momentum.is_nan()).count(), 3);
    for s in &single {
        assert!(s.momentum.is_nan() || s.momentum <= 1e-5, "{s:?}");
        assert!(s.gain <= 0.005, "{s:?}");
    }
    // The core is compiled once more for the other half.
    if std::env::var_os("UNIPBD_FULL").is_none() {
        println!("SKIP double precision: full size, run with UNIPBD_FULL=1");
        return;
    }
    let double = precision::measure_double().unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(single.len(), double.len());
    for (s, d) in single.iter().zip(&double) {
        // Two tanks far apart have no middle that is near both.
        let bar = if s.scene.contains("apart") { 0.03 } else { 0.02 };
        assert!((s.mean - d.mean).abs() <= bar * d.mean, "{s:?} {d:?}");
        assert!(d.momentum.is_nan() || d.momentum <= 1e-12, "{d:?}");
        assert!((s.energy - d.energy).abs() <= 0.01, "{s:?} {d:?}");
        assert!(d.gain <= 0.005, "{d:?}");
    }
}

/// Scenes that once broke: made small by the fuzzer, kept as it wrote them.
#[test]
fn scenes_that_once_broke_end_sound_or_stop() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/regressions");
    let files =
        std::fs::read_dir(folder).expect("the folder is there").map(|file| file.expect("it is readable").path());
    let mut files: Vec<_> = files.collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).expect("it is readable");
        let scene: Scene = toml::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let ending = endure_random(&scene);
        println!("{}: {ending:?}", file.display());
        assert!(ending.is_good() && ending != Ending::Refused, "{}: {ending:?}", file.display());
    }
}

#[test]
fn a_quiet_pool_stays_what_it_is() {
    let quiet = quiet(20_000).expect("it does not diverge");
    println!("{quiet:?}");
    assert!(quiet.is_good(), "{quiet:?}");
}

#[test]
fn named_stresses_end_sound_or_stop() {
    for stress in NAMED {
        let ending = (stress.run)();
        println!("{}: {ending:?}", stress.name);
        assert!(ending.is_good(), "{}: {ending:?}", stress.name);
    }
}

#[test]
fn random_scenes_end_sound_or_stop() {
    let counts = fuzz(0..100, |seed, ending| {
        if matches!(ending, Ending::Broken(_)) {
            println!("seed {seed}: {ending:?}");
        }
    });
    assert!(counts.broken.is_empty(), "{:?}", counts.broken);
}

#[test]
fn the_sheet_has_a_row_for_every_figure() {
    let entry = Entry::run(Line::quick(cases::find("drag").expect("the case exists")));
    let figures = entry.result.as_ref().expect("the case runs").figures.len();
    let (heading, text) = section(&[entry]).expect("there is an entry");
    assert_eq!(text.lines().filter(|line| line.starts_with("| 1 | 0.01 |")).count(), figures, "{text}");
    assert!(text.contains("holds") && text.contains("commit") && heading == "drag", "{text}");
}

/// Scenes change under the cases: a sheet that takes an hour must not end in rows that were refused.
#[test]
fn every_line_of_the_sheet_can_be_built_and_begun() {
    let built = |line: Line| line.case.build(line.resolution, &line.solver()).err().map(|why| format!("{line}: {why}"));
    let failed: Vec<String> = cases::ALL.iter().flat_map(lines).filter_map(built).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn the_committed_sheet_has_no_row_that_failed() {
    let sheet = include_str!("../../../docs/accuracy.md");
    let failed: Vec<&str> = sheet.lines().filter(|line| line.contains("fails:")).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
