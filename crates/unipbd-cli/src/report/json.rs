//! The JSON lines of `run --json`.

use std::collections::BTreeMap;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use unipbd_core::observe::{Diagnostics, Entry, Table, Value};
use unipbd_core::phase::Phase;

/// The line of one frame.
#[derive(Debug, Serialize)]
pub struct FrameLine<'a> {
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(flatten)]
    numbers: Numbers<'a>,
}

impl<'a> From<&'a Diagnostics> for FrameLine<'a> {
    fn from(diagnostics: &'a Diagnostics) -> Self {
        FrameLine { kind: "frame", numbers: Numbers(diagnostics) }
    }
}

/// Diagnostics under their names in the API: the quantities of the frame, then objects with those of each
/// material, group, wall and gauge by name.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<'a>(pub &'a Diagnostics);

impl Serialize for Numbers<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        add_quantities(&mut map, self.0)?;
        add_list(&mut map, &self.0.materials)?;
        add_list(&mut map, &self.0.groups)?;
        add_list(&mut map, &self.0.walls)?;
        add_list(&mut map, &self.0.gauges)?;
        map.end()
    }
}

fn add_list<M: SerializeMap, T: Entry>(map: &mut M, entries: &[T]) -> Result<(), M::Error> {
    let by_name: BTreeMap<&str, Quantities<'_, T>> =
        entries.iter().map(|entry| (entry.name(), Quantities(entry))).collect();
    map.serialize_entry(T::LIST, &by_name)
}

fn add_quantities<M: SerializeMap, T: Table>(map: &mut M, table: &T) -> Result<(), M::Error> {
    T::QUANTITIES.iter().try_for_each(|quantity| map.serialize_entry(quantity.name, &Json((quantity.read)(table))))
}

struct Quantities<'a, T>(&'a T);

impl<T: Table> Serialize for Quantities<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(T::QUANTITIES.len()))?;
        add_quantities(&mut map, self.0)?;
        map.end()
    }
}

struct Json(Value<'static>);

impl Serialize for Json {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Value::Count(count) => count.serialize(serializer),
            Value::Number(number) => number.serialize(serializer),
            Value::Vector(vector) => vector.to_array().serialize(serializer),
            Value::Word(word) => word.serialize(serializer),
            Value::ByPhase(counts) => ByPhase(counts).serialize(serializer),
        }
    }
}

/// Particles by phase, each phase by its name.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByPhase(pub [u64; Phase::ALL.len()]);

impl Serialize for ByPhase {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Phase::ALL.into_iter().map(Phase::name).zip(self.0))
    }
}
