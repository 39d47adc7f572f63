//! Diagnostics as messages of the log, and back.

use std::sync::LazyLock;

use prost::DecodeError;
use prost_reflect::{DescriptorPool, DynamicMessage, MessageDescriptor, Value as LogValue};
use prost_types::FileDescriptorSet;
use unipbd_core::observe::{
    Diagnostics, Entry, GaugeReading, GroupDiagnostics, MaterialDiagnostics, Quantity, Table, Value, WallForce,
};

use super::quantity_schema::{NAME_TAG, PACKAGE, STATE_HASH_TAG, file, messages};

static SCHEMAS: LazyLock<DescriptorPool> = LazyLock::new(|| {
    let set = FileDescriptorSet { file: vec![file(messages())] };
    DescriptorPool::from_file_descriptor_set(set).expect("the tables of quantities are sound")
});

fn schema<T: Table>() -> MessageDescriptor {
    SCHEMAS.get_message_by_name(&format!("{PACKAGE}.{}", T::TYPE)).expect("every table has a message")
}

/// The message of a frame. Counts beyond 32 bits stay at the largest value.
pub(super) fn diagnostics_message(diagnostics: &Diagnostics, state_hash: Option<u64>) -> DynamicMessage {
    let mut message = table_message(diagnostics);
    if let Some(hash) = state_hash {
        message.set_field_by_number(STATE_HASH_TAG, LogValue::String(format!("{hash:016x}")));
    }
    set_list(&mut message, &diagnostics.materials);
    set_list(&mut message, &diagnostics.groups);
    set_list(&mut message, &diagnostics.walls);
    set_list(&mut message, &diagnostics.gauges);
    message
}

fn set_list<T: Entry>(message: &mut DynamicMessage, entries: &[T]) {
    let entry = |entry: &T| {
        let mut message = table_message(entry);
        message.set_field_by_number(NAME_TAG, LogValue::String(entry.name().to_owned()));
        LogValue::Message(message)
    };
    message.set_field_by_number(T::TAG, LogValue::List(entries.iter().map(entry).collect()));
}

fn table_message<T: Table>(table: &T) -> DynamicMessage {
    let mut message = DynamicMessage::new(schema::<T>());
    for quantity in T::QUANTITIES {
        for (value, tag) in (quantity.read)(table).columns().into_iter().zip(quantity.tag..) {
            message.set_field_by_number(tag, log_value(value));
        }
    }
    message
}

/// A single column.
fn log_value(value: Value<'_>) -> LogValue {
    match value {
        Value::Count(count) => LogValue::U32(u32::try_from(count).unwrap_or(u32::MAX)),
        Value::Number(number) => LogValue::F64(number),
        Value::Word(word) => LogValue::String(word.to_owned()),
        Value::Vector(_) | Value::ByPhase(_) => unreachable!("columns are single values"),
    }
}

/// Diagnostics and state hash of the message of a frame.
pub(crate) fn read_diagnostics(data: &[u8]) -> Result<(Diagnostics, Option<u64>), DecodeError> {
    let message = DynamicMessage::decode(schema::<Diagnostics>(), data)?;
    let mut diagnostics = Diagnostics::default();
    read_table(&message, &mut diagnostics);
    diagnostics.materials = read_list::<MaterialDiagnostics>(&message);
    diagnostics.groups = read_list::<GroupDiagnostics>(&message);
    diagnostics.walls = read_list::<WallForce>(&message);
    diagnostics.gauges = read_list::<GaugeReading>(&message);
    let hash = u64::from_str_radix(&text(&message, STATE_HASH_TAG), 16).ok();
    Ok((diagnostics, hash))
}

fn read_list<T: Entry>(message: &DynamicMessage) -> Vec<T> {
    let entries = message.get_field_by_number(T::TAG);
    let entries = entries.as_deref().and_then(LogValue::as_list).unwrap_or_default();
    let entry = |message: &DynamicMessage| {
        let mut entry = T::named(&text(message, NAME_TAG));
        read_table(message, &mut entry);
        entry
    };
    entries.iter().filter_map(LogValue::as_message).map(entry).collect()
}

fn read_table<T: Table>(message: &DynamicMessage, table: &mut T) {
    for quantity in T::QUANTITIES {
        if let Some(write) = quantity.write {
            read_quantity(message, quantity, |value| write(table, value));
        }
    }
}

fn read_quantity<T: Table>(message: &DynamicMessage, quantity: &Quantity<T>, write: impl FnOnce(Value<'_>)) {
    let tag = quantity.tag;
    let column = |offset: usize| tag + offset as u32;
    match (quantity.read)(&T::default()) {
        Value::Count(_) => write(Value::Count(count(message, tag))),
        Value::Number(_) => write(Value::Number(number(message, tag))),
        Value::Word(_) => write(Value::Word(&text(message, tag))),
        Value::Vector(_) => write(Value::Vector([0, 1].map(|axis| number(message, column(axis))).into())),
        Value::ByPhase(_) => write(Value::ByPhase(std::array::from_fn(|phase| count(message, column(phase))))),
    }
}

fn count(message: &DynamicMessage, tag: u32) -> u64 {
    let value = message.get_field_by_number(tag);
    value.and_then(|value| value.as_u32()).map_or(0, u64::from)
}

fn number(message: &DynamicMessage, tag: u32) -> f64 {
    message.get_field_by_number(tag).and_then(|value| value.as_f64()).unwrap_or(0.0)
}

fn text(message: &DynamicMessage, tag: u32) -> String {
    message.get_field_by_number(tag).and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
}
