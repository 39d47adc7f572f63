//! Reading scene files: good ones, overrides, broken ones by the thousand.

use std::path::{Path, PathBuf};

use unipbd_cli::scene_file::{self, Origin, Override, SceneFileError};
use unipbd_core::rng::Rng;
use unipbd_core::scene::Substeps;

fn shipped_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    scenes.sort();
    assert!(scenes.len() >= 2);
    scenes
}

fn text_of(name: &str) -> String {
    let path = shipped_scenes().into_iter().find(|path| path.ends_with(name)).unwrap();
    std::fs::read_to_string(path).unwrap()
}

fn overrides(changes: &[&str]) -> Vec<Override> {
    changes.iter().map(|change| change.parse().unwrap()).collect()
}

#[test]
fn shipped_scenes_have_no_problems() {
    for path in shipped_scenes() {
        let loaded = scene_file::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.text, std::fs::read_to_string(&path).unwrap());
        assert_eq!(loaded.sha256.len(), 64);
        assert_eq!(loaded.path, path);
    }
}

#[test]
fn text_is_named_by_its_sha256() {
    let text = "block = []\n[[liquid]]\nname = \"w\"\n[[disc]]\nmaterial = \"w\"\ncenter = [0, 0]\nradius = 1\n";
    let loaded = scene_file::parse(text, "x.toml", &[]).unwrap();
    let other = scene_file::parse(&format!("{text}\n"), "x.toml", &[]).unwrap();
    assert_eq!(loaded.sha256, "2523ab8d0d3a3bbc992da990c869e11967597343f8e46b73ade8f79cb4e5039d");
    assert_ne!(loaded.sha256, other.sha256);
}

#[test]
fn whole_numbers_serve_as_floats() {
    let loaded = scene_file::parse(&text_of("dam_break.toml"), "x", &overrides(&["gravity=[0, -9]"])).unwrap();
    assert_eq!(loaded.scene.gravity, [0.0, -9.0]);
}

#[test]
fn overrides_reach_every_kind_of_place() {
    let changes = overrides(&[
        "solver.substeps=16",
        "duration = 1",
        "emitter.0.speed=2",
        "emitter[0].sheath.thickness = 0.3",
        "emitter.nozzle.smoke.per_particle=3",
        "gas.air.drag=10",
        "gravity.1=-1.5",
        "solver.gradients=start",
        "name=\"a = b\"",
        "domain.remove_above=[9.0, 9.0]",
    ]);
    let scene = scene_file::parse(&text_of("open_gas.toml"), "x.toml", &changes).unwrap().scene;
    assert_eq!(scene.solver.substeps, Substeps::Fixed(16));
    assert_eq!((scene.duration, scene.emitter[0].speed, scene.gas[0].drag), (1.0, 2.0, 10.0));
    assert_eq!(scene.emitter[0].sheath.as_ref().unwrap().thickness, 0.3);
    assert_eq!(scene.emitter[0].smoke.as_ref().unwrap().per_particle, 3);
    assert_eq!((scene.gravity[1], scene.name.as_str()), (-1.5, "a = b"));
    assert!(scene.solver.gradients.is_some());
    assert_eq!(scene.domain.remove_above, Some([9.0, 9.0]));
}

#[test]
fn later_override_of_a_key_wins() {
    let changes = overrides(&["fps=30", "fps=90"]);
    assert_eq!(scene_file::parse(&text_of("dam_break.toml"), "x", &changes).unwrap().scene.fps, 90.0);
}

#[test]
fn problem_of_an_override_names_it() {
    let error = scene_file::parse(&text_of("dam_break.toml"), "x", &overrides(&["fps=0"])).unwrap_err();
    let [problem] = error.problems() else { panic!("{error}") };
    assert_eq!(problem.origin, Origin::Override("fps=0".to_owned()));
    assert_eq!((problem.key.as_str(), problem.column), ("fps", 5));
}

