//! The event loop of one run: it carries frames, moves robots and tells observers, and decides nothing itself.
//!
//! Events at one instant happen in this order: motion tick, faults, radio, robot wakes, sample, observation. All robots that wake at
//! one instant see the world as it was before any of them acted; their answers are then applied in the order of waking.
//!
//! Copies of frames do not travel through the event queue. When a robot sends, the medium is handed the frame and each copy goes into its
//! receiver's inbox, where it waits for its fate, if the medium does not know it at once, and for the receiver to wake. A medium whose frames take time
//! has one entry in the queue, which is moved to its next event.

mod air;
mod clock;
mod digest;
mod error;
mod inbox;
mod places;
mod run;
mod setup;
mod wakes;

pub use crate::happenings::{Copy, Inbox, Observer, Sent, Vocabulary, Watch, Watcher};
pub use error::RunError;
pub use setup::{DriverKind, Finished, Setup};
