//! Gauges on the command line: conditions, tables, descriptions, plots.

use crate::support::{DROP, Place};

/// The drop with a front and a gauge that never reads anything.
fn place() -> Place {
    let place = Place::new();
    let gauges = "[[gauge]]\nname = \"front\"\nkind = \"front\"\ndirection = [1.0, 0.0]\n\
                  [[gauge]]\nname = \"dry\"\nkind = \"level\"\nat = [90.0, 0.0]\n";
    place.write("gauges.toml", &format!("{DROP}\n{gauges}"));
    place
}

#[test]
fn a_run_stops_when_a_gauge_passes_a_threshold_and_never_for_one_that_reads_nothing() {
    let place = place();
    let run = |condition: &str| place.run(&["gauges.toml", "--no-record", "--json", "--stop-on", condition]);
    let stopped = run("gauge.front>1.05").exits(5).summary();
    assert!(stopped["message"].as_str().unwrap().starts_with("--stop-on gauge.front>1.05: 1.0"), "{stopped}");
    run("gauge.dry>-1").exits(0);
    run("gauge.dry<1").exits(0);
    let said = run("gauge.frnt>1").exits(2).stderr();
    assert!(said.contains("no gauge \"frnt\"; did you mean \"gauge.front\"?"), "{said}");
}

#[test]
fn readings_are_null_in_json_and_empty_in_tables_where_there_is_nothing() {
    let place = place();
    let frames = place.run(&["gauges.toml", "--json"]).exits(0).objects();
    let front = frames[0]["gauges"]["front"]["value"].as_f64().unwrap();
    assert!((front - 1.0).abs() < 0.05 && frames[0]["gauges"]["dry"]["value"].is_null(), "{}", frames[0]);
    place.run(&["export", "gauges.mcap", "-o", "tables", "--format", "csv"]).exits(0);
    let mut table = csv::Reader::from_path(place.path("tables/diagnostics.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    assert_eq!(head.iter().rev().take(2).collect::<Vec<_>>(), ["gauge_dry", "gauge_front"]);
    let row = table.records().next().unwrap().unwrap();
    assert_eq!((row[head.len() - 2].parse(), &row[head.len() - 1]), (Ok(front), ""));
    let said = place.run(&["info", "gauges.mcap"]).exits(0).stdout();
    assert!(said.contains("gauge front: 1.") && said.contains("gauge dry: nothing to read"), "{said}");
    place.run(&["export", "gauges.mcap", "-o", "run.npz"]).exits(0);
    let file = std::fs::File::open(place.path("run.npz")).unwrap();
    let mut archive = zip::ZipArchive::new(file).unwrap();
    let read = |archive: &mut zip::ZipArchive<std::fs::File>, name: &str| {
        npyz::NpyFile::new(archive.by_name(name).unwrap()).unwrap().into_vec::<f64>().unwrap()
    };
    assert_eq!(read(&mut archive, "gauge_front.npy")[0], front);
    assert!(read(&mut archive, "gauge_dry.npy").iter().all(|value| value.is_nan()));
}

#[test]
fn a_layout_of_viewers_plots_the_gauges() {
    let place = place();
    place.run(&["gauges.toml", "-q"]).exits(0);
    let layout = place.run(&["layout", "gauges.mcap"]).exits(0).stdout();
    let layout: serde_json::Value = serde_json::from_str(&layout).unwrap();
    let paths = layout["configById"]["Plot!gauges"]["paths"].as_array().unwrap();
    assert_eq!(paths.iter().map(|path| &path["value"]).collect::<Vec<_>>(), ["/gauges.front", "/gauges.dry"]);
    assert_eq!(layout["layout"]["second"]["first"], "Plot!gauges");
    assert_eq!(layout["layout"]["second"]["second"]["first"], "Plot!error");
}

#[test]
fn plots_are_drawn_in_every_format() {
    let place = place();
    place.run(&["gauges.toml", "-q"]).exits(0);
    let said = place.run(&["plot", "gauges.mcap"]).exits(0).stderr();
    assert!(said.contains("dry has nothing to read") && said.contains("gauges.svg: 2 curves"), "{said}");
    let names = ["--gauge", "front", "--gauge", "energy", "--gauge", "kinetic_energy", "--gauge", "substeps"];
    for (name, magic) in [("a.svg", &b"<svg"[..]), ("a.pdf", b"%PDF"), ("a.png", b"\x89PNG")] {
        let arguments = [&["plot", "gauges.mcap", "-o", name, "--from", "0.05"], &names[..]].concat();
        place.run(&arguments).exits(0);
        assert!(std::fs::read(place.path(name)).unwrap().starts_with(magic), "{name}");
        // A plot of the same run is made anew; another file is kept.
        place.run(&arguments).exits(0);
        std::fs::write(place.path(name), "mine").unwrap();
        assert!(place.run(&arguments).exits(2).stderr().contains("--force"));
    }
    let object =
        place.run(&["plot", "gauges.mcap", "-o", "b.svg", "--json", "--gauge", "momentum_y"]).exits(0).object();
    assert_eq!((&object["curves"][0], object["frames"].as_u64()), (&"momentum y".into(), Some(11)));
}

#[test]
fn what_a_log_does_not_have_is_refused_with_what_it_has() {
    let place = place();
    place.run(&["gauges.toml", "-q"]).exits(0);
    place.run(&["drop.toml", "-q"]).exits(0);
    let said = |arguments: &[&str]| place.run(arguments).exits(2).stderr();
    let none = said(&["plot", "drop.mcap"]);
    assert!(none.contains("the log has no gauges") && none.contains("kinetic_energy, potential_energy"), "{none}");
    let unknown = said(&["plot", "gauges.mcap", "--gauge", "frnt"]);
    assert!(
        unknown.contains("did you mean \"front\"?") && unknown.contains("it has the gauges dry, front"),
        "{unknown}"
    );
    assert!(said(&["plot", "gauges.mcap", "--gauge", "substeps_reason"]).contains("has no \"substeps_reason\""));
    assert!(said(&["plot", "gauges.mcap", "-o", "a.gif"]).contains("NAME.svg, NAME.pdf or NAME.png"));
    assert!(said(&["plot", "gauges.mcap", "-o", "gauges.mcap", "--force"]).contains("input"));
    assert!(said(&["plot", "gauges.mcap", "--from", "9"]).contains("none of the 11 frames"));
}
