//! Quick sizes of the cases against their bands, and a part of the stresses.

use unipbd_validation::stress::{Ending, NAMED, fuzz};
use unipbd_validation::{cases, report};

/// Runs a case at its quick size; fails with all figures that miss their bands.
#[track_caller]
fn holds(name: &str) {
    let case = cases::find(name).unwrap_or_else(|| panic!("no case {name}"));
    let outcome = case.run(case.quick, &report::settings(0.01)).unwrap_or_else(|failure| panic!("{failure}"));
    for figure in &outcome.figures {
        println!("{name}: {}: {:.5e} ({})", figure.what, figure.value, figure.band);
    }
    let missed: Vec<String> =
        outcome.missed().map(|figure| format!("{}: {:.5e} ({})", figure.what, figure.value, figure.band)).collect();
    assert!(missed.is_empty(), "{name} misses:\n  {}", missed.join("\n  "));
}
