#![doc = include_str!("../README.md")]
//!
//! # How it works
//!
//! The text is parsed into a tree that keeps positions, overrides are laid over it, the tree is
//! compared with the JSON schema of [`Scene`], and what remains is checked for meaning by
//! [`Scene::check`]. A fault found early is replaced by a value that raises no further
//! complaints, so that only causes are reported.

mod diagnostic;
mod overrides;
mod place;
mod renamed;
mod repair;
#[cfg(not(target_family = "wasm"))]
mod samples;
mod schema;
mod source;
mod syntax;
mod tree;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use sha2::{Digest, Sha256};
use toml::de::DeTable;
use unipbd_core::scene::{CheckedScene, KeyPath, Problem, Scene};

pub use diagnostic::{Diagnostic, Origin, SceneFileError};
pub use overrides::{InvalidOverride, Override};
pub use renamed::renamed_key_hint;
pub use schema::schema;

use repair::Repair;
use source::{Fault, Sources};
use tree::Node;

/// Larger files are refused unread [byte].
const LARGEST_FILE: u64 = 4 << 20;

/// A scene and the text it came from.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene, with the overrides.
    pub scene: CheckedScene,
    /// Whether parts of it came from other files: the text alone does not tell it.
    pub has_files: bool,
    /// The file as read, without the overrides.
    pub text: String,
    /// Where the file is.
    pub path: PathBuf,
    /// SHA-256 of the text, in hexadecimal digits.
    pub sha256: String,
    /// The overrides, as given.
    pub overrides: Vec<Override>,
}

/// Reads a scene file and lays the overrides over it.
pub fn load(path: impl AsRef<Path>, overrides: &[Override]) -> Result<LoadedScene, SceneFileError> {
    let path = path.as_ref();
    let name = diagnostic::printable(&path.display().to_string());
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST_FILE + 1).read_to_end(&mut bytes));
    read.map_err(|error| SceneFileError::Io { path: path.to_owned(), error })?;
    if bytes.len() as u64 > LARGEST_FILE {
        let message = format!("the file is larger than {} MiB", LARGEST_FILE >> 20);
        return Err(SceneFileError::whole_file(&name, message, "a scene file is a few kilobytes of TOML text"));
    }
    let text = String::from_utf8(bytes).map_err(|error| source::not_text(&name, &error))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let loaded = parse_in(folder, &text, &name, overrides)?;
    Ok(LoadedScene { path: path.to_owned(), ..loaded })
}

/// Reads a scene from text; `file_name` stands in messages. Files that the scene names are read from the current
/// folder.
pub fn parse(text: &str, file_name: &str, overrides: &[Override]) -> Result<LoadedScene, SceneFileError> {
    parse_in(Path::new(""), text, file_name, overrides)
}

/// The same, with files from this folder. WebAssembly has no files: there a scene that names one is refused.
pub fn parse_in(
    folder: &Path,
    text: &str,
    file_name: &str,
    overrides: &[Override],
) -> Result<LoadedScene, SceneFileError> {
    let sources = Sources::new(file_name, text, overrides.iter().map(Override::text));
    let (scene, has_files) = read(&sources, overrides, folder).map_err(|faults| sources.error(faults))?;
    Ok(LoadedScene {
        scene,
        has_files,
        text: text.to_owned(),
        path: PathBuf::from(file_name),
        sha256: Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect(),
        overrides: overrides.to_vec(),
    })
}

/// The scene, and whether parts of it came from other files.
fn read(sources: &Sources, overrides: &[Override], folder: &Path) -> Result<(CheckedScene, bool), Vec<Fault>> {
    let schema = schema();
    let (table, errors) = DeTable::parse_recoverable(sources.text());
    let (mut faults, doubtful) = syntax::faults(sources.text(), table.get_ref(), &errors);
    let mut tree = Node::from_table(&table);
    for (index, change) in overrides.iter().enumerate() {
        faults.extend(overrides::apply(change, sources.start_of_override(index), &schema, &mut tree).err());
    }
    let mut repair = Repair::new(&schema, sources);
    repair.run(&mut tree);
    if !errors.is_empty() {
        // Text near a syntax error may be read wrongly, and keys may be lost with it.
        faults.extend(repair.faults.into_iter().filter(|fault| !fault.may_follow_from_syntax(&doubtful)));
        return Err(faults);
    }
    faults.append(&mut repair.faults);
    match Scene::deserialize(tree.to_toml()) {
        Ok(mut scene) => {
            let has_files = names_files(&scene);
            faults.extend(load_samples(&mut scene, folder, &tree));
            let checked = scene.check();
            if let Err(problems) = &checked {
                let causes = problems.0.iter().filter(|problem| !repair.explains(problem, &tree));
                faults.extend(causes.map(|problem| locate(problem.clone(), &tree)));
            }
            checked.ok().filter(|_| faults.is_empty()).map(|scene| (scene, has_files)).ok_or(faults)
        }
        Err(error) if faults.is_empty() => Err(vec![Fault::new(KeyPath::default(), None, error.message())]),
        Err(_) => Err(faults),
    }
}

/// Whether a scene names files with samples, which [`parse`] reads into its tables.
pub fn names_files(scene: &Scene) -> bool {
    let motions = || scene.body.iter().filter_map(|body| body.motion.as_ref());
    !scene.shaking.file.is_empty() || motions().any(|motion| !motion.file.is_empty())
}

#[cfg(not(target_family = "wasm"))]
fn load_samples(scene: &mut Scene, folder: &Path, tree: &Node) -> Vec<Fault> {
    samples::load(scene, folder, tree)
}

/// The keys stay, and the checks refuse them.
#[cfg(target_family = "wasm")]
fn load_samples(_: &mut Scene, _: &Path, _: &Node) -> Vec<Fault> {
    Vec::new()
}

/// Finds the place of a problem in the file: its key, or the nearest table around it.
fn locate(problem: Problem, tree: &Node) -> Fault {
    let span = (!problem.path.0.is_empty()).then(|| tree.nearest_span(&problem.path)).flatten();
    Fault { path: problem.path, span, message: problem.message, hint: problem.hint, kind: source::FaultKind::Meaning }
}
