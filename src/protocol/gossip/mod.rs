//! How robots repeat what they gossip: when a topic has its turn, what is sent then, how far and how often it is
//! passed on. Each robot's turns begin at a phase of its own (`control.phase`).
//!
//! Which protocol heeds which setting:
//!
//! | setting | Backbone | Heartbeat | Rumor |
//! |---|---|---|---|
//! | `status` | all of it | interval and jitter | |
//! | `strand` | all of it | | |
//! | `request` | all of it | | |
//! | `relay` | interval, jitter, retransmit, of the root's orders | | all of it, of the rumours |
//! | `piggyback` | yes | where its detector sends messages too | yes |
//!
//! A setting that a protocol does not heed must be left at its default: a scenario that changes it is refused.

mod config;
mod repeat;
mod turns;

pub use config::{
    FanOutConfig, GossipConfig, RelayConfig, RequestConfig, RetransmitConfig, SendConfig, StrandConfig,
    TimeToLiveConfig, TopicConfig,
};
pub use repeat::{Repeat, Repetition};
pub use turns::{Timing, Turns};
