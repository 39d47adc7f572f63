//! The readings of the gauges once more, as plain numbers under their names: what viewers plot by a path such as
//! `/gauges.level_left`. A reader of ours finds them in the diagnostics.

use prost::Message;
use prost::bytes::{Buf, BufMut};
use prost::encoding::{self, DecodeContext, WireType};
use prost_types::field_descriptor_proto::Type;
use prost_types::{DescriptorProto, FileDescriptorSet};
use unipbd_core::observe::Diagnostics;

use super::quantity_schema;

/// The descriptor set of a message with a field of type double for each of these names.
pub(super) fn descriptor_set(names: &[String]) -> Vec<u8> {
    let fields = names.iter().zip(1..).map(|(name, tag)| quantity_schema::field(name, tag, Type::Double));
    let message = DescriptorProto { name: Some("Gauges".to_owned()), field: fields.collect(), ..Default::default() };
    FileDescriptorSet { file: vec![quantity_schema::file(vec![message])] }.encode_to_vec()
}

/// Readings in the order of the names.
#[derive(Debug, Default)]
pub(super) struct GaugeValues(Vec<f64>);

impl GaugeValues {
    pub fn of(diagnostics: &Diagnostics) -> Self {
        GaugeValues(diagnostics.gauges.iter().map(|gauge| gauge.value).collect())
    }
}

impl Message for GaugeValues {
    fn encode_raw(&self, buffer: &mut impl BufMut) {
        // Zeros too: a viewer takes what is left out for unknown.
        self.0.iter().zip(1..).for_each(|(value, tag)| encoding::double::encode(tag, value, buffer));
    }

    fn merge_field(
        &mut self,
        _tag: u32,
        wire_type: WireType,
        buffer: &mut impl Buf,
        context: DecodeContext,
    ) -> Result<(), prost::DecodeError> {
        let mut value = 0.0;
        encoding::double::merge(wire_type, &mut value, buffer, context)?;
        self.0.push(value);
        Ok(())
    }

    fn encoded_len(&self) -> usize {
        self.0.iter().zip(1..).map(|(value, tag)| encoding::double::encoded_len(tag, value)).sum()
    }

    fn clear(&mut self) {
        self.0.clear();
    }
}
