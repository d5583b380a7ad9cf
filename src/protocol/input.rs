//! What a robot is told: who it is, why it wakes, and the frames that reached it.

use rand_philox::Philox;

use super::names::{MessageSize, TimerId, Topic};
use super::output::Note;
use crate::engine::{ActorId, SimTime};
use crate::geometry::{Pose, Vec2};
use crate::radio::Outcome;

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
    /// The radio is done with something that it said, if it [heeds](super::Protocol::HEEDS_OUTCOMES) that.
    Sent,
}

/// What a robot is told when it wakes. `M` is [`Protocol::Heard`](super::Protocol::Heard).
///
/// ```
/// use desim::protocol::{Input, Wake};
/// use rand::RngExt as _; // what `random` can draw
///
/// /// Whether a robot is to speak now, and to how many that are within a metre.
/// fn speaks(input: &mut Input<u32>) -> Option<usize> {
///     let near = input.inbox.iter().filter(|reception| reception.displacement().norm() < 1.0);
///     let near = near.count();
///     (input.wake == Wake::ControlStep && input.random.random_bool(0.1)).then_some(near)
/// }
/// ```
#[derive(Debug)]
pub struct Input<M> {
    /// Its own number.
    pub me: ActorId,
    /// Why it is awake.
    pub wake: Wake,
    /// The frames that arrived since it last woke, in order of arrival.
    pub inbox: Vec<Reception<M>>,
    /// With what power each frame of the inbox arrived, dBm, over a radio that knows powers, if its protocol [reads](super::Protocol::SENSES_POWER) that; else empty.
    /// [`receptions`](Self::receptions) has both together.
    pub powers: Vec<f32>,
    /// What became of frames of its own since it last woke, in order of time; empty unless its protocol
    /// [heeds](super::Protocol::HEEDS_OUTCOMES) that.
    pub outcomes: Vec<Concluded>,
    /// Where it is and which way it faces: metres from the arena's centre, radians.
    pub pose: Pose,
    /// Near bodies at a control step (robots, walls, obstacles, within the proximity range): the vector from this
    /// robot's edge to the nearest point of each, in the arena's axes, metres.
    pub proximity: Vec<Vec2>,
    /// Randomness for this wake alone, whatever was drawn before: the draws of a robot's n-th wake are the same in each run of a trial. The
    /// traits of the crate `rand` draw from it.
    pub random: Philox,
}

impl<M> Input<M> {
    /// The frames of the inbox, each with the power with which it arrived, dBm, if the radio knows powers.
    pub fn receptions(&self) -> impl Iterator<Item = (&Reception<M>, Option<f32>)> {
        let powers = self.powers.iter().copied().map(Some).chain(std::iter::repeat(None));
        self.inbox.iter().zip(powers)
    }
}

/// A frame of its own that its radio is done with, as a robot learns of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Concluded {
    /// The number of its first message among those that the robot has sent, from 0; `None` if its radio could not send at all, and no number was taken.
    pub sequence: Option<u32>,
    /// How many messages were in it.
    pub messages: u32,
    /// How it ended.
    pub outcome: Outcome,
}

/// A message as its receivers get it: decoded once, for its bytes are the same at every receiver, and then copied into each
/// inbox, so that reading an inbox is reading one stretch of memory.
#[derive(Clone, Debug)]
pub struct Frame<M> {
    /// Who sent it (the frame's header carries it).
    pub sender: ActorId,
    /// Its number among the sender's messages, which is that of its frame where each has one of its own.
    pub sequence: u32,
    /// When it was sent, by its sender's clock.
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
    /// Another robot: the reader overhears it ([`Protocol::OVERHEARS`](super::Protocol::OVERHEARS)).
    Another,
}

/// A frame that reached this robot.
#[derive(Debug)]
pub struct Reception<M> {
    /// When it arrived, by this robot's clock.
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
