//! Protocols: what robots say and do. A robot is a pure state machine, handed time, input and randomness.
//!
//! A protocol implements [`Protocol`]. It sees the frames that reached it since it last woke, where it is, and what
//! is near; it answers with messages, a velocity, timers, and notes for the metrics. It never sees the radio, the
//! queue or another robot.

use std::borrow::Borrow;
use std::fmt::Debug;

use rand_philox::Philox;
use tokio_util::codec::{Decoder, Encoder};

use crate::engine::{ActorId, Process, SimTime};
use crate::geometry::{Pose, Vec2};
use detector::DetectorConfig;

mod completion;
pub mod control;
pub mod detector;
pub mod gossip;
mod output;
pub mod robot_table;
mod serialised;
pub mod wander;

pub use completion::CompletionConfig;
pub use output::{Directed, Evidence, Note, Output};
pub use serialised::Serialised;

/// Index of a topic in [`Protocol::TOPICS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Topic(pub u8);

/// Index of a role in [`Protocol::ROLES`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Role(pub u8);

/// A protocol's own name for one of its timers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimerId(pub u8);

/// A protocol as one robot runs it.
pub trait Protocol: Sized + 'static {
    /// What robots say to each other.
    type Message: Debug + 'static;
    /// A message as its receivers get it, a clone each: the message itself if it is a word or two, else an `Rc` of it.
    type Heard: From<Self::Message> + Borrow<Self::Message> + Clone + Debug + 'static;
    /// Makes payload bytes of messages and messages of payload bytes.
    type Codec: Encoder<Self::Message, Error = CodecError> + Decoder<Item = Self::Message, Error = CodecError> + Default;
    /// Names of the topics, by which traffic is accounted; [`topics`](Self::topics) are those in use.
    const TOPICS: &'static [&'static str];
    /// Names of the roles, by which traffic is accounted. A robot starts in the first.
    const ROLES: &'static [&'static str];
    /// The topic that the robots' failure detector listens to, if they run one: its frames are followed one by one, so that
    /// a suspicion can be traced to what became of them.
    const STATUS: Option<Topic> = None;
    /// The topic of what the robots' failure detector says, the last of them, if robots run one: it is in use where the
    /// scenario's detector sends messages.
    const PROBE: Option<Topic> = None;
    /// Whether robots read [`Input::proximity`]; if not, it stays empty and costs nothing.
    const SENSES_PROXIMITY: bool = true;
    /// Whether a robot also hears what is [sent](Output::send) to another within its range. If so it is offered a copy as of a
    /// broadcast, and [`Frame::address`] says whom it is for; if not, its radio drops the frame and nothing is counted.
    const OVERHEARS: bool = false;

    /// Names of the topics in use where robots run `detector`.
    #[must_use]
    fn topics(detector: &DetectorConfig) -> &'static [&'static str] {
        match Self::PROBE {
            Some(probe) if !detector.sends() => &Self::TOPICS[..usize::from(probe.0)],
            Some(_) | None => Self::TOPICS,
        }
    }

    /// The topic that `message` belongs to: the first one, if the protocol does not say otherwise.
    fn topic(message: &Self::Message) -> Topic {
        let _ = message;
        Topic(0)
    }

    /// Tells the robot who it is, once, before the run begins. Nothing by default.
    fn start(&mut self, start: Start) {
        let _ = start;
    }

    /// Asks for the memory that the next step will read beside `self` ([`Process::prefetch`]).
    fn prefetch(&self) {}

    /// Takes one step: reads `input`, fills `output`.
    fn step(&mut self, now: SimTime, input: &mut Input<Self::Heard>, output: &mut Output<Self::Message>);
}

/// What a robot is told before the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// Its own number, from 0.
    pub me: ActorId,
    /// How many robots the swarm has, itself included: their numbers are below.
    pub robots: usize,
}

/// Why a robot is awake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// Its control period came round.
    ControlStep,
    /// A timer that it had set ran out, at exactly this instant.
    Timer(TimerId),
    /// A frame arrived, in scenarios that wake robots so.
    Reception,
}

