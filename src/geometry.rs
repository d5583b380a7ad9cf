//! The plane: vectors, angles, poses. Lengths in metres, angles in radians, counter-clockwise from the x axis.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};

/// A vector or a point in the plane, in metres (or metres per second where it is a velocity).
pub type Vec2 = nalgebra::Vector2<f64>;

/// Where a robot is and which way it faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
pub struct Pose {
    /// Position in the arena, metres from its centre.
    pub position: Vec2,
    /// Heading, radians in (−π, π].
    pub heading: f64,
}

impl From<[f64; 3]> for Pose {
    fn from([x, y, heading]: [f64; 3]) -> Self {
        Self {
            position: Vec2::new(x, y),
            heading,
        }
    }
}

impl From<Pose> for [f64; 3] {
    fn from(pose: Pose) -> Self {
        [pose.position.x, pose.position.y, pose.heading]
    }
}

/// By how much a length may be beyond a limit and still count as at it, as a share of the limit.
///
/// People write lengths in decimals, which binary numbers hold with a share of 1e-16 too much or too little: robots at 0.1 and 0.8
/// are 0.7000000000000001 m apart, and within 0.7 m of each other all the same. So every limit that includes its rim reaches to
/// [`at_most`] of it or begins at [`at_least`] of it. Coordinates may be a million times as large as the limit before their
/// rounding (2⁻⁵³ each) shows, and the share itself is below anything measured: 2 nm at 2 m.
pub const ROUNDING: f64 = 1e-9;

/// The largest length that counts as no more than `limit`.
#[inline]
#[must_use]
pub fn at_most(limit: f64) -> f64 {
    limit * (1.0 + ROUNDING)
}

/// The smallest length that counts as no less than `limit`.
#[inline]
#[must_use]
pub fn at_least(limit: f64) -> f64 {
    limit * (1.0 - ROUNDING)
}

/// Whether `place` is to the left of the line through `point` in the direction of `along`, or on it.
#[must_use]
pub fn is_left_of(place: Vec2, point: Vec2, along: Vec2) -> bool {
    let off = place - point;
    along.perp(&off) >= -ROUNDING * along.norm() * off.norm()
}

/// The angle equal to `angle` modulo a full turn, in (−π, π].
#[must_use]
pub fn wrap_angle(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

/// The unit vector at `angle`.
#[must_use]
pub fn unit(angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos, sin)
}

/// The direction of `vector`, zero for the zero vector.
#[must_use]
pub fn direction(vector: Vec2) -> Vec2 {
    vector.try_normalize(0.0).unwrap_or_else(Vec2::zeros)
}

/// `vector`, shortened to `limit` if it is longer.
#[must_use]
pub fn clamp_length(vector: Vec2, limit: f64) -> Vec2 {
    let length = vector.norm();
    if length > limit {
        vector * (limit / length)
    } else {
        vector
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_wrapped_angle_lies_in_one_turn_and_points_the_same_way(angle in -100.0..100.0_f64) {
            let wrapped = wrap_angle(angle);
            prop_assert!(wrapped > -PI && wrapped <= PI);
            prop_assert!((unit(wrapped) - unit(angle)).norm() < 1e-9);
        }

        #[test]
        fn a_clamped_vector_keeps_its_direction_and_never_exceeds_the_limit(
            x in -10.0..10.0_f64, y in -10.0..10.0_f64, limit in 0.0..5.0_f64,
        ) {
            let vector = Vec2::new(x, y);
            let clamped = clamp_length(vector, limit);
            prop_assert!(clamped.norm() <= limit.max(0.0) + 1e-9);
            prop_assert!(clamped.perp(&vector).abs() < 1e-9);
        }
    }
}
