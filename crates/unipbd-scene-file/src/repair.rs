//! Compares the tree with the schema, notes what does not fit and replaces it by something that does.

use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

use serde_json::Value as Schema;
use unipbd_core::scene::{KeyPath, KeySegment, Problem, nearest};

use super::renamed;
use super::schema::{self, ArrayKind, Kind, TableKind};
use super::source::{Fault, FaultKind, Sources};
use super::tree::{Entry, Node, Value};

/// Longest list of valid keys that a hint shows [characters].
const LONGEST_LIST: usize = 240;

/// The comparison of a tree with the schema.
pub(super) struct Repair<'a> {
    root: &'a Schema,
    sources: &'a Sources<'a>,
    pub(super) faults: Vec<Fault>,
    /// Places where the tree no longer says what the file says.
    replaced: HashSet<KeyPath>,
    /// Strings in parts of the file that were left out: names that other parts may refer to.
    lost_words: BTreeSet<String>,
    /// A part of the file that may hold anything was left out.
    lost_table: bool,
}

impl<'a> Repair<'a> {
    pub(super) fn new(root: &'a Schema, sources: &'a Sources<'a>) -> Self {
        let (faults, replaced) = (Vec::new(), HashSet::new());
        Repair { root, sources, faults, replaced, lost_words: BTreeSet::new(), lost_table: false }
    }

    pub(super) fn run(&mut self, tree: &mut Node) {
        self.check(tree, self.root, &KeyPath::default());
    }

    /// Whether a problem is but a consequence of what was noted here.
    pub(super) fn explains(&self, problem: &Problem, tree: &Node) -> bool {
        let path = &problem.path.0;
        let below = (0..=path.len()).any(|length| self.replaced.contains(&KeyPath(path[..length].to_vec())))
            || path.is_empty() && self.replaced.iter().any(|replaced| replaced.0.len() == 1);
        let names_lost =
            || tree.at(&problem.path).and_then(Node::as_text).is_some_and(|word| self.lost_words.contains(word));
        below || path.is_empty() && self.lost_table || names_lost()
    }

    fn fault(&mut self, path: &KeyPath, span: &Range<usize>, message: String, hint: Option<String>) {
        let mut fault = Fault::new(path.clone(), Some(span.clone()), message);
        fault.hint = hint;
        self.faults.push(fault);
    }

    /// Notes what does not fit; afterwards the node fits.
    fn check(&mut self, node: &mut Node, schema: &'a Schema, path: &KeyPath) {
        match schema::kind(self.root, schema) {
            Kind::Table(table) => self.check_table(node, schema, &table, path),
            Kind::Array(array) => self.check_array(node, schema, &array, path),
            Kind::Choice(options) => self.check_choice(node, schema, &options, path),
            Kind::Word(words) => self.check_word(node, schema, &words, path),
            Kind::Integer { least, most } => match node.value {
                Value::Integer(value) if value >= least && value <= most => {}
                Value::Integer(value) if value > most => self.too_large(node, schema, path, Some(most)),
                Value::Float(value) if value > most as f64 => self.too_large(node, schema, path, Some(most)),
                _ => self.misfit(node, schema, path),
            },
            Kind::Number => self.check_number(node, schema, path),
            Kind::Text if node.as_text().is_some() => {}
            Kind::Boolean if matches!(node.value, Value::Boolean(_)) => {}
            Kind::Anything => {}
            Kind::Text | Kind::Boolean => self.misfit(node, schema, path),
        }
    }

    fn check_number(&mut self, node: &mut Node, schema: &'a Schema, path: &KeyPath) {
        match node.value {
            Value::Integer(_) => {}
            Value::Float(value) if value.is_finite() || self.sources.excerpt(&node.span).contains(['n', 'N']) => {}
            Value::Float(_) => self.too_large(node, schema, path, None),
            _ => self.misfit(node, schema, path),
        }
    }

    fn too_large(&mut self, node: &mut Node, schema: &'a Schema, path: &KeyPath, most: Option<i64>) {
        let written = shortened(self.sources.excerpt(&node.span));
        let hint = most.map(|most| format!("at most {most}"));
        self.fault(path, &node.span, format!("the number {written} is too large"), hint);
        self.replace(node, schema, path);
    }

