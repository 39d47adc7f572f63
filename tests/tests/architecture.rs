//! Imports of the core point down only.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use unipbd_tests::{code_of as code, repository, rust_files as files};

/// The modules of the core in layers, the lowest first. A module imports from layers below its own only.
/// The table of ARCHITECTURE.md lists the same layers.
const LAYERS: [&[&str]; 17] = [
    &["math"],
    &["phase", "gauge_kind", "rng", "parallel", "union_find"],
    &["bytes", "periodic"],
    &["particles", "rows", "shapes"],
    &["observe", "scene"],
    &["simd"],
    &["kernel"],
    &["neighbors", "walls"],
    &["passes"],
    &["rigid"],
    &["constraints"],
    &["coupling", "effects", "legacy", "pressure_grid", "sleep", "sources"],
    &["step"],
    &["edit"],
    &["build"],
    &["state"],
    &["lib"],
];

/// Kinds of constraint: a file or folder each, and none names another.
const CONSTRAINTS: [&str; 6] = ["batch", "density", "distance", "shape_matching", "surface_tension", "viscosity"];

fn core() -> PathBuf {
    repository().join("crates/unipbd-core/src")
}

/// The top module a file belongs to.
fn module(path: &Path) -> String {
    let inside = path.strip_prefix(core()).expect("the file is in the core");
    let first = inside.iter().next().expect("the path has a part").to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// The top modules named after `crate::`, be it one or a list in braces.
fn imports(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (start, _) in code.match_indices("crate::") {
        let before = code[..start].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &code[start + "crate::".len()..];
        match rest.strip_prefix('{') {
            Some(list) => found.extend(first_names(list)),
            None => found.extend(name(rest)),
        }
    }
    found
}

/// The first name of each entry of a list in braces, whose opening brace has been read.
fn first_names(list: &str) -> Vec<String> {
    let (mut names, mut depth, mut fresh) = (Vec::new(), 0, true);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => fresh = true,
            c if fresh && !c.is_whitespace() => {
                names.extend(name(&list[at..]));
                fresh = false;
            }
            _ => {}
        }
    }
    names
}

fn name(text: &str) -> Option<String> {
    let name: String = text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!name.is_empty()).then_some(name)
}

#[test]
fn the_reader_of_imports_finds_lists_and_paths() {
    let text =
        "use crate::math::Real;\nuse crate::{phase::{A, B}, rows};\nlet x = crate::scene::X; $crate::no; mycrate::no;";
    assert_eq!(imports(text), ["math", "phase", "rows", "scene"]);
}

