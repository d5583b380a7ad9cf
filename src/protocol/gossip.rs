//! How often robots repeat what they gossip.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Positive;

/// Gossip settings, topic by topic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GossipConfig {
    /// Status broadcasts.
    pub status: TopicConfig,
    /// Parent and child strand info.
    pub strand: TopicConfig,
    /// Requests, repeated until they are answered.
    pub request: TopicConfig,
}

/// Gossip settings of one topic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TopicConfig {
    /// Seconds between broadcasts; rounded up to whole control periods (paper: every control step, 0.1 s).
    pub interval: Positive,
}

impl Default for TopicConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
        }
    }
}
