//! The messages of our own in a log, and the protobuf descriptors that let any reader decode them.
//!
//! A field is added in one place: its line in `messages!` makes both the Rust struct and the
//! descriptor. Numbers (`tag`) are never reused. The messages of `/diagnostics` follow from the tables of
//! [`unipbd_core::observe`].

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

use super::quantity_schema::{self, reference};

macro_rules! messages {
    ($(
        $(#[doc = $about:literal])*
        message $message:ident {
            $(
                $(#[doc = $doc:literal])*
                #[prost(tag = $tag:tt, $kind:ident $(, $label:ident)?)]
                $field:ident: $type:ty,
            )*
        }
    )*) => {
        $(
            $(#[doc = $about])*
            #[derive(Clone, PartialEq, Message)]
            pub struct $message {
                $( $(#[doc = $doc])* #[prost(tag = $tag, $kind $(, $label)?)] pub $field: $type, )*
            }
        )*

        /// Every message, as one self-contained protobuf file.
        fn file() -> FileDescriptorProto {
            let mut message_type = quantity_schema::messages();
            message_type.extend([$(
                DescriptorProto {
                    name: Some(stringify!($message).to_owned()),
                    field: vec![$(
                        field(
                            stringify!($field),
                            stringify!($kind),
                            [$(stringify!($label))?].contains(&"repeated"),
                            $tag,
                            stringify!($type),
                        ),
                    )*],
                    ..Default::default()
                },
            )*]);
            quantity_schema::file(message_type)
        }
    };
}

messages! {
    /// Columns of the particles of `/particles`, in its row order (ascending id). `id`, `material`
    /// and `phase` are empty where they are those of the message before.
    message ParticleColumns {
        /// Stable ids, ascending.
        #[prost(tag = "1", uint32, repeated)]
        id: Vec<u32>,
        /// Indices into the materials of the metadata.
        #[prost(tag = "2", uint32, repeated)]
        material: Vec<u32>,
        /// Phases: 0 liquid, 1 gas, 2 smoke, 3 rigid, 4 solid.
        #[prost(tag = "3", uint32, repeated)]
        phase: Vec<u32>,
        /// Velocities along x [m/s].
        #[prost(tag = "4", float, repeated)]
        velocity_x: Vec<f32>,
        /// Velocities along y [m/s].
        #[prost(tag = "5", float, repeated)]
        velocity_y: Vec<f32>,
        /// Density errors C, as fractions.
        #[prost(tag = "6", float, repeated)]
        density_error: Vec<f32>,
        /// Temperatures.
        #[prost(tag = "7", float, repeated)]
        temperature: Vec<f32>,
    }

    /// All rigid bodies at one frame.
    message Bodies {
        /// Poses, velocities and loads.
        #[prost(tag = "1", message, repeated)]
        bodies: Vec<BodyState>,
        /// What does not move: in the first message and in each after which it changed.
        #[prost(tag = "2", message, repeated)]
        shapes: Vec<BodyShape>,
    }

    /// A rigid body at one frame.
    message BodyState {
        /// Number of the body: frame `body/<id>`.
        #[prost(tag = "1", uint32)]
        id: u32,
        /// Name given in the scene.
        #[prost(tag = "2", string)]
        name: String,
        /// Centre of mass \[m].
        #[prost(tag = "3", double)]
        x: f64,
        /// Centre of mass \[m].
        #[prost(tag = "4", double)]
        y: f64,
        /// Rotation, counter-clockwise \[rad].
        #[prost(tag = "5", double)]
        angle: f64,
        /// Velocity along x [m/s].
        #[prost(tag = "6", double)]
        velocity_x: f64,
        /// Velocity along y [m/s].
        #[prost(tag = "7", double)]
        velocity_y: f64,
        /// Angular velocity [rad/s].
        #[prost(tag = "8", double)]
        angular_velocity: f64,
        /// Mean force of the fluid over the frame, along x \[N].
        #[prost(tag = "9", double)]
        fluid_force_x: f64,
        /// Mean force of the fluid over the frame, along y \[N].
        #[prost(tag = "10", double)]
        fluid_force_y: f64,
        /// Mean torque of the fluid about the centre of mass over the frame [N m].
        #[prost(tag = "11", double)]
        fluid_torque: f64,
        /// Mean force of contacts and joints over the frame, along x \[N].
        #[prost(tag = "12", double)]
        contact_force_x: f64,
        /// Mean force of contacts and joints over the frame, along y \[N].
        #[prost(tag = "13", double)]
        contact_force_y: f64,
        /// Mean torque of contacts and joints about the centre of mass over the frame [N m].
        #[prost(tag = "14", double)]
        contact_torque: f64,
        /// Whether the body is held still until something wakes it.
        #[prost(tag = "15", bool)]
        asleep: bool,
    }

    /// What does not move of a rigid body, in its own coordinates.
    message BodyShape {
        /// Number of the body.
        #[prost(tag = "1", uint32)]
        id: u32,
        /// `dynamic`, `kinematic` or `static`.
        #[prost(tag = "2", string)]
        kind: String,
        /// Mass \[kg].
        #[prost(tag = "3", double)]
        mass: f64,
        /// Moment of inertia about the centre of mass [kg m^2].
        #[prost(tag = "4", double)]
        inertia: f64,
        /// Radius of a disc, 0 for a polygon \[m].
        #[prost(tag = "5", double)]
        radius: f64,
        /// Corners of a polygon, counter-clockwise, x \[m].
        #[prost(tag = "6", double, repeated)]
        outline_x: Vec<f64>,
        /// Corners of a polygon, counter-clockwise, y \[m].
        #[prost(tag = "7", double, repeated)]
        outline_y: Vec<f64>,
        /// Lattice samples, x \[m].
        #[prost(tag = "8", double, repeated)]
        sample_x: Vec<f64>,
        /// Lattice samples, y \[m].
        #[prost(tag = "9", double, repeated)]
        sample_y: Vec<f64>,
        /// Area each sample stands for [m^2].
        #[prost(tag = "10", double)]
        sample_area: f64,
        /// Coulomb coefficient below which a contact sticks.
        #[prost(tag = "11", double)]
        static_friction: f64,
        /// Coulomb coefficient of a contact that slides.
        #[prost(tag = "12", double)]
        kinetic_friction: f64,
        /// Rolling resistance of a disc.
        #[prost(tag = "13", double)]
        rolling_friction: f64,
        /// Rebound speed over impact speed.
        #[prost(tag = "14", double)]
        restitution: f64,
        /// Collision layers the body is in, one bit each.
        #[prost(tag = "15", uint32)]
        layers: u32,
        /// Collision layers it collides with.
        #[prost(tag = "16", uint32)]
        collides_with: u32,
        /// Whether it reports what it touches and pushes nothing.
        #[prost(tag = "17", bool)]
        sensor: bool,
        /// Factor on gravity.
        #[prost(tag = "18", double)]
        gravity_factor: f64,
    }
}

/// Descriptor of one field, from the words of its declaration.
fn field(name: &str, kind: &str, repeated: bool, tag: &str, rust_type: &str) -> FieldDescriptorProto {
    let kind = match kind {
        "double" => Type::Double,
        "float" => Type::Float,
        "uint32" => Type::Uint32,
        "bool" => Type::Bool,
        "string" => Type::String,
        "message" => Type::Message,
        other => unreachable!("field {name} has the kind {other}, which has no descriptor"),
    };
    let message = rust_type.trim_start_matches("Vec<").trim_end_matches('>');
    FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: tag.parse().ok(),
        label: Some(if repeated { Label::Repeated } else { Label::Optional } as i32),
        r#type: Some(kind as i32),
        type_name: (kind == Type::Message).then(|| reference(message)),
        ..Default::default()
    }
}

/// The descriptor set that a log carries for each of these messages.
pub(crate) fn descriptor_set() -> Vec<u8> {
    FileDescriptorSet { file: vec![file()] }.encode_to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_a_number_of_its_own() {
        for message in file().message_type {
            let mut numbers: Vec<i32> = message.field.iter().map(|field| field.number.unwrap()).collect();
            numbers.sort_unstable();
            numbers.dedup();
            assert_eq!(numbers.len(), message.field.len(), "{:?}", message.name);
        }
    }

    #[test]
    fn every_message_type_a_field_names_is_in_the_file() {
        let file = file();
        let known: Vec<String> = file.message_type.iter().map(|message| reference(message.name())).collect();
        let named: Vec<&str> = file
            .message_type
            .iter()
            .flat_map(|message| &message.field)
            .filter_map(|field| field.type_name.as_deref())
            .collect();
        assert!(named.len() >= 5);
        assert!(named.iter().all(|name| known.contains(&name.to_string())), "{named:?} of {known:?}");
    }
}