/// What a robot is told when it wakes.
#[derive(Debug)]
pub struct Input<M> {
    /// Its own number.
    pub me: ActorId,
    /// Why it is awake.
    pub wake: Wake,
    /// The frames that arrived since it last woke, in order of arrival.
    pub inbox: Vec<Reception<M>>,
    /// Where it is, as it senses it.
    pub pose: Pose,
    /// Near bodies at a control step (robots, walls, obstacles, within the proximity range): the vector from this
    /// robot's edge to the nearest point of each, in the arena's axes, metres.
    pub proximity: Vec<Vec2>,
    /// Randomness for this wake alone.
    pub random: Philox,
}

/// How long a message is on air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageSize {
    /// Its payload in bytes, headers not included.
    pub payload_bytes: u16,
    /// Whether it rides in a frame that another message before it began: then that one answers for the frame's header.
    pub rides: bool,
}

impl MessageSize {
    /// Of a message in a frame of its own.
    #[must_use]
    pub const fn alone(payload_bytes: u16) -> Self {
        Self {
            payload_bytes,
            rides: false,
        }
    }
}

/// A message as its receivers get it: decoded once, for its bytes are the same at every receiver, and then copied into each
/// inbox, so that reading an inbox is reading one stretch of memory.
#[derive(Clone, Debug)]
pub struct Frame<M> {
    /// Who sent it (the frame's header carries it).
    pub sender: ActorId,
    /// Its number among the sender's messages, which is that of its frame where each has one of its own.
    pub sequence: u32,
    /// When its transmission began.
    pub sent_at: SimTime,
    /// Its payload in bytes, headers not included.
    pub payload_bytes: u16,
    /// Whether another message for this robot came before it in the same frame: then that one answers for the frame's header.
    pub rides: bool,
    /// Whom it is for.
    pub address: Address,
    /// What its payload says.
    pub message: M,
}

impl<M> Frame<M> {
    /// How long it is.
    #[inline]
    #[must_use]
    pub const fn size(&self) -> MessageSize {
        MessageSize {
            payload_bytes: self.payload_bytes,
            rides: self.rides,
        }
    }
}

/// Whom a message is for, as the robot sees it that reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Address {
    /// All that hear it.
    Everyone,
    /// The reader alone.
    Me,
    /// Another robot: the reader overhears it ([`Protocol::OVERHEARS`]).
    Another,
}

/// A frame that reached this robot.
#[derive(Debug)]
pub struct Reception<M> {
    /// When it arrived.
    pub at: SimTime,
    /// The frame.
    pub frame: Frame<M>,
    /// Where the sender was when it sent, relative to this robot then, in the arena's axes, metres: situated
    /// communication (paper section 3.1), with the scenario's noise.
    pub displacement: [f32; 2],
}

impl<M> Reception<M> {
    /// What the metrics should know if it told its receiver nothing new on its `topic`.
    #[must_use]
    pub const fn duplicate(&self, topic: Topic) -> Note {
        Note::Duplicate {
            topic,
            size: self.frame.size(),
        }
    }

    /// [`displacement`](Self::displacement) as a vector.
    #[must_use]
    pub fn displacement(&self) -> Vec2 {
        Vec2::new(f64::from(self.displacement[0]), f64::from(self.displacement[1]))
    }
}

/// Payload bytes that are no message of the protocol.
#[derive(Debug, thiserror::Error)]
pub enum CodecError {
    /// The bytes end before the message does.
    #[error("payload ends after {0} bytes, in the middle of a message")]
    Truncated(usize),
    /// A byte has a value that its field does not know.
    #[error("{field} cannot be {value}")]
    Unknown {
        /// The field's name.
        field: &'static str,
        /// The byte found.
        value: u8,
    },
    /// The bytes do not make sense to [`Serialised`], or it cannot write the message.
    #[error("no message as postcard writes it: {0}")]
    Serialised(#[from] postcard::Error),
    /// Required by the codec traits; reading memory does not fail.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// A robot: a protocol that an engine's driver can run.
#[derive(Debug)]
pub struct Robot<P>(pub P);

impl<P: Protocol> Process for Robot<P> {
    type Input = Input<P::Heard>;
    type Output = Output<P::Message>;

    fn prefetch(&self) {
        self.0.prefetch();
    }

    fn handle(&mut self, now: SimTime, input: &mut Self::Input, output: &mut Self::Output) {
        self.0.step(now, input, output);
    }
}
