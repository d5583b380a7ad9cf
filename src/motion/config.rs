//! What a scenario says about the arena, the deployment and the robots' drive.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative, Positive};

/// The arena: a rectangle with walls, centred at the origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArenaConfig {
    /// Width and height in metres.
    pub size: (Positive, Positive),
    /// Bodies that robots cannot pass.
    pub obstacles: Vec<ObstacleConfig>,
}

impl Default for ArenaConfig {
    fn default() -> Self {
        Self {
            size: (Positive::new(10.0), Positive::new(10.0)),
            obstacles: Vec::new(),
        }
    }
}

/// A fixed body in the arena. Coordinates in metres from the centre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ObstacleConfig {
    /// A disc.
    Disc {
        /// Its centre.
        at: (Finite, Finite),
        /// Its radius in metres.
        radius: Positive,
    },
    /// A thin straight wall.
    Wall {
        /// One end.
        from: (Finite, Finite),
        /// The other end.
        to: (Finite, Finite),
    },
}

/// Where robots stand at the start. They never overlap each other, walls or obstacles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DeployConfig {
    /// Robot 0 at the centre, the others uniform in a disc around it (paper section 4.1: a cluster).
    Cluster {
        /// Radius of the disc in metres.
        radius: Positive,
    },
    /// Uniform over the arena.
    Uniform,
    /// At these places, robot by robot, in metres from the centre.
    At(Vec<(Finite, Finite)>),
}

/// How robots move: a differential drive under PID control, in fixed ticks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// Length of a motion tick in seconds; velocity is constant within it.
    pub tick: Positive,
    /// Largest linear speed in m/s. The paper does not state it: 0.03 is calibrated to its completion times.
    pub max_speed: Positive,
    /// Largest turning rate in degrees per second.
    pub max_turn_rate: Positive,
    /// Radius of a robot's body in metres (Khepera IV: 0.07).
    pub body_radius: Positive,
    /// Control of the linear speed.
    pub linear: PidConfig,
    /// Control of the heading.
    pub angular: PidConfig,
    /// How far the proximity sensors see, in metres from the body's edge.
    pub proximity_range: NonNegative,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self {
            tick: Positive::new(0.1),
            max_speed: Positive::new(0.03),
            max_turn_rate: Positive::new(180.0),
            body_radius: Positive::new(0.07),
            linear: PidConfig {
                p: NonNegative::new(5.0),
                i: NonNegative::new(0.0),
                d: NonNegative::new(0.0),
            },
            angular: PidConfig {
                p: NonNegative::new(4.0),
                i: NonNegative::new(0.0),
                d: NonNegative::new(0.0),
            },
            proximity_range: NonNegative::new(0.25),
        }
    }
}

/// Gains of one PID controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PidConfig {
    /// Proportional gain, 1/s.
    pub p: NonNegative,
    /// Integral gain, 1/s².
    pub i: NonNegative,
    /// Derivative gain, no unit.
    pub d: NonNegative,
}
