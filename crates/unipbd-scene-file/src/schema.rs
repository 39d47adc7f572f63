//! The JSON schema of the scene format.

use serde_json::{Map, Value, json};
use unipbd_core::scene::Scene;

/// The JSON schema (draft 2020-12) of the scene format, for editors.
pub fn schema() -> Value {
    let mut schema = Value::from(schemars::schema_for!(Scene));
    tidy(&mut schema);
    if let Value::Object(root) = &mut schema {
        root.insert("title".to_owned(), json!("unipbd scene"));
    }
    schema
}

/// Takes out what TOML has not (null), writes the bounds of integers out and units as they read.
fn tidy(value: &mut Value) {
    match value {
        Value::Array(elements) => elements.iter_mut().for_each(tidy),
        Value::Object(object) => {
            bound_integers(object);
            drop_null(object);
            unescape(object);
            object.values_mut().for_each(tidy);
        }
        _ => {}
    }
}

/// Rustdoc takes `[m]` for a link, so that the sources write `\[m]`.
fn unescape(object: &mut Map<String, Value>) {
    if let Some(Value::String(text)) = object.get_mut("description") {
        *text = text.replace("\\[", "[");
    }
}

fn bound_integers(object: &mut Map<String, Value>) {
    let Some(format) = object.get("format").and_then(Value::as_str) else { return };
    let bounds = match format {
        "uint8" => (0, i64::from(u8::MAX)),
        "uint16" => (0, i64::from(u16::MAX)),
        "uint32" => (0, i64::from(u32::MAX)),
        "uint" | "uint64" => (0, i64::MAX),
        "int32" => (i64::from(i32::MIN), i64::from(i32::MAX)),
        "int" | "int64" => (i64::MIN, i64::MAX),
        "float" | "double" => {
            object.remove("format");
            return;
        }
        _ => return,
    };
    object.remove("format");
    object.entry("minimum").or_insert(json!(bounds.0));
    object.entry("maximum").or_insert(json!(bounds.1));
}

fn drop_null(object: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            object.insert("type".to_owned(), only);
        }
    }
    for key in ["anyOf", "oneOf"] {
        if let Some(Value::Array(options)) = object.get_mut(key) {
            options.retain(|option| option.get("type") != Some(&json!("null")));
            if let [Value::Object(only)] = options.as_slice() {
                let only = only.clone();
                object.remove(key);
                only.into_iter().for_each(|(name, value)| {
                    object.entry(name).or_insert(value);
                });
            }
        }
    }
}

/// The kind of value that a schema requires.
pub(super) enum Kind<'s> {
    Table(TableKind<'s>),
    Array(ArrayKind<'s>),
    Number,
    Integer {
        least: i64,
        most: i64,
    },
    Text,
    /// One of these words.
    Word(Vec<&'s str>),
    Boolean,
    /// One of several kinds.
    Choice(Vec<&'s Value>),
    Anything,
}

pub(super) struct TableKind<'s> {
    pub(super) keys: Vec<(&'s str, &'s Value)>,
    pub(super) required: Vec<&'s str>,
    /// Schema of the values of keys beyond `keys`, where they are allowed.
    pub(super) others: Option<&'s Value>,
}

pub(super) struct ArrayKind<'s> {
    first: &'s [Value],
    rest: Option<&'s Value>,
    pub(super) least: usize,
    pub(super) most: usize,
}

impl<'s> ArrayKind<'s> {
    pub(super) fn element(&self, index: usize) -> &'s Value {
        self.first.get(index).or(self.rest).unwrap_or(&Value::Bool(true))
    }
}

impl<'s> TableKind<'s> {
    pub(super) fn key(&self, key: &str) -> Option<&'s Value> {
        self.keys.iter().find(|(name, _)| *name == key).map(|(_, schema)| *schema)
    }
}

/// Follows a reference to its definition.
pub(super) fn resolve<'s>(root: &'s Value, schema: &'s Value) -> &'s Value {
    let mut schema = schema;
    // A reference to itself cannot come out of schemars, but must not hang either.
    for _ in 0..16 {
        let target = schema.get("$ref").and_then(Value::as_str).and_then(|path| root.pointer(path.strip_prefix('#')?));
        match target {
            Some(found) => schema = found,
            None => break,
        }
    }
    schema
}