#[test]
fn imports_of_the_core_point_down() {
    let layer_of: BTreeMap<&str, usize> = LAYERS
        .iter()
        .enumerate()
        .flat_map(|(layer, modules)| modules.iter().map(move |module| (*module, layer)))
        .collect();
    let mut wrong = Vec::new();
    let mut seen = 0;
    for path in files(&core()) {
        let module = module(&path);
        let Some(&layer) = layer_of.get(module.as_str()) else {
            wrong.push(format!("{}: the module {module} is in no layer", path.display()));
            continue;
        };
        for import in imports(&code(&path)) {
            seen += 1;
            let allowed = match layer_of.get(import.as_str()) {
                _ if import == module => true,
                Some(&below) if below < layer => true,
                _ => false,
            };
            if !allowed {
                wrong.push(format!("{}: imports {import}", path.display()));
            }
        }
    }
    assert!(seen > 100, "only {seen} imports were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_step_names_no_concrete_constraint() {
    for path in files(&core().join("step")) {
        let code = code(&path);
        let mut words = code.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let concrete = words.find(|word| ["Density", "DensitySettings", "Batch"].contains(word));
        assert!(concrete.is_none(), "{} names {concrete:?}", path.display());
        assert!(!code.contains("rigid::contact"), "{} names the contact solver", path.display());
    }
}

#[test]
fn only_the_builder_makes_density_groups_and_effects() {
    let makers =
        ["Density::new", "Drag::new", "Xsph::new", "Conduction::new", "VorticityConfinement::new", "Baroclinic::new"];
    for path in files(&core()) {
        let code = code(&path);
        for maker in makers.into_iter().filter(|maker| code.contains(maker)) {
            assert_eq!(module(&path), "build", "{} calls {maker}", path.display());
        }
    }
}

#[test]
fn only_the_builder_knows_the_legacy_options() {
    for path in files(&core()) {
        let known = imports(&code(&path)).iter().any(|import| import == "legacy");
        assert!(!known || ["legacy", "build"].contains(&module(&path).as_str()), "{} names legacy", path.display());
    }
}

#[test]
fn kinds_of_constraint_do_not_name_each_other() {
    let folder = core().join("constraints");
    for path in files(&folder) {
        let inside = path.strip_prefix(&folder).expect("the file is in the folder");
        let own = inside.iter().next().expect("a part").to_string_lossy().trim_end_matches(".rs").to_owned();
        if !CONSTRAINTS.contains(&own.as_str()) {
            continue;
        }
        let code = code(&path);
        for other in CONSTRAINTS.into_iter().filter(|other| *other != own) {
            for name in [format!("constraints::{other}"), format!("super::{other}::")] {
                assert!(!code.contains(&name), "{} names {name}", path.display());
            }
        }
    }
}

#[test]
fn the_core_reads_no_file_and_prints_nothing() {
    let forbidden = ["std::fs", "std::io", "println!", "eprintln!", "print!(", "dbg!(", "std::env"];
    for path in files(&core()) {
        let code = code(&path);
        for word in forbidden {
            assert!(!code.contains(word), "{} has {word}", path.display());
        }
    }
}

/// Systems round these differently, and bits must not depend on the system.
#[test]
fn the_core_takes_sines_and_exponentials_from_one_library() {
    let functions = "sin cos tan sin_cos asin acos atan atan2 sinh cosh tanh exp exp2 exp_m1 ln ln_1p log log2 log10 powf powi \
        hypot cbrt to_angle angle_to";
    for path in files(&core()) {
        let code = code(&path);
        assert!(!code.contains("::from_angle("), "{}: math::direction is the unit vector at an angle", path.display());
        for function in functions.split_whitespace() {
            assert!(
                !code.contains(&format!(".{function}(")),
                "{} calls {function} of a number, not of libm",
                path.display()
            );
        }
    }
}

#[test]
fn the_tables_name_modules_that_exist() {
    let exists = |name: &str| core().join(format!("{name}.rs")).exists() || core().join(name).is_dir();
    for module in LAYERS.into_iter().flatten() {
        assert!(exists(module), "there is no module {module}");
    }
    for kind in CONSTRAINTS {
        assert!(exists(&format!("constraints/{kind}")), "there is no constraint {kind}");
    }
}

#[test]
fn the_architecture_page_lists_the_same_layers() {
    let page = std::fs::read_to_string(repository().join("ARCHITECTURE.md")).expect("the page is there");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" | "));
    let numbered = rows.filter(|(number, _)| number.parse::<usize>().is_ok());
    let listed: Vec<Vec<&str>> = numbered
        .map(|(_, row)| row.split(" | ").next().unwrap_or_default().split('`').skip(1).step_by(2).collect())
        .collect();
    let layers: Vec<Vec<&str>> = LAYERS[..LAYERS.len() - 1].iter().map(|layer| layer.to_vec()).collect();
    assert_eq!(listed, layers);
}

#[test]
fn the_architecture_page_lists_every_stage() {
    let page = std::fs::read_to_string(repository().join("ARCHITECTURE.md")).expect("the page is there");
    let stages = code(&core().join("step/pipeline.rs"));
    let names = stages.split("Stage::").skip(1).filter_map(name).collect::<std::collections::BTreeSet<_>>();
    assert!(names.len() > 20, "only {} stages were found", names.len());
    for stage in names {
        assert!(page.contains(&format!("`{stage}`")), "ARCHITECTURE.md does not name the stage {stage}");
    }
}
