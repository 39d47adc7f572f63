//! Documents that follow from the code. `UPDATE_DOCUMENTS=1 cargo test -p unipbd-tests documents` writes them anew.

use std::fmt::Write;

use unipbd_core::observe::{Diagnostics, Entry, GaugeReading, GroupDiagnostics, MaterialDiagnostics, Table, WallForce};
use unipbd_tests::repository;

const DIAGNOSTICS: &str = "\
# Diagnostics

The state of a run in numbers, once per frame. This page follows from the table in
[`observe/diagnostics.rs`](../crates/unipbd-core/src/observe/diagnostics.rs) of the core; so do all of these:

| where | how to get it | names |
|---|---|---|
| Rust | `Solver::diagnostics` | quantities |
| Python | `Simulation.diagnostics()`, `LogFrame.diagnostics` | quantities; a vector is a tuple |
| JSON | `unipbd run --json`, `unipbd info LOG --json` under `last` | quantities; a vector is an array |
| log | topic `/diagnostics`, message `unipbd.Diagnostics` | columns |
| tables | `Log.diagnostics()` and `Log.to_pandas()` in Python | columns |
| condition | `unipbd run --stop-on \"NAME>NUMBER\"` | columns that are numbers, and a few short names |

Columns are named as their quantity, but a vector has two and counts by phase have one for each phase.
C = rho/rho0 - 1 is the density error: positive where a fluid is compressed, negative where it is dilated. The unit 1
marks fractions. A log and Python's reading of one also have the `state_hash`.
";

fn table<T: Table>(text: &mut String, title: &str) {
    let _ = write!(text, "\n## {title}\n\n| quantity | unit | description | columns |\n|---|---|---|---|\n");
    for quantity in T::QUANTITIES {
        let columns = quantity.columns();
        let columns = if columns == [quantity.name] { String::new() } else { format!("`{}`", columns.join("`, `")) };
        let description = quantity.description.replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {} | {description} | {columns} |", quantity.name, quantity.unit);
    }
}

fn entries<T: Entry>(text: &mut String, of: &str) {
    table::<T>(text, &format!("Of each {of}, by its name, under `{}`", T::LIST));
}

#[test]
fn the_page_on_diagnostics_is_that_of_the_table() {
    let mut expected = DIAGNOSTICS.to_owned();
    table::<Diagnostics>(&mut expected, "Of a frame");
    entries::<MaterialDiagnostics>(&mut expected, "material");
    entries::<GroupDiagnostics>(&mut expected, "constraint group");
    entries::<WallForce>(&mut expected, "wall with a name");
    entries::<GaugeReading>(&mut expected, "gauge");
    let path = repository().join("docs/diagnostics.md");
    if std::env::var_os("UPDATE_DOCUMENTS").is_some() {
        std::fs::write(&path, &expected).expect("the page can be written");
    }
    let page = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert_eq!(page, expected, "docs/diagnostics.md is out of date: UPDATE_DOCUMENTS=1 writes it anew");
}
