//! The messages of our own in a log, and the protobuf descriptors that let any reader decode them.
//!
//! A field is added in one place: its line in `messages!` makes both the Rust struct and the
//! descriptor. Numbers (`tag`) are never reused.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};

const PACKAGE: &str = "unipbd";

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
            let message_type = vec![$(
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
            )*];
            FileDescriptorProto {
                name: Some(format!("{PACKAGE}.proto")),
                package: Some(PACKAGE.to_owned()),
                message_type,
                syntax: Some("proto3".to_owned()),
                ..Default::default()
            }
        }
    };
}

messages! {
    /// The state of a run at one frame, in numbers. Counts beyond 32 bits stay at the largest value.
    message Diagnostics {
        /// Simulated time [s].
        #[prost(tag = "1", double)]
        time: f64,
        /// Frames done.
        #[prost(tag = "2", uint32)]
        frame: u32,
        /// Substeps done since the start.
        #[prost(tag = "3", uint32)]
        step: u32,
        /// Substeps of the last frame.
        #[prost(tag = "4", uint32)]
        substeps: u32,
        /// Constraint iterations of the last frame.
        #[prost(tag = "5", uint32)]
        iterations: u32,
        /// Neighbour lists built in the last frame.
        #[prost(tag = "6", uint32)]
        list_builds: u32,
        /// Number of liquid particles.
        #[prost(tag = "7", uint32)]
        count_liquid: u32,
        /// Number of gas particles.
        #[prost(tag = "8", uint32)]
        count_gas: u32,
        /// Number of smoke particles.
        #[prost(tag = "9", uint32)]
        count_smoke: u32,
        /// Number of samples of rigid bodies.
        #[prost(tag = "10", uint32)]
        count_rigid: u32,
        /// Number of free solid points.
        #[prost(tag = "11", uint32)]
        count_solid: u32,
        /// Mean of max(C, 0) over fluid particles, as a fraction.
        #[prost(tag = "12", double)]
        density_error_mean: f64,
        /// Largest C over fluid particles, as a fraction.
        #[prost(tag = "13", double)]
        density_error_max: f64,
        /// Smallest C over fluid particles, as a fraction.
        #[prost(tag = "14", double)]
        density_error_min: f64,
        /// Largest pressure over density [m^2/s^2].
        #[prost(tag = "15", double)]
        pressure_max: f64,
        /// Kinetic energy [J].
        #[prost(tag = "16", double)]
        kinetic_energy: f64,
        /// Potential energy [J].
        #[prost(tag = "17", double)]
        potential_energy: f64,
        /// Linear momentum along x [kg m/s].
        #[prost(tag = "18", double)]
        momentum_x: f64,
        /// Linear momentum along y [kg m/s].
        #[prost(tag = "19", double)]
        momentum_y: f64,
        /// Angular momentum about the origin [kg m^2/s].
        #[prost(tag = "20", double)]
        angular_momentum: f64,
        /// Largest particle speed [m/s].
        #[prost(tag = "21", double)]
        speed_max: f64,
        /// Hash of the whole state, 16 hexadecimal digits; empty where it was not computed.
        #[prost(tag = "22", string)]
        state_hash: String,
        /// Per material, in index order.
        #[prost(tag = "23", message, repeated)]
        materials: Vec<MaterialDiagnostics>,
        /// Per constraint group, in solving order.
        #[prost(tag = "24", message, repeated)]
        groups: Vec<GroupDiagnostics>,
        /// Substeps that the last frame asked for.
        #[prost(tag = "25", uint32)]
        substeps_wanted: u32,
        /// What decided the number of substeps.
        #[prost(tag = "26", string)]
        substeps_reason: String,
        /// Deepest overlap of bodies with each other and with walls [m].
        #[prost(tag = "27", double)]
        contact_penetration: f64,
        /// Per wall that has a name.
        #[prost(tag = "28", message, repeated)]
        walls: Vec<WallForce>,
    }

    /// Diagnostics of one material.
    message MaterialDiagnostics {
        /// Name of the material.
        #[prost(tag = "1", string)]
        name: String,
        /// Number of particles.
        #[prost(tag = "2", uint32)]
        count: u32,
        /// Mean of max(C, 0), as a fraction.
        #[prost(tag = "3", double)]
        density_error_mean: f64,
        /// Largest C, as a fraction.
        #[prost(tag = "4", double)]
        density_error_max: f64,
        /// Smallest C (dilation), as a fraction.
        #[prost(tag = "5", double)]
        density_error_min: f64,
    }

    /// Diagnostics of one constraint group.
    message GroupDiagnostics {
        /// Name of the group.
        #[prost(tag = "1", string)]
        name: String,
        /// Largest constraint violation, in the group's own unit.
        #[prost(tag = "2", double)]
        violation: f64,
    }

    /// The force of the fluids on a wall.
    message WallForce {
        /// Name of the wall.
        #[prost(tag = "1", string)]
        name: String,
        /// Mean force over the frame along x [N].
        #[prost(tag = "2", double)]
        force_x: f64,
        /// Mean force over the frame along y [N].
        #[prost(tag = "3", double)]
        force_y: f64,
    }

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
        /// Centre of mass [m].
        #[prost(tag = "3", double)]
        x: f64,
        /// Centre of mass [m].
        #[prost(tag = "4", double)]
        y: f64,
        /// Rotation, counter-clockwise [rad].
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
        /// Mean force of the fluid over the frame, along x [N].
        #[prost(tag = "9", double)]
        fluid_force_x: f64,
        /// Mean force of the fluid over the frame, along y [N].
        #[prost(tag = "10", double)]
        fluid_force_y: f64,
        /// Mean torque of the fluid about the centre of mass over the frame [N m].
        #[prost(tag = "11", double)]
        fluid_torque: f64,
        /// Mean force of contacts and joints over the frame, along x [N].
        #[prost(tag = "12", double)]
        contact_force_x: f64,
        /// Mean force of contacts and joints over the frame, along y [N].
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
        /// Mass [kg].
        #[prost(tag = "3", double)]
        mass: f64,
        /// Moment of inertia about the centre of mass [kg m^2].
        #[prost(tag = "4", double)]
        inertia: f64,
        /// Radius of a disc, 0 for a polygon [m].
        #[prost(tag = "5", double)]
        radius: f64,
        /// Corners of a polygon, counter-clockwise, x [m].
        #[prost(tag = "6", double, repeated)]
        outline_x: Vec<f64>,
        /// Corners of a polygon, counter-clockwise, y [m].
        #[prost(tag = "7", double, repeated)]
        outline_y: Vec<f64>,
        /// Lattice samples, x [m].
        #[prost(tag = "8", double, repeated)]
        sample_x: Vec<f64>,
        /// Lattice samples, y [m].
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
        type_name: (kind == Type::Message).then(|| format!(".{PACKAGE}.{message}")),
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
        let known: Vec<String> =
            file.message_type.iter().map(|message| format!(".{PACKAGE}.{}", message.name())).collect();
        let named: Vec<&str> = file
            .message_type
            .iter()
            .flat_map(|message| &message.field)
            .filter_map(|field| field.type_name.as_deref())
            .collect();
        assert!(named.len() >= 4);
        assert!(named.iter().all(|name| known.contains(&name.to_string())), "{named:?} of {known:?}");
    }
}