    /// Notes a value of the wrong kind and replaces it.
    fn misfit(&mut self, node: &mut Node, schema: &'a Schema, path: &KeyPath) {
        let expected = schema::describe(self.root, schema);
        let found = self.found(node);
        let hint = self.unquoted(node, schema).or_else(|| description(schema));
        self.fault(path, &node.span, format!("expected {expected}, found {found}"), hint);
        self.replace(node, schema, path);
    }

    fn replace(&mut self, node: &mut Node, schema: &'a Schema, path: &KeyPath) {
        self.lose(node);
        node.value = self.placeholder(schema, &node.span);
        self.replaced.insert(path.clone());
    }

    /// Remembers the names in a part that is left out.
    fn lose(&mut self, node: &Node) {
        match &node.value {
            Value::Text(word) => drop(self.lost_words.insert(word.clone())),
            Value::Array(elements) => elements.iter().for_each(|element| self.lose(element)),
            Value::Table(table) => table.values().for_each(|entry| self.lose(&entry.node)),
            _ => {}
        }
    }

    /// A value that fits and that the checks for meaning pass over: NaN compares with nothing.
    fn placeholder(&self, schema: &'a Schema, span: &Range<usize>) -> Value {
        let node = |schema| Node { span: span.clone(), value: self.placeholder(schema, span) };
        match schema::kind(self.root, schema) {
            Kind::Number => Value::Float(f64::NAN),
            Kind::Integer { least, most } => Value::Integer(1.clamp(least, most)),
            Kind::Boolean => Value::Boolean(false),
            Kind::Word(words) => Value::Text(words.first().map_or("", |word| *word).to_owned()),
            Kind::Text | Kind::Anything => Value::Text(String::new()),
            Kind::Choice(options) => self.placeholder(options[0], span),
            Kind::Array(array) => Value::Array((0..array.least).map(|index| node(array.element(index))).collect()),
            Kind::Table(table) => {
                let entry = |key: &str| Some(Entry { key: span.clone(), node: node(table.key(key)?) });
                Value::Table(table.required.iter().filter_map(|key| Some(((*key).to_owned(), entry(key)?))).collect())
            }
        }
    }

    fn check_word(&mut self, node: &mut Node, schema: &'a Schema, words: &[&str], path: &KeyPath) {
        let Some(word) = node.as_text() else { return self.misfit(node, schema, path) };
        if words.contains(&word) {
            return;
        }
        let renamed = renamed::find(&format!("{}={word}", without_numbers(path)));
        let near = || nearest(word, words.iter().copied()).map(|near| format!("did you mean \"{near}\"?"));
        let hint = renamed.map(renamed::Renamed::hint).or_else(near);
        let message = format!("expected {}, found \"{}\"", schema::quoted(words), shortened(word));
        self.fault(path, &node.span, message, hint);
        self.replace(node, schema, path);
    }

    fn check_array(&mut self, node: &mut Node, schema: &'a Schema, array: &ArrayKind<'a>, path: &KeyPath) {
        self.wrap_single_table(node, array, path);
        let Value::Array(elements) = &mut node.value else { return self.misfit(node, schema, path) };
        if elements.len() < array.least || elements.len() > array.most {
            return self.misfit(node, schema, path);
        }
        for (index, element) in elements.iter_mut().enumerate() {
            self.check(element, array.element(index), &path.then_index(index));
        }
    }

    /// `[block]` instead of `[[block]]`: noted, and read as meant.
    fn wrap_single_table(&mut self, node: &mut Node, array: &ArrayKind<'a>, path: &KeyPath) {
        if !matches!(node.value, Value::Table(_))
            || !matches!(schema::kind(self.root, array.element(0)), Kind::Table(_))
        {
            return;
        }
        let hint = format!("write [[{path}]] with double brackets, once for each");
        self.fault(path, &node.span, "expected an array of tables, found a single table".to_owned(), Some(hint));
        let table = node.clone();
        node.value = Value::Array(vec![table]);
    }

    /// `[[solver]]` instead of `[solver]`: noted, and read as meant.
    fn unwrap_single_table(&mut self, node: &mut Node, path: &KeyPath) {
        if let Value::Array(elements) = &mut node.value
            && elements.iter().all(|element| matches!(element.value, Value::Table(_)))
            && !elements.is_empty()
        {
            let inner = elements.remove(0);
            let hint = format!("write [{path}] with single brackets, once");
            self.fault(path, &node.span, "expected a table, found an array of tables".to_owned(), Some(hint));
            *node = inner;
        }
    }

