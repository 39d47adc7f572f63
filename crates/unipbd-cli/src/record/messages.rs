//! The Foxglove messages of a log: the only file that names the crate they come from, beside the server of live runs.

pub(crate) use foxglove::messages::line_primitive::Type as LineType;
pub(crate) use foxglove::messages::log::Level;
use foxglove::messages::packed_element_field::NumericType;
pub(crate) use foxglove::messages::{
    Color, FrameTransform, FrameTransforms, LinePrimitive, Log, Point3, PointCloud, Quaternion, SceneEntity,
    SceneEntityDeletion, SceneUpdate, Timestamp, TriangleListPrimitive,
};
use foxglove::messages::{PackedElementField, Pose, Vector3};
use prost::bytes::Bytes;
use unipbd_core::math::Vector64;
use unipbd_core::rigid::Body;

/// The frame of reference of everything that is not fixed to a body.
pub(crate) const WORLD: &str = "world";

/// Bytes of one point: x, y, z as f32, then red, green, blue, alpha.
pub(crate) const POINT_STRIDE: usize = 16;

const NANOSECONDS_PER_SECOND: u64 = 1_000_000_000;

/// Name and descriptor set of a Foxglove message.
pub(crate) fn schema<M: foxglove::Encode>() -> (String, Vec<u8>) {
    M::get_schema().map(|schema| (schema.name, schema.data.into_owned())).unwrap_or_default()
}

/// A simulated time \[ns] as a message holds it.
pub(crate) fn timestamp(nanoseconds: u64) -> Timestamp {
    let seconds = u32::try_from(nanoseconds / NANOSECONDS_PER_SECOND).unwrap_or(u32::MAX);
    Timestamp::new(seconds, (nanoseconds % NANOSECONDS_PER_SECOND) as u32)
}

/// The frame of reference of a body.
pub(crate) fn body_frame(id: u32) -> String {
    format!("body/{id}")
}

/// A point in the plane of the simulation.
pub(crate) fn point(position: Vector64) -> Point3 {
    Point3 { x: position.x, y: position.y, z: 0.0 }
}

/// A colour from bytes.
pub(crate) fn color([red, green, blue, alpha]: [u8; 4]) -> Color {
    let [r, g, b, a] = [red, green, blue, alpha].map(|byte| f64::from(byte) / 255.0);
    Color { r, g, b, a }
}

/// The pose that changes nothing.
pub(crate) fn identity() -> Pose {
    Pose { position: Some(Vector3 { x: 0.0, y: 0.0, z: 0.0 }), orientation: Some(rotation(0.0)) }
}

/// Turn about z, counter-clockwise \[rad].
fn rotation(angle: f64) -> Quaternion {
    let (sine, cosine) = (0.5 * angle).sin_cos();
    Quaternion { x: 0.0, y: 0.0, z: sine, w: cosine }
}

/// A point cloud without points.
pub(crate) fn empty_cloud(frame: String) -> PointCloud {
    let field = |name: &str, offset, kind: NumericType| PackedElementField {
        name: name.to_owned(),
        offset,
        r#type: kind as i32,
    };
    let fields = vec![
        field("x", 0, NumericType::Float32),
        field("y", 4, NumericType::Float32),
        field("z", 8, NumericType::Float32),
        field("red", 12, NumericType::Uint8),
        field("green", 13, NumericType::Uint8),
        field("blue", 14, NumericType::Uint8),
        field("alpha", 15, NumericType::Uint8),
    ];
    PointCloud {
        timestamp: None,
        frame_id: frame,
        pose: Some(identity()),
        point_stride: POINT_STRIDE as u32,
        fields,
        data: Bytes::new(),
    }
}

/// One point as it lies in the data of a cloud.
#[inline]
pub(crate) fn pack_point([x, y]: [f32; 2], color: [u8; 4]) -> [u8; POINT_STRIDE] {
    let mut bytes = [0; POINT_STRIDE];
    bytes[0..4].copy_from_slice(&x.to_le_bytes());
    bytes[4..8].copy_from_slice(&y.to_le_bytes());
    bytes[12..16].copy_from_slice(&color);
    bytes
}

/// The position of one point in the data of a cloud.
#[inline]
pub(crate) fn unpack_position(bytes: &[u8; POINT_STRIDE]) -> [f32; 2] {
    let [x0, x1, x2, x3, y0, y1, y2, y3, ..] = *bytes;
    [f32::from_le_bytes([x0, x1, x2, x3]), f32::from_le_bytes([y0, y1, y2, y3])]
}

/// A cloud of points of one colour.
pub(crate) fn cloud(frame: String, time: u64, points: &[Vector64], color: [u8; 4]) -> PointCloud {
    let mut data = Vec::with_capacity(points.len() * POINT_STRIDE);
    for point in points {
        data.extend_from_slice(&pack_point([point.x as f32, point.y as f32], color));
    }
    PointCloud { timestamp: Some(timestamp(time)), data: data.into(), ..empty_cloud(frame) }
}

/// Where every body is, in one message.
pub(crate) fn transforms(time: u64, bodies: &[Body]) -> FrameTransforms {
    let transform = |(id, body): (usize, &Body)| FrameTransform {
        timestamp: Some(timestamp(time)),
        parent_frame_id: WORLD.to_owned(),
        child_frame_id: body_frame(id as u32),
        translation: Some(Vector3 { x: body.position.x, y: body.position.y, z: 0.0 }),
        rotation: Some(rotation(body.angle)),
    };
    FrameTransforms { transforms: bodies.iter().enumerate().map(transform).collect() }
}
