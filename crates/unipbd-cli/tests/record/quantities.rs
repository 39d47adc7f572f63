//! Every quantity of the diagnostics is in the log.

use std::fs;

use prost_reflect::{DescriptorPool, DynamicMessage, Value as LogValue};
use unipbd_cli::record::{Fields, Recorder};
use unipbd_core::observe::{
    Diagnostics, Entry, GaugeReading, GroupDiagnostics, MaterialDiagnostics, Table, Value, WallForce,
};

use crate::support::{diagnostics, header, snapshot};

fn expected() -> Diagnostics {
    diagnostics(&snapshot(100, 3), 3)
}

/// Whether a column of a log holds a value.
fn holds(value: &LogValue, expected: Value<'_>) -> bool {
    match expected {
        Value::Count(count) => value.as_u32().map(u64::from) == Some(count),
        Value::Number(number) => value.as_f64() == Some(number),
        Value::Word(word) => value.as_str() == Some(word),
        Value::Vector(_) | Value::ByPhase(_) => false,
    }
}

fn check_message<T: Table>(message: &DynamicMessage, table: &T) {
    for quantity in T::QUANTITIES {
        for (name, expected) in quantity.columns().iter().zip((quantity.read)(table).columns()) {
            let value = message.get_field_by_name(name).unwrap_or_else(|| panic!("the log has no {name}"));
            assert!(holds(&value, expected), "{name}: {value:?} is not {expected:?}");
        }
    }
}

fn check_messages<T: Entry>(message: &DynamicMessage, entries: &[T]) {
    let list = message.get_field_by_name(T::LIST).unwrap_or_else(|| panic!("the log has no {}", T::LIST));
    let list = list.as_list().unwrap();
    assert!(!list.is_empty() && list.len() == entries.len());
    for (message, entry) in list.iter().map(|value| value.as_message().unwrap()).zip(entries) {
        assert_eq!(message.get_field_by_name("name").unwrap().as_str(), Some(entry.name()));
        check_message(message, entry);
    }
}

/// A log of one frame.
fn recorded() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &header(), Fields::default()).unwrap();
    recorder.record(&snapshot(100, 3), Some(&expected()), None, &[]).unwrap();
    recorder.finish().unwrap();
    fs::read(&path).unwrap()
}

/// A message by the schema that the log carries: it is all that another reader knows.
fn decoded(message: &mcap::Message<'_>) -> DynamicMessage {
    let schema = message.channel.schema.as_ref().unwrap();
    let pool = DescriptorPool::decode(&schema.data[..]).unwrap();
    DynamicMessage::decode(pool.get_message_by_name(&schema.name).unwrap(), &message.data[..]).unwrap()
}

#[test]
fn every_quantity_is_a_column_of_the_log_under_its_name() {
    let bytes = recorded();
    let mut messages = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    let message = decoded(&messages.find(|message| message.channel.topic == "/diagnostics").unwrap());
    check_message(&message, &expected());
    check_messages::<MaterialDiagnostics>(&message, &expected().materials);
    check_messages::<GroupDiagnostics>(&message, &expected().groups);
    check_messages::<WallForce>(&message, &expected().walls);
    check_messages::<GaugeReading>(&message, &expected().gauges);
}

#[test]
fn gauges_are_a_topic_of_plain_numbers_under_their_names() {
    let bytes = recorded();
    let mut messages = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    let message = decoded(&messages.find(|message| message.channel.topic == "/gauges").unwrap());
    for gauge in expected().gauges {
        assert_eq!(message.get_field_by_name(&gauge.name).unwrap().as_f64(), Some(gauge.value), "{}", gauge.name);
    }
}
