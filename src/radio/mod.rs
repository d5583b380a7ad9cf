//! The radio: who hears a transmission, when, and what becomes of each copy. A pure state machine.

mod config;

pub use config::{LatencyConfig, LossConfig, RadioConfig, SensingConfig};

use crate::engine::{ActorId, SimTime};

/// Why a frame did not reach a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum LossCause {
    /// The channel's loss model dropped it.
    Channel,
}

impl LossCause {
    /// Every cause, in the order of their numbers.
    pub const ALL: [Self; 1] = [Self::Channel];

    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Channel => "channel",
        }
    }
}

/// What becomes of a frame at one intended receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// It will have arrived at `at`; the receiver senses the sender at `displacement` (metres, arena axes).
    Arrives {
        /// Instant of arrival.
        at: SimTime,
        /// Sensed position of the sender relative to the receiver.
        displacement: [f32; 2],
    },
    /// It never arrives.
    Lost(LossCause),
}

/// A robot within range of a transmission.
#[derive(Clone, Copy, Debug)]
pub struct Listener {
    /// Who.
    pub id: ActorId,
    /// The sender's position relative to it at the time of transmission, metres, arena axes.
    pub sender: crate::geometry::Vec2,
}
