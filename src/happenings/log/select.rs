//! Which part of a run a log has.

use std::collections::BTreeSet;

use super::records::{CopyRecord, Event};
use crate::engine::{ActorId, SimTime, Span};
use crate::protocol::Topic;

/// A part of a run: from when to when, which robots, which topics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// From this instant on: what is sent then, and what happens.
    pub from: SimTime,
    /// Up to this instant, which is not in it.
    pub until: SimTime,
    /// Frames that these send or are offered, copies that these send or are offered, what happens to these or is about them. `None`: all.
    pub robots: Option<BTreeSet<ActorId>>,
    /// Frames with messages on these topics. `None`: all.
    pub topics: Option<BTreeSet<Topic>>,
    /// The least time from one instant to the next at which places are looked at; zero for every tick.
    pub places_every: Span,
}

impl Default for Selection {
    /// All of it.
    fn default() -> Self {
        Self {
            from: SimTime::ZERO,
            until: SimTime::NEVER,
            robots: None,
            topics: None,
            places_every: Span::ZERO,
        }
    }
}

impl Selection {
    /// Whether this instant is within it.
    #[inline]
    #[must_use]
    pub fn is_then(&self, at: SimTime) -> bool {
        self.from <= at && at < self.until
    }

    /// Whether this robot is.
    #[must_use]
    pub fn has_robot(&self, robot: ActorId) -> bool {
        self.robots.as_ref().is_none_or(|robots| robots.contains(&robot))
    }

    /// Whether this topic is.
    #[must_use]
    pub fn has_topic(&self, topic: Topic) -> bool {
        self.topics.as_ref().is_none_or(|topics| topics.contains(&topic))
    }

    /// Whether this copy is, of a frame of the time.
    pub(super) fn has_copy(&self, record: &CopyRecord) -> bool {
        let ends = [record.copy.sender, record.copy.receiver];
        self.has_topic(record.copy.topic) && ends.into_iter().any(|robot| self.has_robot(robot))
    }

    /// Whether this event is, of the time: what befalls links concerns everybody.
    #[must_use]
    pub fn has_event(&self, event: &Event) -> bool {
        let mut ends = event.robot.into_iter().chain(event.what.about()).peekable();
        ends.peek().is_none() || ends.any(|robot| self.has_robot(robot))
    }
}