    /// Takes the option that fits, or else the one of the same form, whose faults are noted.
    fn check_choice(&mut self, node: &mut Node, schema: &'a Schema, options: &[&'a Schema], path: &KeyPath) {
        let same_form = |option: &&&'a Schema| match (schema::kind(self.root, option), &node.value) {
            (Kind::Table(table), Value::Table(entries)) => has_tag_of(self.root, &table, entries),
            (Kind::Array(_), Value::Array(_)) | (Kind::Word(_) | Kind::Text, Value::Text(_)) => true,
            (Kind::Number, Value::Integer(_) | Value::Float(_)) | (Kind::Integer { .. }, Value::Integer(_)) => true,
            (Kind::Boolean, Value::Boolean(_)) | (Kind::Anything, _) => true,
            _ => false,
        };
        let fitting = options.iter().filter(same_form).copied().collect::<Vec<_>>();
        match fitting.as_slice() {
            [only] if !matches!(node.value, Value::Integer(_) | Value::Text(_)) => self.check(node, only, path),
            several => {
                let mut trial = Repair::new(self.root, self.sources);
                let fits = several.iter().any(|option| {
                    trial.faults.clear();
                    trial.check(&mut node.clone(), option, path);
                    trial.faults.is_empty()
                });
                if !fits {
                    self.misfit(node, schema, path);
                }
            }
        }
    }

    fn check_table(&mut self, node: &mut Node, schema: &'a Schema, table: &TableKind<'a>, path: &KeyPath) {
        self.unwrap_single_table(node, path);
        let span = node.span.clone();
        let Value::Table(entries) = &mut node.value else { return self.misfit(node, schema, path) };
        let present: Vec<String> = entries.keys().cloned().collect();
        for key in present.into_iter().filter(|key| table.key(key).is_none() && table.others.is_none()) {
            let entry = entries.remove(&key);
            if let (Some(near), Some(entry)) = (self.unknown_key(&key, entry.as_ref(), table, path), entry) {
                // Most likely a slip: read on as if it had been written right.
                entries.entry(near).or_insert(entry);
            }
        }
        for (key, entry) in entries.iter_mut() {
            if let Some(inner) = table.key(key).or(table.others) {
                self.check(&mut entry.node, inner, &path.then(key));
            }
        }
        for key in table.required.iter().filter(|key| !entries.contains_key(**key)).collect::<Vec<_>>() {
            let inner = table.key(key).unwrap_or(&Schema::Null);
            self.missing(path.then(key), &span, inner);
            let node = Node { span: span.clone(), value: self.placeholder(inner, &span) };
            entries.insert((*key).to_owned(), Entry { key: span.clone(), node });
        }
        self.drop_unusable(entries, table, path);
    }

    /// Leaves out replaced optional values that have no neutral form, so that their defaults hold.
    fn drop_unusable(
        &self,
        entries: &mut std::collections::BTreeMap<String, Entry>,
        table: &TableKind<'a>,
        path: &KeyPath,
    ) {
        entries.retain(|key, _| {
            let Some(inner) = table.key(key) else { return true };
            let neutral = match schema::kind(self.root, inner) {
                Kind::Number | Kind::Array(_) | Kind::Text => true,
                _ => table.required.contains(&key.as_str()),
            };
            neutral || !self.replaced.contains(&path.then(key))
        });
    }

    fn missing(&mut self, path: KeyPath, span: &Range<usize>, schema: &'a Schema) {
        self.replaced.insert(path.clone());
        let expected = schema::describe(self.root, schema);
        let hint = match description(schema) {
            Some(text) => format!("{expected}: {text}"),
            None => format!("write {expected}"),
        };
        self.faults
            .push(Fault::new(path, Some(span.clone()), "this key is missing").hint(hint).kind(FaultKind::Missing));
    }

    /// Notes an unknown key; returns the valid one that is most likely meant and yet free.
    fn unknown_key(
        &mut self,
        key: &str,
        entry: Option<&Entry>,
        table: &TableKind<'a>,
        path: &KeyPath,
    ) -> Option<String> {
        let entry = entry?;
        let (near, hint) = match renamed::find(&without_numbers(&path.then(key))) {
            Some(renamed) => (renamed.successor().map(str::to_owned), Some(renamed.hint())),
            None => {
                let near = nearest(key, table.keys.iter().map(|(name, _)| *name)).map(str::to_owned);
                let hint = near.as_ref().map(|near| format!("did you mean `{near}`?"));
                (near, hint.or_else(|| self.home_of(key, path)).or_else(|| valid_keys(table)))
            }
        };
        let place = if path.0.is_empty() { String::new() } else { format!(" in {path}") };
        let message = format!("unknown key `{}`{place}", shortened(key));
        self.faults.push(Fault { hint, ..Fault::new(path.then(key), Some(entry.key.clone()), message) });
        if near.is_none() {
            self.lose(&entry.node);
            self.lost_table |= path.0.is_empty();
        }
        near
    }

    /// Where a key belongs that stands in the wrong table.
    fn home_of(&self, key: &str, path: &KeyPath) -> Option<String> {
        let Kind::Table(root) = schema::kind(self.root, self.root) else { return None };
        if !path.0.is_empty() && root.key(key).is_some() {
            return Some(format!("`{key}` belongs at the top of the file, before the first [table]"));
        }
        let holds = |schema| matches!(schema::kind(self.root, schema), Kind::Table(table) if table.key(key).is_some());
        let (home, _) = root.keys.iter().find(|(_, schema)| holds(schema))?;
        Some(format!("`{key}` belongs in the table [{home}]"))
    }

    /// A value in plain words.
    fn found(&self, node: &Node) -> String {
        let written = || shortened(self.sources.excerpt(&node.span));
        match &node.value {
            Value::Text(text) => format!("the string \"{}\"", shortened(text)),
            Value::Integer(_) | Value::Float(_) => format!("the number {}", written()),
            Value::Boolean(truth) => truth.to_string(),
            Value::Date => format!("the date {}", written()),
            Value::Array(elements) if elements.iter().all(|one| matches!(one.value, Value::Table(_))) => {
                if elements.is_empty() { "an empty array".to_owned() } else { "an array of tables".to_owned() }
            }
            Value::Array(elements) => format!("an array of length {}", elements.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }

    /// A hint for numbers and truth values in quotes.
    fn unquoted(&self, node: &Node, schema: &'a Schema) -> Option<String> {
        let text = node.as_text()?.trim();
        let plain = match schema::kind(self.root, schema) {
            Kind::Number => text.parse::<f64>().is_ok(),
            Kind::Integer { .. } => text.parse::<i64>().is_ok(),
            Kind::Boolean => text == "true" || text == "false",
            _ => false,
        };
        plain.then(|| format!("write {} without quotes", shortened(text)))
    }
}

/// Whether a table carries the words by which an option of a choice is told apart, if there are any.
fn has_tag_of(root: &Schema, table: &TableKind<'_>, entries: &std::collections::BTreeMap<String, Entry>) -> bool {
    table.keys.iter().all(|(key, schema)| match schema::kind(root, schema) {
        Kind::Word(words) if words.len() == 1 => {
            entries.get(*key).and_then(|entry| entry.node.as_text()).is_none_or(|word| words.contains(&word))
        }
        _ => true,
    })
}

/// A path such as `liquid.density`, whatever the number of the table.
fn without_numbers(path: &KeyPath) -> String {
    let keys = path.0.iter().filter(|segment| matches!(segment, KeySegment::Key(_))).cloned();
    KeyPath(keys.collect()).to_string()
}

fn description(schema: &Schema) -> Option<String> {
    let text = schema.get("description")?.as_str()?;
    text.lines().next().map(|line| line.trim_end_matches('.').to_owned())
}

fn valid_keys(table: &TableKind<'_>) -> Option<String> {
    let keys: Vec<&str> = table.keys.iter().map(|(key, _)| *key).collect();
    let list = keys.join(", ");
    (list.len() <= LONGEST_LIST && !keys.is_empty()).then(|| format!("valid keys: {list}"))
}

/// The start of a text from the file, short and clean enough for a message.
fn shortened(text: &str) -> String {
    let clean = |letter: char| if letter.is_control() { ' ' } else { letter };
    let start: String = text.chars().take(40).map(clean).collect();
    if start.chars().count() < text.chars().count() { start + "..." } else { start }
}
