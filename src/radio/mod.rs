//! The radio: who hears a transmission, when, and what becomes of each copy. Pure state machines.
//!
//! A [`Medium`] is handed each frame with its length and with the robots in range, and says of each copy what becomes of it: at once, or, over a
//! radio on which frames take time and meet, when it is known, at events of its own. A [`RadioKind`] is what such radios are made of.
//!
//! # The disk radio
//! [`RadioConfig`] describes it, and [`Disk`] is the instant case: the loss model says whether a copy survives, the latency model when it arrives,
//! the sensing model where its receiver believes the sender to be. Receivers are independent of one another, and a late copy holds up no other.
//!
//! Every draw is keyed by purpose, sender, receiver and the sender's frame number: a copy has one stream for the channel,
//! whose first draw decides its loss and the next ones its latency, and one for sensing. So the fate of a copy depends neither on who else listens nor on the order in which
//! listeners are named; the frames lost at 10 % are among those lost at 30 %; and a frame that survives under two loss
//! settings has the same latency under both. A model that needs no randomness opens no stream.
//!
//! # Room for what is not here
//! Propagation (path loss, shadowing, walls) replaces the disk: [`Reach::Links`] then says who counts as in range of whom, for all of a run. What overlaps where follows from the places
//! of senders and listeners, which frames come with, and of all others ([`Places`]), not from who is offered what: a robot jams also those that it says nothing to. Each new reason for a loss is one more
//! [`LossCause`]. What a sender learns of a frame to one robot ([`Transmission::to`]) is one more thing that [`Medium::advance`] may say of it.

mod config;
mod disk;
mod draw;
mod gilbert;
mod latency;
mod law;
mod loss;
mod medium;
mod reach;
mod sensing;
mod site;

pub use config::{LatencyConfig, LossConfig, RadioConfig, SensingConfig};
pub use disk::Disk;
pub use law::{LossChain, LossRun};
pub use medium::{Fate, Fates, FrameId, Listener, Medium, RadioKind, Transmission};
pub use reach::{Links, Placed, Reach};
pub use site::{Obstacle, Places, RadioSite, Shape};

pub(crate) use medium::Arrival;
#[cfg(test)]
pub(crate) use reach::tests::Walled;

use serde::{Deserialize, Serialize};

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
