//! What a scenario says about the backbone protocol. Symbols and values are those of the paper's table 1.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative, Positive};

/// The failure-tolerant connectivity backbone (paper section 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackboneConfig {
    /// Where the workers go and how many links each needs.
    pub targets: TargetsConfig,
    /// d_s, the safe communication distance: length of the virtual springs, metres.
    #[serde(default = "safe_distance")]
    pub safe_distance: Positive,
    /// d_c, the critical communication distance, metres; above `safe_distance`, within the radio's range.
    #[serde(default = "critical_distance")]
    pub critical_distance: Positive,
    /// d_δ, the movement threshold: a worker this near to its target holds it, metres.
    #[serde(default = "movement_threshold")]
    pub movement_threshold: Positive,
    /// k, the spring constant, 1/s.
    #[serde(default = "spring_gain")]
    pub spring_gain: Positive,
    /// ε of the Lennard-Jones potential between free robots.
    #[serde(default = "lj_epsilon")]
    pub lj_epsilon: NonNegative,
    /// δ of the Lennard-Jones potential, the distance that it settles at, metres.
    #[serde(default = "lj_delta")]
    pub lj_delta: Positive,
}

fn safe_distance() -> Positive {
    Positive::new(1.4)
}

fn critical_distance() -> Positive {
    Positive::new(1.7)
}

fn movement_threshold() -> Positive {
    Positive::new(0.3)
}

fn spring_gain() -> Positive {
    Positive::new(0.8)
}

fn lj_epsilon() -> NonNegative {
    NonNegative::new(60.0)
}

fn lj_delta() -> Positive {
    Positive::new(0.5)
}

/// The targets of a mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TargetsConfig {
    /// Equally spaced on a circle around the centre, the first on the positive x axis (paper section 5.1: four, 90° apart).
    Ring {
        /// How many.
        count: u8,
        /// Their distance from the centre, metres.
        radius: Positive,
        /// Links that each needs, at least 1.
        #[serde(default = "one_link")]
        links: u8,
    },
    /// Each by its place.
    At(Vec<TargetConfig>),
}

/// One target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetConfig {
    /// Place in metres from the centre.
    pub at: (Finite, Finite),
    /// Links that it needs, at least 1.
    #[serde(default = "one_link")]
    pub links: u8,
}

fn one_link() -> u8 {
    1
}
