//! Values set from the command line: `--set solver.substeps=16`.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use serde_json::Value as Schema;
use toml::Spanned;
use toml::de::DeValue;
use unipbd_core::scene::{KeyPath, KeySegment, nearest};

use super::schema::{self, Kind};
use super::source::Fault;
use super::tree::{Entry, Node, Value};

/// A value that replaces one of the scene: `key=value`.
///
/// The key is a path such as `solver.substeps`, `emitter.0.speed`, `emitter[0].speed` or
/// `gas.air.drag` (a table of an array by its number or its `name`). The value is TOML; what is
/// not is taken as a string, so that `gradients=start` needs no quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    text: String,
    equals: usize,
}

/// The text of an override lacks its key or its `=`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvalidOverride;

impl fmt::Display for InvalidOverride {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("expected key=value, such as solver.substeps=16")
    }
}

impl std::error::Error for InvalidOverride {}

impl FromStr for Override {
    type Err = InvalidOverride;

    fn from_str(text: &str) -> Result<Self, InvalidOverride> {
        let equals = text.find('=').ok_or(InvalidOverride)?;
        if text[..equals].trim().is_empty() {
            return Err(InvalidOverride);
        }
        Ok(Override { text: text.to_owned(), equals })
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Override {
    /// The override of a key by a value given as TOML.
    pub fn new(key: &str, value: impl fmt::Display) -> Result<Self, InvalidOverride> {
        format!("{key}={value}").parse()
    }

    /// The override as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The path of the key as written.
    pub fn key(&self) -> &str {
        self.text[..self.equals].trim()
    }

    /// The value as written.
    pub fn value(&self) -> &str {
        self.text[self.equals + 1..].trim()
    }

    /// The words of the key and where they stand in the text.
    fn segments(&self) -> Vec<(&str, Range<usize>)> {
        let key = &self.text[..self.equals];
        let mut segments = Vec::new();
        let mut start = 0;
        for part in key.split(['.', '[']) {
            let word = part.trim().trim_end_matches(']').trim_matches(['"', '\'', ' ']);
            let offset = start + part.find(word).unwrap_or(0);
            segments.push((word, offset..offset + word.len()));
            start += part.len() + 1;
        }
        segments
    }

    fn node(&self, offset: usize) -> Node {
        let written = &self.text[self.equals + 1..];
        let start = offset + self.equals + 1 + (written.len() - written.trim_start().len());
        match DeValue::parse(self.value()) {
            Ok(value) => Node::from_value(&value, start),
            Err(_) => {
                let text = DeValue::String(self.value().into());
                Node::from_value(&Spanned::new(0..self.value().len(), text), start)
            }
        }
    }
}

/// Lays an override, which starts at `offset` of the long text, over the tree.
pub(super) fn apply(change: &Override, offset: usize, root: &Schema, tree: &mut Node) -> Result<(), Fault> {
    let mut place = Place { node: tree, schema: Some(root), path: KeyPath::default() };
    let segments = change.segments();
    let Some(((last, span), parents)) = segments.split_last() else { return Ok(()) };
    let shift = |span: &Range<usize>| span.start + offset..span.end + offset;
    for (word, span) in parents {
        place = place.enter(word, shift(span), root)?;
    }
    let value = change.node(offset);
    let new = |span: Range<usize>| Node { span, value: Value::Table(Default::default()) };
    let target = place.slot(last, shift(span), root, new)?;
    *target.node = value;
    Ok(())
}

/// A value of the tree on the way to the one that is set.
struct Place<'t, 's> {
    node: &'t mut Node,
    schema: Option<&'s Schema>,
    path: KeyPath,
}

impl<'t, 's> Place<'t, 's> {
    fn kind(&self, root: &'s Schema) -> Kind<'s> {
        self.schema.map_or(Kind::Anything, |schema| schema::kind(root, schema))
    }

    /// Steps into a table on the way; one that the file leaves out is added.
    fn enter(self, word: &str, span: Range<usize>, root: &'s Schema) -> Result<Self, Fault> {
        let is_list = match self.kind(root) {
            Kind::Table(table) => {
                table.key(word).is_some_and(|inner| matches!(schema::kind(root, inner), Kind::Array(_)))
            }
            _ => false,
        };
        let absent = self.node.child(&KeySegment::Key(word.to_owned())).is_none();
        if is_list && absent {
            let path = self.path.then(word);
            let fault = Fault::new(path, Some(span), format!("the scene has no [[{word}]]"));
            return Err(fault.hint("an override changes what the file has; add the table to the file"));
        }
        self.slot(word, span, root, |span| Node { span, value: Value::Table(Default::default()) })
    }

    /// The value under a key or at a number or name; a key that the file leaves out is added.
    fn slot(
        self,
        word: &str,
        span: Range<usize>,
        root: &'s Schema,
        new: impl FnOnce(Range<usize>) -> Node,
    ) -> Result<Self, Fault> {
        let kind = self.kind(root);
        let path = self.path;
        match &mut self.node.value {
            Value::Table(entries) => {
                let schema = if let Kind::Table(table) = kind { table.key(word).or(table.others) } else { None };
                let fresh = || Entry { key: span.clone(), node: new(span.clone()) };
                let entry = entries.entry(word.to_owned()).or_insert_with(fresh);
                // From here on the key comes from the override, whatever the file had.
                entry.key = span.clone();
                Ok(Place { node: &mut entry.node, schema, path: path.then(word) })
            }
            Value::Array(elements) => {
                let index = find(elements, word).ok_or_else(|| no_element(elements, &path, word, span))?;
                let schema = if let Kind::Array(array) = kind { Some(array.element(index)) } else { None };
                Ok(Place { node: &mut elements[index], schema, path: path.then_index(index) })
            }
            _ => {
                let message = format!("{path} is a value, not a table");
                Err(Fault::new(path.then(word), Some(span), message).hint("set it as a whole"))
            }
        }
    }
}

/// The name of a table in an array.
fn name_of(element: &Node) -> Option<&str> {
    element.child(&KeySegment::Key("name".to_owned())).and_then(Node::as_text)
}

fn find(elements: &[Node], word: &str) -> Option<usize> {
    let by_name = || elements.iter().position(|element| name_of(element) == Some(word));
    word.parse().ok().filter(|index| *index < elements.len()).or_else(by_name)
}

fn no_element(elements: &[Node], path: &KeyPath, word: &str, span: Range<usize>) -> Fault {
    let names: Vec<&str> = elements.iter().filter_map(name_of).filter(|name| !name.is_empty()).collect();
    let by_number = word.parse::<u64>().is_ok();
    let message = if by_number {
        format!("there is no number {word}: {path} has length {}, counted from 0", elements.len())
    } else {
        format!("{path} has no entry named \"{word}\"")
    };
    let hint = match nearest(word, names.iter().copied()) {
        Some(near) if !by_number => format!("did you mean `{near}`?"),
        _ if elements.len() == 1 => format!("the only one is {path}.0"),
        _ if names.is_empty() => format!("write a number from 0 to {}", elements.len().saturating_sub(1)),
        _ => format!("the names are {}", names.join(", ")),
    };
    Fault::new(path.then(word), Some(span), message).hint(hint)
}
