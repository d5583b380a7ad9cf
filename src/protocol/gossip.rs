//! How often robots repeat what they gossip.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::Span;
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

impl TopicConfig {
    /// Control steps from one broadcast to the next, at least 1.
    #[must_use]
    pub fn steps(&self, control_period: Span) -> u64 {
        let interval = Span::from_secs(self.interval.get()).as_nanos();
        interval.div_ceil(control_period.as_nanos().max(1)).max(1)
    }
}

impl Default for TopicConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
        }
    }
}
