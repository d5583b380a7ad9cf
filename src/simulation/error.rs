//! How a run can fail.

use crate::protocol::{CodecError, Topic};

/// Why a run stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A robot's message could not be encoded, or its bytes not be decoded.
    #[error("a message cannot cross the air: {0}")]
    Codec(#[from] CodecError),
    /// The codec made bytes that it does not read as a whole message.
    #[error("the codec's own bytes on topic {} are not a whole message to its decoder", topic.0)]
    Undecodable {
        /// The message's topic.
        topic: Topic,
    },
    /// A message is longer than a frame can hold.
    #[error("a message of {bytes} bytes on topic {} is too long: a frame holds at most 65535", topic.0)]
    TooLong {
        /// The message's topic.
        topic: Topic,
        /// The length of its payload.
        bytes: usize,
    },
    /// The operating system refused the robots' runtime what it needs.
    #[error("the robots cannot be started: {0}")]
    Runtime(#[source] std::io::Error),
    /// The run was told to stop.
    #[error("interrupted")]
    Interrupted,
}
