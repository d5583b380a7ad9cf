//! What a scenario says about rumours.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::protocol::CompletionConfig;
use crate::protocol::gossip::{FanOutConfig, RelayConfig, RetransmitConfig};

/// Most rumours of a trial: a request has a bit for each.
const MOST_RUMORS: usize = 64;
/// Most robots that a message can name: ids are two bytes on air.
const MOST_ROBOTS: u32 = 1 << 16;

/// Rumour spreading. How often, how many times and to whom rumours are passed on is said in `gossip.relay`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RumorConfig {
    /// What a robot does in a round.
    pub mode: Mode,
    /// When robots have their rounds.
    pub rounds: RoundsConfig,
    /// How many rumours there are, and who begins them.
    pub sources: SourcesConfig,
    /// Length of a rumour in bytes, its number and the address not included.
    #[schemars(range(max = 60_000))]
    pub size: u16,
    /// When the mission is complete: `Reached` as soon as all live robots know all rumours, `Held(seconds)` or `EachVisited`; by default
    /// held for 10 s, or for `metrics.hold`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "CompletionConfig")]
    pub completion: Option<CompletionConfig>,
}

impl Default for RumorConfig {
    fn default() -> Self {
        Self {
            mode: Mode::Push,
            rounds: RoundsConfig::Periodic,
            sources: SourcesConfig::Random(1),
            size: 32,
            completion: None,
        }
    }
}

/// What a robot does in a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Mode {
    /// Sends what it knows.
    Push,
    /// Asks for what it does not know. It cannot know that there is no more, and so asks in every round.
    Pull,
    /// Both.
    PushPull,
}

impl Mode {
    pub(super) const fn pushes(self) -> bool {
        matches!(self, Self::Push | Self::PushPull)
    }

    pub(super) const fn pulls(self) -> bool {
        matches!(self, Self::Pull | Self::PushPull)
    }
}

/// When robots have their rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum RoundsConfig {
    /// At a control step, once in every `gossip.relay.interval`.
    Periodic,
    /// At the exact times of a Poisson process of each robot's own, `gossip.relay.interval` apart on average.
    Poisson,
}

/// How many rumours there are, and who begins them, each at its first control step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum SourcesConfig {
    /// So many rumours, from 1 to 64, each begun by a robot drawn anew in each trial.
    Random(#[schemars(range(min = 1, max = 64))] u8),
    /// One rumour begun by each of these robots, from 1 to 64 of them, numbered from 0.
    Robots(#[schemars(length(min = 1, max = 64))] Vec<u32>),
}

impl SourcesConfig {
    /// How many rumours there are.
    #[must_use]
    pub fn rumors(&self) -> usize {
        match self {
            Self::Random(rumors) => usize::from(*rumors),
            Self::Robots(robots) => robots.len(),
        }
    }
}

impl RumorConfig {
    /// Whether rounds come at the times of a Poisson process, and not at control steps.
    #[must_use]
    pub fn is_poisson(&self) -> bool {
        self.rounds == RoundsConfig::Poisson
    }

    /// What is wrong with these settings together, for `robots` robots: the field at fault and what would be right.
    #[must_use]
    pub fn own_problems(&self, robots: u32) -> Vec<(String, String)> {
        let mut problems = Vec::new();
        let mut problem = |field: &str, message: String| problems.push((field.to_owned(), message));
        let rumors = self.sources.rumors();
        if !(1..=MOST_RUMORS).contains(&rumors) {
            problem("sources", format!("{rumors} rumours; there must be 1 to {MOST_RUMORS}"));
        }
        if let SourcesConfig::Robots(named) = &self.sources
            && let Some(stranger) = named.iter().find(|robot| **robot >= robots)
        {
            problem(
                "sources",
                format!(
                    "robot {stranger} begins a rumour, but robots are numbered from 0 to {}",
                    robots.saturating_sub(1)
                ),
            );
        }
        if robots > MOST_ROBOTS {
            problem("", format!("{robots} robots; messages can name at most {MOST_ROBOTS}"));
        }
        if self.size > 60_000 {
            problem(
                "size",
                format!(
                    "a rumour of {} bytes does not fit into a frame; at most 60000 do",
                    self.size
                ),
            );
        }
        problems
    }

    /// What is wrong with `relay` for this protocol and `robots` robots: the field at fault, from that section on, and what
    /// would be right.
    #[must_use]
    pub fn relay_problems(&self, relay: &RelayConfig, robots: u32) -> Vec<(String, String)> {
        let mut problems = Vec::new();
        let mut problem = |field: &str, message: String| problems.push((field.to_owned(), message));
        if let FanOutConfig::Peers(peers) = relay.fan_out
            && peers >= robots
        {
            problem(
                "fan_out",
                format!(
                    "a robot has {} others to address, not {peers}; lower it, or use Everyone",
                    robots.saturating_sub(1)
                ),
            );
        }
        if self.mode == Mode::Pull && relay.retransmit != RetransmitConfig::Unlimited {
            problem(
                "retransmit",
                "rumours that are pulled are not pushed, so nothing counts their transmissions; use Unlimited, Push or PushPull".into(),
            );
        }
        if self.rounds == RoundsConfig::Poisson && relay.jitter.get() > 0.0 {
            problem(
                "jitter",
                "Poisson rounds are random already; set it to 0, or make the protocol's rounds Periodic".into(),
            );
        }
        problems
    }
}
