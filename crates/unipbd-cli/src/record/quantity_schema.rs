//! Descriptors of the messages that hold diagnostics, made from the tables of the core.

use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto};
use unipbd_core::observe::{
    Diagnostics, Entry, GaugeReading, GroupDiagnostics, MaterialDiagnostics, Table, Value, WallForce,
};

/// Package of all messages of our own.
pub(super) const PACKAGE: &str = "unipbd";
/// Field number of the state hash: 16 hexadecimal digits; empty where the hash was not computed.
pub(super) const STATE_HASH_TAG: u32 = 22;
/// Field number of the name of an entry.
pub(super) const NAME_TAG: u32 = 1;

/// The messages of `/diagnostics`: that of a frame, then those of its entries.
pub(super) fn messages() -> Vec<DescriptorProto> {
    let mut frame = message::<Diagnostics>(vec![field("state_hash", STATE_HASH_TAG, Type::String)]);
    frame.field.extend([list::<MaterialDiagnostics>(), list::<GroupDiagnostics>()]);
    frame.field.extend([list::<WallForce>(), list::<GaugeReading>()]);
    let first = [frame, entry::<MaterialDiagnostics>(), entry::<GroupDiagnostics>()];
    first.into_iter().chain([entry::<WallForce>(), entry::<GaugeReading>()]).collect()
}

/// A protobuf file of these messages.
pub(super) fn file(message_type: Vec<DescriptorProto>) -> FileDescriptorProto {
    FileDescriptorProto {
        name: Some(format!("{PACKAGE}.proto")),
        package: Some(PACKAGE.to_owned()),
        message_type,
        syntax: Some("proto3".to_owned()),
        ..Default::default()
    }
}

/// The full name of a message, as protobuf writes references.
pub(super) fn reference(message: &str) -> String {
    format!(".{PACKAGE}.{message}")
}

fn entry<T: Entry>() -> DescriptorProto {
    message::<T>(vec![field("name", NAME_TAG, Type::String)])
}

fn message<T: Table>(mut fields: Vec<FieldDescriptorProto>) -> DescriptorProto {
    for quantity in T::QUANTITIES {
        let kinds = (quantity.read)(&T::default()).columns();
        let columns = quantity.columns().into_iter().zip(kinds).zip(quantity.tag..);
        fields.extend(columns.map(|((name, value), tag)| field(&name, tag, kind(value))));
    }
    DescriptorProto { name: Some(T::TYPE.to_owned()), field: fields, ..Default::default() }
}

/// The type of a single column.
fn kind(value: Value<'_>) -> Type {
    match value {
        Value::Count(_) => Type::Uint32,
        Value::Number(_) => Type::Double,
        Value::Word(_) => Type::String,
        Value::Vector(_) | Value::ByPhase(_) => unreachable!("columns are single values"),
    }
}

pub(super) fn field(name: &str, tag: u32, kind: Type) -> FieldDescriptorProto {
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: i32::try_from(tag).ok(),
        label: Some(Label::Optional as i32),
        r#type: Some(kind as i32),
        ..Default::default()
    }
}

fn list<T: Entry>() -> FieldDescriptorProto {
    FieldDescriptorProto {
        label: Some(Label::Repeated as i32),
        type_name: Some(reference(T::TYPE)),
        ..field(T::LIST, T::TAG, Type::Message)
    }
}
