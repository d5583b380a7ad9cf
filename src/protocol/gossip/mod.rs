//! How robots repeat what they gossip: when a topic has its turn, what is sent then, how far and how often it is
//! passed on. Each robot's turns begin at a phase of its own (`control.phase`).
//!
//! Which of these settings robots heed, the kind of their protocol says; the others must be left at their defaults.

mod config;
mod repeat;
mod turns;

pub use config::{
    FanOutConfig, GossipConfig, RelayConfig, RequestConfig, RetransmitConfig, SendConfig, StrandConfig,
    TimeToLiveConfig, TopicConfig,
};
pub use repeat::{Repeat, Repetition};
pub use turns::{OwnTurns, Timing, Turns};