#[test]
fn text_without_equals_sign_is_no_override() {
    for text in ["fps", "", "=3", "  = 3"] {
        assert!(text.parse::<Override>().is_err(), "{text}");
    }
}

#[test]
fn missing_file_is_an_input_error() {
    let error = scene_file::load("no/such/scene.toml", &[]).unwrap_err();
    assert!(matches!(error, SceneFileError::Io { .. }));
    assert!(error.to_string().contains("cannot read no/such/scene.toml"), "{error}");
    assert!(matches!(scene_file::load(env!("CARGO_MANIFEST_DIR"), &[]), Err(SceneFileError::Io { .. })));
}

#[test]
fn file_of_many_megabytes_is_refused() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), vec![b'#'; 5 << 20]).unwrap();
    let error = scene_file::load(file.path(), &[]).unwrap_err();
    assert!(error.to_string().contains("larger than 4 MiB"), "{error}");
}

#[test]
fn colour_adds_nothing_but_escape_codes() {
    let error = scene_file::parse("fps = 0\n[[blok]]\n", "x.toml", &[]).unwrap_err();
    let styled = error.styled().to_string();
    assert!(styled.contains("\u{1b}["));
    assert_eq!(anstream::adapter::strip_str(&styled).to_string(), error.to_string());
}

#[test]
fn schema_refuses_unknown_keys_and_has_no_null() {
    let schema = scene_file::schema();
    assert_eq!(schema["additionalProperties"], false);
    assert_eq!(schema["title"], "unipbd scene");
    assert!(schema["$schema"].as_str().unwrap().contains("json-schema.org"));
    for (name, definition) in schema["$defs"].as_object().unwrap() {
        if definition["type"] == "object" {
            assert_eq!(definition["additionalProperties"], false, "{name}");
        }
    }
    assert!(!schema.to_string().contains("\"null\""));
}

fn below(random: &mut Rng, bound: usize) -> usize {
    (random.next_u64() % bound as u64) as usize
}

/// Changes a few bytes: replaces, removes, doubles, or moves a stretch from elsewhere.
fn mutate(bytes: &mut Vec<u8>, random: &mut Rng) {
    const TELLING: &[u8] = b"[]{}=\".,#-+eE019 \n\t\\'\0\xff\xc3_:nai";
    for _ in 0..=below(random, 4) {
        let at = below(random, bytes.len());
        match below(random, 5) {
            0 => bytes[at] = TELLING[below(random, TELLING.len())],
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, TELLING[below(random, TELLING.len())]),
            3 => bytes[at] ^= 1 << below(random, 8),
            _ => {
                let from = below(random, bytes.len());
                let to = (from + below(random, 60)).min(bytes.len());
                let stretch = bytes[from..to].to_vec();
                bytes.splice(at..at, stretch);
            }
        }
    }
}

#[test]
fn no_damage_to_a_scene_makes_the_reader_panic() {
    let mut random = Rng::from_state(20_24);
    let file = tempfile::NamedTempFile::new().unwrap();
    let (mut faulty, mut fine) = (0, 0);
    let rounds = if std::env::var_os("UNIPBD_FULL").is_some() { 2000 } else { 150 };
    for path in shipped_scenes() {
        let text = std::fs::read(&path).unwrap();
        for _ in 0..rounds {
            let mut bytes = text.clone();
            mutate(&mut bytes, &mut random);
            let read = String::from_utf8(bytes).map(|text| scene_file::parse(&text, "damaged.toml", &[]));
            let result = read.unwrap_or_else(|not_text| {
                std::fs::write(file.path(), not_text.into_bytes()).unwrap();
                scene_file::load(file.path(), &[])
            });
            match result {
                Ok(loaded) => {
                    fine += 1;
                    assert!(loaded.scene.validate().0.is_empty());
                }
                Err(error) => {
                    faulty += 1;
                    assert!(!error.problems().is_empty());
                    assert!(error.to_string().len() > 20);
                }
            }
        }
    }
    assert!(faulty > 1000 && fine > 300, "{faulty} faulty, {fine} fine");
}
