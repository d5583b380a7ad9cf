//! Numbers of topics, roles and timers, and how long messages are: the words that all of a protocol's world share.

/// Index of a topic in [`Protocol::TOPICS`](super::Protocol::TOPICS). One beyond them is a mistake of the protocol: the run panics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Topic(pub u8);

/// Index of a role in [`Protocol::ROLES`](super::Protocol::ROLES). One beyond them is a mistake of the protocol: the run panics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Role(pub u8);

/// A protocol's own name for one of its timers, of which a robot may have 256. Robots that run a failure detector leave it
/// [its own](super::detector::TIMER).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimerId(pub u8);

/// How long a message is on air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageSize {
    /// Its payload in bytes, headers not included.
    pub payload_bytes: u16,
    /// Whether it rides in a frame that another message before it began: then that one answers for the frame's header.
    pub rides: bool,
}

impl MessageSize {
    /// Of a message in a frame of its own.
    #[must_use]
    pub const fn alone(payload_bytes: u16) -> Self {
        Self {
            payload_bytes,
            rides: false,
        }
    }
}
