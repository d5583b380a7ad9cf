//! Protocols: what robots say and do. A robot is a pure state machine, handed time, input and randomness.
//!
//! A protocol implements [`Protocol`]. It sees the frames that reached it since it last woke, where it is, and what
//! is near; it answers with messages, a velocity, timers, and notes for the metrics. It never sees the radio, the
//! queue or another robot.

use std::borrow::Borrow;
use std::fmt::Debug;

use tokio_util::codec::{Decoder, Encoder};

use crate::engine::SimTime;
use detector::DetectorConfig;

mod codec;
mod completion;
pub mod control;
pub mod detector;
pub mod gossip;
mod input;
mod layout;
mod names;
mod output;
mod robot;
pub mod robot_table;
pub mod steering;
mod targets;
pub mod wander;

pub use codec::{CodecError, Serialised};
pub use completion::CompletionConfig;
pub use input::{Address, Concluded, Frame, Input, Reception, Start, Wake};
pub use layout::{Content, Field, Form, Layout, Meaning, Part, Value};
pub use names::{MessageSize, Role, TimerId, Topic};
pub use output::{Directed, Evidence, Note, Output};
pub use robot::Robot;
pub use targets::{Assignment, TargetConfig, TargetsConfig};

/// A protocol as one robot runs it: [the crate's page](crate#write-it) writes, tests and runs a whole one.
///
/// All robots of a run are values of one type; what makes them differ is in the values. A step follows from the robot, the time and
/// its input alone: one that looks at a clock, a random number of its own or the order of a `HashMap` makes two runs of a seed differ.
pub trait Protocol: Sized + 'static {
    /// What robots say to each other.
    type Message: Debug + 'static;
    /// A message as its receivers get it, a clone each: the message itself if it is a word or two, else an `Rc` of it.
    type Heard: From<Self::Message> + Borrow<Self::Message> + Clone + Debug + 'static;
    /// Makes payload bytes of messages and messages of payload bytes: [`Serialised`], or one by hand, of which there is an example there.
    /// One for all robots, so it may keep nothing. A message that does not come back from its bytes whole, as one on the same topic, or
    /// has more than 65,535 of them, ends the run with a [`RunError`](crate::simulation::RunError).
    type Codec: Encoder<Self::Message, Error = CodecError> + Decoder<Item = Self::Message, Error = CodecError> + Default;
    /// Names of the topics, by which traffic is accounted, at least one; [`topics`](Self::topics) are those in use.
    const TOPICS: &'static [&'static str];
    /// Names of the roles, by which traffic is accounted, at least one. A robot starts in the first, and says when it
    /// [enters](Output::enter) another. Faults can choose robots by it: `roles: ["leader"]`.
    const ROLES: &'static [&'static str];
    /// The topic that the robots' failure detector listens to, if they run [one](detector): its frames are followed one by one, so that
    /// a suspicion can be traced to what became of them, by `desim explain`. Of this topic, too, the age of information is measured, detector or not,
    /// where a scenario says `metrics: (pairs: true)`.
    const STATUS: Option<Topic> = None;
    /// The topic of what the robots' failure detector says, the last of them, if robots run one: it is in use where the
    /// scenario's detector sends messages.
    const PROBE: Option<Topic> = None;
    /// Whether robots read [`Input::proximity`]; if not, it stays empty and costs nothing.
    const SENSES_PROXIMITY: bool = true;
    /// Whether robots read [`Input::powers`]; if not, it stays empty and costs nothing.
    const SENSES_POWER: bool = true;
    /// Whether a robot also hears what is [sent](Output::send) to another within its range. If so it is offered a copy as of a
    /// broadcast, and [`Frame::address`] says whom it is for; if not, its radio drops the frame and nothing is counted.
    const OVERHEARS: bool = false;

    /// Whether a robot learns what became of its frames at its own end ([`Input::outcomes`]): that they are through, acknowledged, or were given up. It is
    /// [woken](Wake::Sent) for that.
    const HEEDS_OUTCOMES: bool = false;

    /// Names of the topics in use where robots run `detector`.
    #[must_use]
    fn topics(detector: &DetectorConfig) -> &'static [&'static str] {
        match Self::PROBE {
            Some(probe) if !detector.sends() => &Self::TOPICS[..usize::from(probe.0)],
            Some(_) | None => Self::TOPICS,
        }
    }

    /// The topic that `message` belongs to, one of [`TOPICS`](Self::TOPICS): the first one, if the protocol does not say otherwise.
    fn topic(message: &Self::Message) -> Topic {
        let _ = message;
        Topic(0)
    }

    /// Tells the robot who it is, once, before the run begins. Nothing by default.
    fn start(&mut self, start: Start) {
        let _ = start;
    }

    /// Asks for the memory that the next step will read beside `self` ([`Process::prefetch`](crate::engine::Process::prefetch)).
    fn prefetch(&self) {}

    /// Takes one step: reads `input`, fills `output`, which is empty. Called at each wake, of which [`Input::wake`] says why; the
    /// robot is not asked again before its next one. `now` is what its clock shows, which may
    /// [drift](control::ControlConfig::clock_drift).
    fn step(&mut self, now: SimTime, input: &mut Input<Self::Heard>, output: &mut Output<Self::Message>);
}
