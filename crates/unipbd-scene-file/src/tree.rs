//! A TOML tree that owns its values and knows their positions.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};
use unipbd_core::scene::{KeyPath, KeySegment};

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// The value; of a table, its header.
    pub(super) span: Range<usize>,
    pub(super) value: Value,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date,
    Array(Vec<Node>),
    Table(BTreeMap<String, Entry>),
}

/// A value in a table.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// Where the key stands.
    pub(super) key: Range<usize>,
    pub(super) node: Node,
}

impl Node {
    pub(super) fn from_table(table: &Spanned<DeTable<'_>>) -> Node {
        Node { span: table.span(), value: Value::Table(entries(table.get_ref(), 0)) }
    }

    /// Takes over a parsed value whose text starts at `offset` of the long text.
    pub(super) fn from_value(value: &Spanned<DeValue<'_>>, offset: usize) -> Node {
        let converted = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => integer(number),
            DeValue::Float(number) => Value::Float(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(truth) => Value::Boolean(*truth),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(elements) => {
                Value::Array(elements.iter().map(|element| Node::from_value(element, offset)).collect())
            }
            DeValue::Table(table) => Value::Table(entries(table, offset)),
        };
        Node { span: shifted(value.span(), offset), value: converted }
    }

    /// The value as the `toml` crate has it, for deserializing.
    pub(super) fn to_toml(&self) -> toml::Value {
        match &self.value {
            Value::Text(text) => toml::Value::String(text.clone()),
            Value::Integer(number) => toml::Value::Integer(*number),
            Value::Float(number) => toml::Value::Float(*number),
            Value::Boolean(truth) => toml::Value::Boolean(*truth),
            Value::Date => toml::Value::String(String::new()),
            Value::Array(elements) => toml::Value::Array(elements.iter().map(Node::to_toml).collect()),
            Value::Table(table) => {
                toml::Value::Table(table.iter().map(|(key, entry)| (key.clone(), entry.node.to_toml())).collect())
            }
        }
    }

    /// The value at this segment.
    pub(super) fn child(&self, segment: &KeySegment) -> Option<&Node> {
        match (&self.value, segment) {
            (Value::Table(table), KeySegment::Key(key)) => table.get(key).map(|entry| &entry.node),
            (Value::Array(elements), KeySegment::Index(index)) => elements.get(*index),
            _ => None,
        }
    }

    /// The value at this path.
    pub(super) fn at(&self, path: &KeyPath) -> Option<&Node> {
        path.0.iter().try_fold(self, |node, segment| node.child(segment))
    }

    /// Where the value at the path stands, or else the innermost table around it that is written out.
    pub(super) fn nearest_span(&self, path: &KeyPath) -> Option<Range<usize>> {
        let steps = path.0.iter().scan(self, |node, segment| {
            *node = node.child(segment)?;
            Some(*node)
        });
        steps.last().map(|node| node.span.clone())
    }

    pub(super) fn as_text(&self) -> Option<&str> {
        if let Value::Text(text) = &self.value { Some(text) } else { None }
    }
}

fn shifted(span: Range<usize>, offset: usize) -> Range<usize> {
    span.start + offset..span.end + offset
}

fn entries(table: &DeTable<'_>, offset: usize) -> BTreeMap<String, Entry> {
    let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| Entry {
        key: shifted(key.span(), offset),
        node: Node::from_value(value, offset),
    };
    table.iter().map(|(key, value)| (key.get_ref().to_string(), entry((key, value)))).collect()
}

/// An integer beyond 64 bits becomes a float: good enough where a number is asked for.
fn integer(number: &DeInteger<'_>) -> Value {
    match i64::from_str_radix(number.as_str(), number.radix()) {
        Ok(value) => Value::Integer(value),
        Err(_) if number.radix() == 10 => Value::Float(number.as_str().parse().unwrap_or(f64::NAN)),
        Err(_) => Value::Float(f64::INFINITY),
    }
}
