//! Logs as files of other tools.

use crate::support::Place;

/// A log with particles, bodies, velocities and diagnostics.
fn recorded() -> Place {
    let place = Place::new();
    place.write(
        "float.toml",
        r#"
        name = "Float"
        spacing = 0.1
        duration = 0.1
        fps = 50
        [[liquid]]
        name = "water"
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [1.0, 0.5]
        [[tank]]
        min = [0.0, 0.0]
        max = [1.0, 2.0]
        open = ["top"]
        [[body]]
        name = "box, red"
        size = [0.4, 0.3]
        position = [0.5, 0.9]
        density = 500.0
        "#,
    );
    place.run(&["float.toml", "-q", "--fields", "velocity,samples"]).exits(0);
    place
}

fn table(place: &Place, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(place.path(name)).unwrap();
    let head = reader.headers().unwrap().iter().map(String::from).collect();
    (head, reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect())
}

#[test]
fn tables_have_a_row_per_particle_body_and_frame() {
    let place = recorded();
    place.run(&["export", "float.mcap", "-o", "tables", "--format", "csv"]).exits(0);
    let (head, rows) = table(&place, "tables/particles.csv");
    assert_eq!(head, ["frame", "time", "id", "phase", "material", "x", "y", "velocity_x", "velocity_y"]);
    let info = place.run(&["info", "float.mcap", "--json"]).exits(0).object();
    let frames = info["frames"].as_u64().unwrap() as usize;
    let particles = info["particles"].as_u64().unwrap() as usize;
    assert_eq!((frames, rows.len()), (6, frames * particles));
    assert!(rows.iter().filter(|row| row[3] == "liquid").all(|row| row[4] == "water"));
    let (head, rows) = table(&place, "tables/bodies.csv");
    assert_eq!(rows.len(), frames);
    assert_eq!((head[3].as_str(), rows[0][3].as_str(), rows[0][5].as_str()), ("name", "box, red", "0.9"));
    let fallen: f64 = rows[5][5].parse().unwrap();
    assert!(fallen < 0.9 && fallen > 0.8, "{fallen}");
    let (head, rows) = table(&place, "tables/diagnostics.csv");
    assert!(head.contains(&"kinetic_energy".to_owned()) && head.contains(&"count_liquid".to_owned()), "{head:?}");
    assert_eq!(rows.len(), frames);
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_tables_hold_what_the_text_tables_hold() {
    use parquet::file::reader::{FileReader, SerializedFileReader};

    let place = recorded();
    for format in ["csv", "parquet"] {
        place.run(&["export", "float.mcap", "-o", "tables", "--format", format]).exits(0);
    }
    place.run(&["export", "float.mcap", "-o", "again", "--format", "parquet"]).exits(0);
    for name in ["particles", "bodies", "diagnostics"] {
        let bytes = |folder: &str| std::fs::read(place.path(&format!("{folder}/{name}.parquet"))).unwrap();
        assert!(bytes("tables") == bytes("again"), "{name} comes out the same twice");
        let (head, rows) = table(&place, &format!("tables/{name}.csv"));
        let file = std::fs::File::open(place.path(&format!("tables/{name}.parquet"))).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let found: Vec<parquet::record::Row> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
        assert_eq!(found.len(), rows.len(), "{name}");
        for (found, row) in found.iter().zip(&rows) {
            let columns: Vec<(&String, &parquet::record::Field)> = found.get_column_iter().collect();
            assert!(columns.iter().map(|(name, _)| *name).eq(&head), "{name}: {head:?}");
            for ((name, value), text) in columns.into_iter().zip(row) {
                // Parquet's own words for text and small numbers differ from those of CSV.
                let value = value.to_string();
                let same = value.trim_matches('"') == text || value.parse::<f64>() == text.parse::<f64>();
                assert!(same, "{name}: {value} is not {text}");
            }
        }
    }
}

#[test]
fn vtk_files_hold_as_many_bytes_as_they_declare() {
    let place = recorded();
    place.run(&["export", "float.mcap", "-o", "vtk", "--format", "vtk", "--every", "5"]).exits(0);
    let collection = std::fs::read_to_string(place.path("vtk/particles.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 2);
    for name in ["particles_000000.vtp", "particles_000005.vtp", "bodies_000005.vtp", "walls.vtp"] {
        let bytes = std::fs::read(place.path(&format!("vtk/{name}"))).unwrap();
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let start = bytes.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        let mut ends = 0;
        for place in text.match_indices("offset=\"").map(|(at, found)| at + found.len()) {
            let offset: usize = text[place..].split('"').next().unwrap().parse().unwrap();
            assert_eq!(offset, ends, "{name}: blocks follow each other");
            let length: [u8; 8] = bytes[start + offset..start + offset + 8].try_into().unwrap();
            ends = offset + 8 + u64::from_le_bytes(length) as usize;
        }
        assert!(bytes[start + ends..].starts_with(b"\n</AppendedData>"), "{name}");
    }
}

#[test]
fn arrays_hold_every_frame_and_come_out_the_same_twice() {
    let place = recorded();
    place.run(&["export", "float.mcap", "-o", "a.npz"]).exits(0);
    place.run(&["export", "float.mcap", "-o", "b.npz", "--format", "npz"]).exits(0);
    let bytes = ["a.npz", "b.npz"].map(|name| std::fs::read(place.path(name)).unwrap());
    assert_eq!(bytes[0], bytes[1]);
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(&bytes[0])).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    for name in ["time", "position", "velocity", "id", "body_pose", "kinetic_energy"] {
        assert!(names.contains(&format!("{name}.npy")), "{name} in {names:?}");
    }
    let array = npyz::NpyFile::new(archive.by_name("body_pose.npy").unwrap()).unwrap();
    assert_eq!(array.shape(), [6, 1, 3]);
    let poses: Vec<f64> = array.into_vec().unwrap();
    assert_eq!(poses[..3], [0.5, 0.9, 0.0]);
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let place = recorded();
    let said = |arguments: &[&str], exit: i32| place.run(arguments).exits(exit).stderr();
    assert!(said(&["export", "float.mcap", "-o", "x"], 2).contains("--format"));
    assert!(said(&["export", "float.mcap", "-o", "float.mcap", "--format", "npz"], 2).contains("input"));
    assert!(said(&["export", "float.mcap", "-o", "x.npz", "--from", "9"], 2).contains("none of the 6 frames"));
    assert!(said(&["export", "float.toml", "-o", "x.npz"], 1).contains("not"));
    place.write("x.npz", "precious");
    assert!(said(&["export", "float.mcap", "-o", "x.npz"], 2).contains("--force"));
    assert_eq!(std::fs::read_to_string(place.path("x.npz")).unwrap(), "precious");
}
