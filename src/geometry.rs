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
