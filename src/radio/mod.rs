//! The radio: who hears a transmission, when, and what becomes of each copy. A pure state machine.
//!
//! A [`Medium`] is told of a transmission and of the robots in range, and settles a [`Fate`] for each of them: the loss
//! model says whether the copy survives, the latency model when it arrives, the sensing model where its receiver
//! believes the sender to be. Receivers are independent of one another, and a late copy holds up no other.
//!
//! Every draw is keyed by purpose, sender, receiver and the sender's frame number: a copy has one stream for the channel,
//! whose first draw decides its loss and the next ones its latency, and one for sensing. So the fate of a copy depends neither on who else listens nor on the order in which
//! listeners are named; the frames lost at 10 % are among those lost at 30 %; and a frame that survives under two loss
//! settings has the same latency under both. A model that needs no randomness opens no stream.
//!
//! # Room for what is not here
//! Propagation (path loss, shadowing) replaces the disk: [`Medium::range`] becomes the farthest distance at which a
//! reception is possible, which is all that the run asks of it, and a copy below the receiver's sensitivity is lost for
//! [`LossCause::BelowSensitivity`] ahead of the loss model. Medium access (carrier sense, backoff, collisions, queues) needs
//! transmissions that begin and end: [`Medium::transmit`] then enqueues, and the run hands the medium its own wake-ups
//! back. Fates leave through the `receive` callback in both cases, because a fate need not be known when a frame is
//! handed over; each new reason for a loss is one more [`LossCause`].

mod config;
mod draw;
mod gilbert;
mod latency;
mod law;
mod loss;
mod medium;
mod sensing;

pub use config::{LatencyConfig, LossConfig, RadioConfig, SensingConfig};
pub use law::{LossChain, LossRun};
pub use medium::Medium;

use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;

/// Why a frame did not reach a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum LossCause {
    /// The channel's loss model dropped it.
    Channel,
    /// A fault of the link stopped it (a partition, a burst): decided when it is sent, before the channel.
    LinkFault,
    /// Its receiver could not hear when it arrived.
    ReceiverDown,
    /// It was sent to a robot that was out of range: too weak for the receiver, whatever the channel. Broadcasts are offered to
    /// robots in range alone, so none is lost for this.
    BelowSensitivity,
}

impl LossCause {
    /// Every cause, in the order of their numbers.
    pub const ALL: [Self; 4] = [
        Self::Channel,
        Self::LinkFault,
        Self::ReceiverDown,
        Self::BelowSensitivity,
    ];

    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Channel => "channel",
            Self::LinkFault => "link_fault",
            Self::ReceiverDown => "receiver_down",
            Self::BelowSensitivity => "below_sensitivity",
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
    pub sender: Vec2,
}
