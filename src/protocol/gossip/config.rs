//! What a scenario says about gossip.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::Span;
use crate::quantity::{Positive, Probability};

use super::turns::Timing;

/// Gossip settings, topic by topic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GossipConfig {
    /// Status broadcasts.
    pub status: TopicConfig,
    /// Parent and child strand info.
    pub strand: StrandConfig,
    /// Requests, repeated until they are answered.
    pub request: RequestConfig,
    /// What is passed on from robot to robot: rumours, and the root's orders.
    pub relay: RelayConfig,
    /// Whether all messages of a wake go out in one frame, which has one frame header and one fate at each receiver, instead
    /// of in a frame each.
    pub piggyback: bool,
}

/// Gossip settings of one topic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TopicConfig {
    /// Seconds between broadcasts; rounded up to whole control periods (paper: every control step, 0.1 s).
    pub interval: Positive,
    /// Share of the interval within which each broadcast is moved at random, in whole control periods.
    pub jitter: Probability,
    /// What is sent when the topic has its turn.
    pub send: SendConfig,
}

impl Default for TopicConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
            jitter: Probability::new(0.0),
            send: SendConfig::Always,
        }
    }
}

/// Gossip settings of strand info.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StrandConfig {
    /// Seconds between broadcasts; rounded up to whole control periods (paper: every control step, 0.1 s).
    pub interval: Positive,
    /// Share of the interval within which each broadcast is moved at random, in whole control periods.
    pub jitter: Probability,
    /// What is sent when the topic has its turn.
    pub send: SendConfig,
    /// How long a strand counts that is not heard again.
    pub time_to_live: TimeToLiveConfig,
    /// Robots that a strand may name, its sender included. A longer one is worth nothing: a parent that sends it is no way
    /// to the root and is given up, a child that sends it is not linked to. It bounds what is passed on in a circle, and with
    /// it the length of chains. 255, the default, is as many as a strand can name.
    #[schemars(range(min = 1))]
    pub hop_limit: u8,
}

impl Default for StrandConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
            jitter: Probability::new(0.0),
            send: SendConfig::Always,
            time_to_live: TimeToLiveConfig::Unlimited,
            hop_limit: u8::MAX,
        }
    }
}

/// How long a strand counts that is not heard again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TimeToLiveConfig {
    /// As long as its sender's statuses arrive.
    Unlimited,
    /// For so many seconds. After that a parent of whom only statuses are heard is given up like one that is lost, a relay
    /// whose child's strand is that old goes free, and the root forgets the chain.
    Seconds(Positive),
}

/// Gossip settings of requests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RequestConfig {
    /// Seconds between repetitions; rounded up to whole control periods (paper: every control step, 0.1 s).
    pub interval: Positive,
    /// Share of the interval within which each repetition is moved at random, in whole control periods.
    pub jitter: Probability,
}

impl Default for RequestConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
            jitter: Probability::new(0.0),
        }
    }
}

/// Gossip settings of what is passed on from robot to robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RelayConfig {
    /// Seconds between rounds; rounded up to whole control periods.
    pub interval: Positive,
    /// Share of the interval within which each round is moved at random, in whole control periods.
    pub jitter: Probability,
    /// How often each robot passes a piece of news on.
    pub retransmit: RetransmitConfig,
    /// Whom each robot addresses in a round.
    pub fan_out: FanOutConfig,
}

impl Default for RelayConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(1.0),
            jitter: Probability::new(0.0),
            retransmit: RetransmitConfig::Unlimited,
            fan_out: FanOutConfig::Everyone,
        }
    }
}

/// How often each robot passes a piece of news on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum RetransmitConfig {
    /// For ever.
    Unlimited,
    /// So many times ⌈log₁₀(N + 1)⌉ messages, for N robots, from when it heard it first (memberlist's retransmit mult; its
    /// default is 4). At least 1.
    Multiplier(#[schemars(range(min = 1))] u32),
}

impl RetransmitConfig {
    /// Messages that one robot out of `robots` sends of one piece of news.
    #[must_use]
    pub fn limit(self, robots: usize) -> u64 {
        match self {
            Self::Unlimited => u64::MAX,
            Self::Multiplier(multiplier) => u64::from(multiplier) * ((robots + 1) as f64).log10().ceil() as u64,
        }
    }
}

/// Whom each robot addresses in a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum FanOutConfig {
    /// Whoever hears it: one broadcast.
    Everyone,
    /// So many other robots, drawn anew in each round, each with a message of its own that names it. At least 1.
    Peers(#[schemars(range(min = 1))] u32),
}

/// What is sent when a topic has its turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum SendConfig {
    /// What there is to say, every time (the paper's way).
    Always,
    /// What differs from what was said last, and else a sign of life now and then.
    OnChange {
        /// Longest pause between two broadcasts, seconds; at least the interval. Jitter comes on top of it.
        max_interval: Positive,
        /// Turns in a row in which something new is said, for the first may be lost. At least 1.
        #[serde(default = "once")]
        #[schemars(range(min = 1))]
        repetition: u32,
    },
}

fn once() -> u32 {
    1
}

impl TopicConfig {
    /// When the topic has its turn.
    #[must_use]
    pub fn timing(&self, control_period: Span) -> Timing {
        Timing::new(self.interval, self.jitter, control_period)
    }
}

impl StrandConfig {
    /// When the topic has its turn.
    #[must_use]
    pub fn timing(&self, control_period: Span) -> Timing {
        Timing::new(self.interval, self.jitter, control_period)
    }
}

impl RequestConfig {
    /// When the topic has its turn.
    #[must_use]
    pub fn timing(&self, control_period: Span) -> Timing {
        Timing::new(self.interval, self.jitter, control_period)
    }
}

impl RelayConfig {
    /// When a round is due.
    #[must_use]
    pub fn timing(&self, control_period: Span) -> Timing {
        Timing::new(self.interval, self.jitter, control_period)
    }
}
