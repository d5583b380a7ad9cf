//! The event loop of one run: it carries frames, moves robots and tells observers, and decides nothing itself.
//!
//! Events at one instant happen in this order: motion tick, faults, robot wakes, sample, observation. All robots that wake at
//! one instant see the world as it was before any of them acted; their answers are then applied in the order of waking.
//!
//! A frame does not travel through the event queue. When a robot sends, the medium decides the fate of every copy at
//! once, and each copy waits in its receiver's inbox until the receiver wakes.

mod air;
mod clock;
mod digest;
mod error;
mod inbox;
mod run;
mod setup;
mod wakes;

pub use crate::happenings::{Copy, Inbox, Observer, Sent};
pub use error::RunError;
pub use setup::{DriverKind, Finished, Setup};
