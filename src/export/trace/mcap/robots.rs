//! Robots in a recording: points that say more than where they are, and frames that say which way they face.

use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{FrameTransform, FrameTransforms, PackedElementField, PointCloud};

use super::super::context::Run;
use super::super::palette::role_colour;
use super::super::standing::Standing;
use super::message::{ARENA, pose, timestamp, turned, vector};
use crate::engine::ActorId;
use crate::geometry::{Pose, Vec2};
use crate::motion::World;

/// What is known of each robot, and how it is written: one behind the other, lowest byte first.
const FIELDS: [(&str, NumericType, u32); 10] = [
    ("x", NumericType::Float32, 4),
    ("y", NumericType::Float32, 4),
    ("z", NumericType::Float32, 4),
    ("red", NumericType::Uint8, 1),
    ("green", NumericType::Uint8, 1),
    ("blue", NumericType::Uint8, 1),
    ("alpha", NumericType::Uint8, 1),
    ("robot", NumericType::Uint32, 4),
    ("role", NumericType::Uint8, 1),
    ("well", NumericType::Uint8, 1),
];
/// How much of a robot's colour is left while a fault ails it.
const AILING: u8 = 96;

/// A point a robot, in their order.
pub fn points(run: &Run, standing: &Standing, world: &World) -> PointCloud {
    let mut data = Vec::with_capacity(standing.robots() * stride() as usize);
    for (robot, place) in world.positions().iter().enumerate() {
        let (role, well) = (standing.role(robot), standing.is_well(robot));
        for coordinate in [place.x, place.y, 0.0] {
            data.extend((coordinate as f32).to_le_bytes());
        }
        data.extend(role_colour(run.role(role), role.into()));
        data.push(if well { u8::MAX } else { AILING });
        data.extend((robot as u32).to_le_bytes());
        data.extend([role, u8::from(well)]);
    }
    PointCloud {
        timestamp: Some(timestamp(world.now())),
        frame_id: ARENA.to_owned(),
        pose: Some(pose(Vec2::zeros(), 0.0)),
        point_stride: stride(),
        fields: fields(),
        data: data.into(),
    }
}

fn stride() -> u32 {
    FIELDS.iter().map(|(_, _, bytes)| bytes).sum()
}

fn fields() -> Vec<PackedElementField> {
    let mut offset = 0;
    let field = |&(name, kind, bytes): &(&str, NumericType, u32)| {
        let begin = offset;
        offset += bytes;
        PackedElementField {
            name: name.to_owned(),
            offset: begin,
            r#type: kind.into(),
        }
    };
    FIELDS.iter().map(field).collect()
}

/// A frame a robot, in their order.
pub fn transforms(world: &World) -> FrameTransforms {
    let now = world.now();
    let transform = |robot: u32| {
        let Pose { position, heading } = world.pose(ActorId(robot), now);
        FrameTransform {
            timestamp: Some(timestamp(now)),
            parent_frame_id: ARENA.to_owned(),
            child_frame_id: format!("robot_{robot}"),
            translation: Some(vector(position.x, position.y, 0.0)),
            rotation: Some(turned(heading)),
        }
    };
    FrameTransforms {
        transforms: (0..world.positions().len() as u32).map(transform).collect(),
    }
}
