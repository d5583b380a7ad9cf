//! Parts that messages of a recording are made of. Readers stumble over a nested message that is left out, so all are written, zeros too.

use foxglove::messages::{Color, Duration, Point3, Pose, Quaternion, SceneEntity, Timestamp, Vector3};

use super::super::palette::Rgb;
use crate::engine::SimTime;
use crate::geometry::Vec2;

/// The frame of all places: metres from the arena's centre.
pub const ARENA: &str = "arena";

/// A time of the run.
pub fn timestamp(at: SimTime) -> Timestamp {
    let (seconds, nanos) = (at.as_nanos() / 1_000_000_000, at.as_nanos() % 1_000_000_000);
    u32::try_from(seconds).map_or(Timestamp::MAX, |seconds| Timestamp::new(seconds, nanos as u32))
}

/// A colour seen through, from 0 (not there) to 1.
pub fn colour([red, green, blue]: Rgb, opacity: f64) -> Color {
    let part = |part: u8| f64::from(part) / 255.0;
    Color {
        r: part(red),
        g: part(green),
        b: part(blue),
        a: opacity,
    }
}

/// A place on the ground.
pub fn point(place: Vec2) -> Point3 {
    Point3 {
        x: place.x,
        y: place.y,
        z: 0.0,
    }
}

/// So long in each direction.
pub fn vector(x: f64, y: f64, z: f64) -> Vector3 {
    Vector3 { x, y, z }
}

/// Turned so far about the upright axis, radians.
pub fn turned(heading: f64) -> Quaternion {
    let (sine, cosine) = (heading / 2.0).sin_cos();
    Quaternion {
        x: 0.0,
        y: 0.0,
        z: sine,
        w: cosine,
    }
}

/// At a place, so high, and not turned.
pub fn pose(place: Vec2, height: f64) -> Pose {
    Pose {
        position: Some(vector(place.x, place.y, height)),
        orientation: Some(turned(0.0)),
    }
}

/// A thing called `id`, which is there until another of that name is.
pub fn entity(at: SimTime, id: &str) -> SceneEntity {
    SceneEntity {
        timestamp: Some(timestamp(at)),
        frame_id: ARENA.to_owned(),
        id: id.to_owned(),
        lifetime: Some(Duration::new(0, 0)),
        frame_locked: true,
        ..SceneEntity::default()
    }
}
