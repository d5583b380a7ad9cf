//! Shared settings that a protocol may heed or not.

/// A setting of a scenario that is for the protocol to heed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shared {
    /// `gossip.status`: when statuses are sent.
    Status,
    /// `gossip.status.send`: whether a status that says nothing new is sent. Heeded only beside [`Status`](Self::Status).
    StatusSend,
    /// `gossip.strand`.
    Strand,
    /// `gossip.request`.
    Request,
    /// `gossip.relay`: how often and how many times something is passed on.
    Relay,
    /// `gossip.relay.fan_out`: to how many. Heeded only beside [`Relay`](Self::Relay).
    RelayFanOut,
    /// `gossip.piggyback`: worth something only where a robot sends several messages at once.
    Piggyback,
    /// `wander`: how robots move.
    Wander,
    /// `detector`: when a robot believes that a neighbour is down. Heeded by robots that say statuses
    /// ([`Protocol::STATUS`](crate::protocol::Protocol::STATUS)) as [`Status`](Self::Status) has it, which detectors count on.
    Detector,
}

impl Shared {
    /// All of them, in the order of a scenario.
    pub const ALL: [Self; 9] = [
        Self::Status,
        Self::StatusSend,
        Self::Strand,
        Self::Request,
        Self::Relay,
        Self::RelayFanOut,
        Self::Piggyback,
        Self::Wander,
        Self::Detector,
    ];

    /// Where it stands in a scenario.
    #[must_use]
    pub const fn path(self) -> &'static str {
        match self {
            Self::Status => "gossip.status",
            Self::StatusSend => "gossip.status.send",
            Self::Strand => "gossip.strand",
            Self::Request => "gossip.request",
            Self::Relay => "gossip.relay",
            Self::RelayFanOut => "gossip.relay.fan_out",
            Self::Piggyback => "gossip.piggyback",
            Self::Wander => "wander",
            Self::Detector => "detector",
        }
    }

    /// The setting that it is a part of, if it is.
    #[must_use]
    pub const fn whole(self) -> Option<Self> {
        match self {
            Self::StatusSend => Some(Self::Status),
            Self::RelayFanOut => Some(Self::Relay),
            _ => None,
        }
    }
}
