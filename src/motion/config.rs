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
        /// Its centre, within the arena.
        at: (Finite, Finite),
        /// Its radius in metres.
        radius: Positive,
        /// What a radio signal loses on its way through it, dB, where the radio minds obstacles; left out, what that radio takes for a
        /// wall. The disk radio minds none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        attenuation: Option<NonNegative>,
    },
    /// A thin straight wall.
    Wall {
        /// One end, within the arena.
        from: (Finite, Finite),
        /// The other end, within the arena and elsewhere than the first.
        to: (Finite, Finite),
        /// What a radio signal loses on its way through it, dB, where the radio minds obstacles; left out, what that radio takes for a
        /// wall. The disk radio minds none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        attenuation: Option<NonNegative>,
    },
}

impl ObstacleConfig {
    /// What a radio signal loses on its way through it, dB, if that is said.
    #[must_use]
    pub fn attenuation(&self) -> Option<NonNegative> {
        match self {
            Self::Disc { attenuation, .. } | Self::Wall { attenuation, .. } => *attenuation,
        }
    }
}

/// Where robots stand at the start. They never overlap each other, walls or obstacles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DeployConfig {
    /// Robot 0 at the arena's centre, the others uniform in a disc around it (paper section 4: a cluster). Headings are
    /// uniform, here and below.
    Cluster {
        /// Radius of the disc that holds the robots' centres, in metres. Random places fill up when bodies cover about
        /// half of it: `1.4 · body_radius · √robots` is the least to ask for.
        radius: Positive,
    },
    /// Uniform over the arena, whatever a robot's number.
    Uniform,
    /// At these places, one for each robot in order, in metres from the arena's centre.
    At(Vec<(Finite, Finite)>),
}

/// How robots move: a differential drive under PID control (paper section 3.1, equation 1), in fixed ticks.
///
/// A protocol commands velocities. One controller turns the difference to the commanded speed, scaled down by the cosine
/// of the heading error and to zero from 90° on, into an acceleration; another turns the heading error into a turning
/// rate. Both drive a quantity that adds up what they put out, so a proportional gain p alone leaves no lasting error,
/// each tick removes the share p·tick of what is left, and nothing overshoots while p·tick ≤ 1. Hence the defaults: no
/// integral and no derivative part, and gains that settle within a second, quick against the seconds in which a protocol
/// decides, and slow against the tick, as wheels are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// Length of a motion tick in seconds; velocity is constant within it. A command is taken up at the next tick.
    pub tick: Positive,
    /// Largest linear speed in m/s, below `body_radius / tick` (Khepera IV: 0.5 in use, 0.8 at most). The paper does not
    /// state it: 0.026 is calibrated, on its 1,400 steps for 20 robots with one link alone.
    pub max_speed: Positive,
    /// Largest turning rate in degrees per second, less than half a turn in a tick. 180 takes wheels of 0.16 m/s at a
    /// Khepera IV's axle of 0.105 m.
    pub max_turn_rate: Positive,
    /// Radius of a robot's body in metres (Khepera IV: 0.07).
    pub body_radius: Positive,
    /// Control of the linear speed. Default: p = 5/s, half of the missing speed in each tick of 0.1 s.
    pub linear: PidConfig,
    /// Control of the heading. Default: p = 4/s, 40 % of the error in each tick of 0.1 s; errors above 45° turn at the
    /// largest rate.
    pub angular: PidConfig,
    /// How far the proximity sensors see, in metres from the body's edge.
    pub proximity_range: NonNegative,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self {
            tick: Positive::new(0.1),
            max_speed: Positive::new(0.026),
            max_turn_rate: Positive::new(180.0),
            body_radius: Positive::new(0.07),
            linear: PidConfig::proportional(5.0),
            angular: PidConfig::proportional(4.0),
            proximity_range: NonNegative::new(0.25),
        }
    }
}

/// Gains of one PID controller. Together they must be stable at the tick: with `p` alone, `p · tick < 2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PidConfig {
    /// Proportional gain, 1/s.
    pub p: Positive,
    /// Integral gain, 1/s². Default 0.
    #[serde(default = "none")]
    pub i: NonNegative,
    /// Derivative gain, no unit, below 1. Default 0.
    #[serde(default = "none")]
    pub d: NonNegative,
}

impl PidConfig {
    fn proportional(p: f64) -> Self {
        Self {
            p: Positive::new(p),
            i: none(),
            d: none(),
        }
    }
}

fn none() -> NonNegative {
    NonNegative::new(0.0)
}
