//! The kinds of protocols that desim ships, each in a room of its own.

pub mod backbone;
pub mod heartbeat;
pub mod rumor;
