//! What a protocol calls its topics and roles.

use crate::protocol::Protocol;

/// Names of topics and roles, by which records number them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Names {
    /// Topics, in the order of their numbers.
    pub topics: &'static [&'static str],
    /// Roles, in the order of their numbers.
    pub roles: &'static [&'static str],
}

impl Names {
    /// The names that protocol `P` declares.
    #[must_use]
    pub const fn of<P: Protocol>() -> Self {
        Self {
            topics: P::TOPICS,
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
