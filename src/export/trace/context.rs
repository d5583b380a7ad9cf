//! What a trace says of the run that it is of, and what its writers know of it before it begins.

use super::link::Link;
use crate::protocol::Layout;
use crate::radio::Reach;
use crate::scenario::Scenario;

/// A run, as those who write a trace of it know it.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its scenario.
    pub scenario: Scenario,
    /// The number of the trial.
    pub trial: u32,
    /// The digest of its events, in hexadecimal digits.
    pub digest: String,
    /// Who is in range of whom.
    pub reach: Reach,
    /// Names of the topics in use, by number.
    pub topics: &'static [&'static str],
    /// Names of the roles, by number.
    pub roles: &'static [&'static str],
    /// How the protocol's messages lie in their bytes.
    pub layout: Layout,
    /// Bytes that are accounted for each frame beside its messages.
    pub frame_header: u16,
    /// Bytes that are accounted for each message beside its payload.
    pub message_header: u16,
    /// Whether frames may carry several messages.
    pub several: bool,
    /// What its frames look like on air.
    pub link: Link,
}

impl Run {
    /// Trial number `trial` of `scenario`, whose digest was `digest`, with robots in range as `reach` says.
    #[must_use]
    pub fn new(scenario: &Scenario, trial: u32, digest: &str, reach: Reach) -> Self {
        let topics = scenario.topics();
        let several = scenario.gossip.piggyback;
        let [frame_header, message_header] = scenario.header_bytes();
        Self {
            trial,
            digest: digest.to_owned(),
            reach,
            topics,
            roles: scenario.protocol.roles(),
            layout: scenario.layout(),
            frame_header,
            message_header,
            several,
            link: Link::of(&scenario.radio, scenario.swarm.robots),
            scenario: scenario.clone(),
        }
    }

    /// What the protocol calls a topic.
    #[must_use]
    pub fn topic(&self, number: u8) -> &'static str {
        self.topics.get(usize::from(number)).copied().unwrap_or("unknown")
    }

    /// What the protocol calls a role.
    #[must_use]
    pub fn role(&self, number: u8) -> &'static str {
        self.roles.get(usize::from(number)).copied().unwrap_or("unknown")
    }

    /// All bytes that are accounted for a frame with so many messages and bytes of payload.
    #[must_use]
    pub fn bytes(&self, messages: usize, payload: usize) -> u64 {
        u64::from(self.frame_header) + messages as u64 * u64::from(self.message_header) + payload as u64
    }
}
