//! No two files import each other, but a module and its own parts.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use unipbd_tests::{code_of, repository, rust_files};

/// The path of a module from the root of its crate.
type Module = Vec<String>;

fn module_of(file: &Path, source: &Path) -> Module {
    let inside = file.strip_prefix(source).expect("the file is below the source folder").with_extension("");
    let mut parts: Module = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        parts.pop();
    }
    parts
}

/// The paths of a `use` tree, or of a path in an expression: `a::{b, c::d}` gives `a::b` and `a::c::d`.
fn paths_of(tree: &str) -> Vec<String> {
    let Some((prefix, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap_or_default().trim().to_owned()];
    };
    let (mut entries, mut depth, mut entry) = (Vec::new(), 0, String::new());
    for c in rest.trim_end().trim_end_matches('}').chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match c {
            ',' if depth == 0 => entries.push(std::mem::take(&mut entry)),
            c => entry.push(c),
        }
    }
    entries.push(entry);
    let named = entries.iter().filter(|entry| !entry.trim().is_empty());
    named.flat_map(|entry| paths_of(entry.trim())).map(|path| format!("{}{path}", prefix.trim())).collect()
}

/// All paths that a file names: those of `use`, and those in expressions that begin at a known place.
fn named_paths(code: &str) -> Vec<String> {
    let mut paths = Vec::new();
    for statement in code.split(';') {
        if let Some((_, tree)) = statement.rsplit_once("use ") {
            paths.extend(paths_of(&tree.replace('\n', " ")));
        }
    }
    for start in ["crate::", "super::", "self::"] {
        let begins = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
        for (at, _) in code.match_indices(start).filter(|(at, _)| begins(*at)) {
            let path = code[at..].split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).next();
            paths.extend(path.map(str::to_owned));
        }
    }
    paths
}

/// The module with a file of its own that a path leads to.
fn target(path: &str, from: &Module, modules: &BTreeSet<Module>) -> Option<Module> {
    let mut parts = path.split("::").map(str::trim).filter(|part| !part.is_empty()).peekable();
    let mut base = match parts.peek().copied()? {
        "crate" => Module::new(),
        "super" | "self" => from.clone(),
        first if modules.contains(&[from.clone(), vec![first.to_owned()]].concat()) => from.clone(),
        _ => return None,
    };
    while let Some(&part) = parts.peek() {
        match part {
            "crate" | "self" => {}
            "super" => drop(base.pop()),
            _ => break,
        }
        parts.next();
    }
    for part in parts {
        let inner = [base.clone(), vec![part.to_owned()]].concat();
        if !modules.contains(&inner) {
            break;
        }
        base = inner;
    }
    (base != *from).then_some(base)
}

fn imports_of(source: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    let files: BTreeMap<Module, PathBuf> =
        rust_files(source).into_iter().map(|file| (module_of(&file, source), file)).collect();
    let modules: BTreeSet<Module> = files.keys().cloned().collect();
    let imports = |(module, file): (&Module, &PathBuf)| {
        let paths = named_paths(&code_of(file));
        (module.clone(), paths.iter().filter_map(|path| target(path, module, &modules)).collect())
    };
    files.iter().map(imports).collect()
}

#[test]
fn no_two_files_import_each_other() {
    let mut circles = Vec::new();
    let mut seen = 0;
    for name in ["unipbd-core", "unipbd-cli", "unipbd-py", "unipbd-validation"] {
        let imports = imports_of(&repository().join("crates").join(name).join("src"));
        for (module, targets) in &imports {
            seen += targets.len();
            for other in targets.iter().filter(|other| *other > module) {
                let kin = other.starts_with(module) || module.starts_with(other);
                if !kin && imports.get(other).is_some_and(|back| back.contains(module)) {
                    circles.push(format!("{name}: {} and {}", module.join("/"), other.join("/")));
                }
            }
        }
    }
    assert!(seen > 400, "only {seen} imports were found");
    assert!(circles.is_empty(), "these files import each other:\n{}", circles.join("\n"));
}

#[test]
fn the_reader_of_imports_follows_lists_and_parents() {
    let modules: BTreeSet<Module> = ["", "a", "a/b", "a/c", "d"]
        .iter()
        .map(|path| path.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect())
        .collect();
    let from = vec!["a".to_owned(), "b".to_owned()];
    let code = "use super::c::{X, Y as Z};\nuse crate::{d::E, math::Real};\nlet x = super::super::d::f();";
    let found: BTreeSet<String> =
        named_paths(code).iter().filter_map(|path| target(path, &from, &modules)).map(|m| m.join("/")).collect();
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["", "a/c", "d"]);
}
