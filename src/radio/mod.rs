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
//! # The physics of a radio
//! Formulas, each a pure function of what it is handed, for media to be made of: [`propagation`] says what is left of a signal at a receiver, [`technology`] what a radio hears and how long its frames are on air,
//! and [`Modulation`] how many of their bits go wrong.
//!
//! # The shared radio
//! [`SharedConfig`] describes it, and [`Shared`] is the medium on which frames take time and meet: its module has the whole. [`Reach::Links`] says who counts as in range of whom, for all of
//! a run. What overlaps where follows from the places of all robots ([`Places`]), not from who is offered what: a robot jams also those that it says nothing to.

mod config;
mod disk;
mod disk_config;
mod draw;
mod gilbert;
mod latency;
mod law;
mod loss;
mod medium;
mod memo;
mod modulation;
pub mod propagation;
mod reach;
mod sensing;
pub mod shared;
mod site;
pub mod technology;

pub use config::RadioConfig;
pub use disk::Disk;
pub use disk_config::{DiskConfig, LatencyConfig, LossConfig, SensingConfig, WallsConfig};
pub use law::{LossChain, LossRun};
pub use medium::{
    Account, Conclusion, Fate, Fates, FrameId, Listener, Medium, Outcome, RadioKind, Reading, Transmission,
};
pub use modulation::{ErrorTable, Modulation};
pub use reach::{Contact, Links, Placed, Reach};
pub use shared::{Shared, SharedConfig};
pub use site::{Obstacle, Places, RadioSite, Shape};
pub use technology::{Phy, Section, TechnologyConfig, Waveform};

pub(crate) use medium::Arrival;
#[cfg(test)]
pub(crate) use reach::tests::Walled;

use serde::{Deserialize, Serialize};

/// Why a frame did not reach a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum LossCause {
    /// The channel dropped it: the disk radio's loss model, or bit errors that noise made.
    Channel,
    /// A fault of the link stopped it (a partition, a burst): decided when it is sent, before the channel.
    LinkFault,
    /// Its receiver could not hear when it arrived.
    ReceiverDown,
    /// It was sent to a robot that was out of range: too weak for the receiver, whatever the channel. Broadcasts are offered to
    /// robots in range alone, so none is lost for this.
    BelowSensitivity,
    /// Others sent at the same time, and it was not strong enough over them, or its receiver was on another frame.
    Collision,
    /// Its receiver was sending, or turning from hearing to sending or back.
    HalfDuplex,
    /// It never went out: the channel was found busy too often.
    AccessFailure,
    /// It found no room among what its sender still had to send.
    QueueFull,
    /// It found no room among what its sender still had to send, which was not allowed to send for a while.
    DutyCycle,
    /// It is longer than a frame of the technology may be.
    TooLong,
    /// A body or a wall stood in the way of light.
    Occlusion,
    /// Its sender lost the power to send before it was through.
    SenderDown,
}

impl LossCause {
    /// Every cause, in the order of their numbers.
    pub const ALL: [Self; 12] = [
        Self::Channel,
        Self::LinkFault,
        Self::ReceiverDown,
        Self::BelowSensitivity,
        Self::Collision,
        Self::HalfDuplex,
        Self::AccessFailure,
        Self::QueueFull,
        Self::DutyCycle,
        Self::TooLong,
        Self::Occlusion,
        Self::SenderDown,
    ];

    /// The name that reports and tables use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Channel => "channel",
            Self::LinkFault => "link_fault",
            Self::ReceiverDown => "receiver_down",
            Self::BelowSensitivity => "below_sensitivity",
            Self::Collision => "collision",
            Self::HalfDuplex => "half_duplex",
            Self::AccessFailure => "access_failure",
            Self::QueueFull => "queue_full",
            Self::DutyCycle => "duty_cycle",
            Self::TooLong => "too_long",
            Self::Occlusion => "occlusion",
            Self::SenderDown => "sender_down",
        }
    }
}