fn list<'s>(schema: &'s Value, key: &str) -> &'s [Value] {
    schema.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Reads what a schema asks for.
pub(super) fn kind<'s>(root: &'s Value, schema: &'s Value) -> Kind<'s> {
    let schema = resolve(root, schema);
    if let Some(word) = schema.get("const").and_then(Value::as_str) {
        return Kind::Word(vec![word]);
    }
    let words: Vec<&str> = list(schema, "enum").iter().filter_map(Value::as_str).collect();
    if !words.is_empty() {
        return Kind::Word(words);
    }
    let options = if list(schema, "oneOf").is_empty() { list(schema, "anyOf") } else { list(schema, "oneOf") };
    if !options.is_empty() {
        return choice(root, options);
    }
    let integer = |key, fallback| schema.get(key).and_then(Value::as_i64).unwrap_or(fallback);
    match schema.get("type").and_then(Value::as_str) {
        Some("object") => Kind::Table(table(schema)),
        Some("array") => Kind::Array(array(schema)),
        Some("number") => Kind::Number,
        Some("integer") => Kind::Integer { least: integer("minimum", i64::MIN), most: integer("maximum", i64::MAX) },
        Some("string") => Kind::Text,
        Some("boolean") => Kind::Boolean,
        _ => Kind::Anything,
    }
}

/// Words of several enumerations are one list; everything else stays a choice.
fn choice<'s>(root: &'s Value, options: &'s [Value]) -> Kind<'s> {
    let words = options.iter().map(|option| match kind(root, option) {
        Kind::Word(words) => Some(words),
        _ => None,
    });
    match words.collect::<Option<Vec<_>>>() {
        Some(words) => Kind::Word(words.concat()),
        None => Kind::Choice(options.iter().collect()),
    }
}

fn table(schema: &Value) -> TableKind<'_> {
    let properties = schema.get("properties").and_then(Value::as_object);
    TableKind {
        keys: properties.into_iter().flatten().map(|(key, value)| (key.as_str(), value)).collect(),
        required: list(schema, "required").iter().filter_map(Value::as_str).collect(),
        others: schema.get("additionalProperties").filter(|others| **others != json!(false)),
    }
}

fn array(schema: &Value) -> ArrayKind<'_> {
    let count = |key| schema.get(key).and_then(Value::as_u64).and_then(|count| usize::try_from(count).ok());
    ArrayKind {
        first: list(schema, "prefixItems"),
        rest: schema.get("items"),
        least: count("minItems").unwrap_or(0),
        most: count("maxItems").unwrap_or(usize::MAX),
    }
}

/// Name of a kind in messages.
pub(super) fn describe(root: &Value, schema: &Value) -> String {
    match kind(root, schema) {
        Kind::Table(_) => "a table".to_owned(),
        Kind::Array(array) => describe_array(root, &array),
        Kind::Number => "a number".to_owned(),
        Kind::Integer { least: 0, .. } => "a whole number, 0 or more".to_owned(),
        Kind::Integer { .. } => "a whole number".to_owned(),
        Kind::Text => "a string".to_owned(),
        Kind::Word(words) => quoted(&words),
        Kind::Boolean => "true or false".to_owned(),
        Kind::Choice(options) => {
            let options: Vec<String> = options.into_iter().map(|option| describe(root, option)).collect();
            options.join(" or ")
        }
        Kind::Anything => "a value".to_owned(),
    }
}

fn describe_array(root: &Value, array: &ArrayKind<'_>) -> String {
    let elements = match kind(root, array.element(0)) {
        Kind::Number => "numbers",
        Kind::Integer { .. } => "whole numbers",
        Kind::Text => "strings",
        Kind::Word(_) => "words",
        Kind::Array(inner) => {
            return format!("an array, each element {}", describe_array(root, &inner));
        }
        Kind::Table(_) => "tables",
        _ => "values",
    };
    if array.least == array.most {
        format!("an array of {} {elements}", array.least)
    } else {
        format!("an array of {elements}")
    }
}

/// `"a", "b" or "c"`.
pub(super) fn quoted(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match words.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}
