//! How a run can fail.

use crate::engine::ActorId;
use crate::protocol::CodecError;

/// Why a run stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A robot's message could not be encoded, or its bytes not be decoded.
    #[error("a message of {protocol} on topic `{topic}` cannot cross the air, {bytes} bytes of it: {source}")]
    Codec {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
        /// The length of its payload, as far as it was written.
        bytes: usize,
        /// What the codec says.
        source: CodecError,
    },
    /// A robot sends a message to itself, or to a robot that does not exist.
    #[error(
        "robot {sender} of {protocol} sends a message on topic `{topic}` to robot {to}: it can send to others alone, numbered from 0 to {last}"
    )]
    Addressee {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
        /// Who sends it.
        sender: ActorId,
        /// To whom.
        to: ActorId,
        /// The greatest number of a robot.
        last: usize,
    },
    /// A robot measured what is no finite number.
    #[error("robot {robot} of {protocol} measures `{name}` as {value}, which is no finite number")]
    Value {
        /// The protocol's type.
        protocol: &'static str,
        /// Who measured it.
        robot: ActorId,
        /// What it is called.
        name: &'static str,
        /// How much it is.
        value: f64,
    },
    /// The codec made bytes that it does not read as a whole message.
    #[error("the codec of {protocol} does not read its own {bytes} bytes on topic `{topic}` as a whole message")]
    Undecodable {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
        /// The length of its payload.
        bytes: usize,
    },
    /// The codec made bytes of which it reads only a part.
    #[error(
        "the codec of {protocol} reads {read} of its own {bytes} bytes on topic `{topic}`: what it leaves would never arrive"
    )]
    Unread {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
        /// The length of its payload.
        bytes: usize,
        /// How much of it was read.
        read: usize,
    },
    /// The codec made a message of another topic of the bytes.
    #[error("the codec of {protocol} makes a message on topic `{read}` of the {bytes} bytes of one on topic `{topic}`")]
    OtherTopic {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
        /// The length of its payload.
        bytes: usize,
        /// The topic of what was read.
        read: &'static str,
    },
    /// A message is longer than a frame can hold.
    #[error("a message of {bytes} bytes of {protocol} on topic `{topic}` is too long: a frame holds at most 65535")]
    TooLong {
        /// The protocol's type.
        protocol: &'static str,
        /// The message's topic.
        topic: &'static str,
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
