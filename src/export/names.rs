//! What a protocol calls its topics and roles.

use crate::protocol::Protocol;
use crate::protocol::detector::DetectorConfig;

/// Names of topics and roles, by which records number them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Names {
    /// Topics, in the order of their numbers.
    pub topics: &'static [&'static str],
    /// Roles, in the order of their numbers.
    pub roles: &'static [&'static str],
}

impl Names {
    /// The names of what protocol `P` has in use where robots run `detector`.
    #[must_use]
    pub fn of<P: Protocol>(detector: &DetectorConfig) -> Self {
        Self {
            topics: P::topics(detector),
            roles: P::ROLES,
        }
    }

    /// The name of a topic.
    #[must_use]
    pub fn topic(&self, number: usize) -> &'static str {
        self.topics.get(number).copied().unwrap_or("unknown")
    }

    /// The name of a role.
    #[must_use]
    pub fn role(&self, number: usize) -> &'static str {
        self.roles.get(number).copied().unwrap_or("unknown")
    }
}
