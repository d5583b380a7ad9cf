//! Medium access: when a robot that has something to send does.
//!
//! Every scheme is a [`Scheme`]: a state machine for each robot that is stepped when there is something to send and whenever it asked to be, looks at
//! what the robot's [`Ear`] takes up, and answers with a [`Step`]. What the medium does is the same for all: queues, bursts, receptions,
//! acknowledgements.

mod aloha;
mod build;
mod config;
mod csma_ca;
mod dcf;
mod paced;
mod tdma;

pub use config::{AccessConfig, CsmaCaConfig, DcfConfig, PacedConfig};

use super::burst::{Burst, Bursts};
use super::ear::Ear;
use super::receiver::Receiver;
use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::radio::LossCause;

/// What a robot does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing, until a frame comes.
    Rest,
    /// It is to be stepped again then.
    Wait(SimTime),
    /// It begins to send then, and is deaf until it has.
    Send(SimTime),
    /// It gives up the frame.
    GiveUp(LossCause),
}

/// How the sending of a frame ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It is through, and nothing more is known.
    Sent,
    /// It was acknowledged.
    Acknowledged,
    /// It was to be acknowledged, and was not in time.
    Unanswered,
}

/// What follows a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// The same frame again, and the robot is stepped for it then.
    Again(SimTime),
    /// It is done with, and the robot is stepped then, whether it has another or not.
    Done(SimTime),
}

/// When acknowledgements come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Answering {
    /// From the end of a frame to the beginning of its acknowledgement.
    pub after: Span,
    /// From the end of a frame until its sender gives up waiting.
    pub patience: Span,
}

/// A way to the medium, for all robots of a run.
pub(super) trait Scheme: Send {
    /// A frame is at the head of the robot's queue and nothing was under way; or the robot is stepped as it asked to be, perhaps with an empty queue.
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step;

    /// The head of the queue was sent.
    fn after(&mut self, now: SimTime, outcome: Outcome, station: &mut Station<'_>) -> Next;

    /// Whether rules keep the robot from sending now, whatever is on air: what finds no room then is lost to them.
    fn restrained(&self, now: SimTime, robot: ActorId) -> bool {
        let _ = (now, robot);
        false
    }

    /// The robot's radio was switched off and on, or lost what it had.
    fn reset(&mut self, robot: ActorId);

    /// When frames to one robot are acknowledged, if they are.
    fn answering(&self) -> Option<Answering> {
        None
    }

    /// From listening to sending and back, deaf all the while.
    fn turnaround(&self) -> Span {
        Span::ZERO
    }

    /// No frame begins earlier than so long after it was handed over.
    fn least_delay(&self) -> Span {
        Span::ZERO
    }

    /// How far back it looks into an ear.
    fn memory(&self) -> Span {
        Span::ZERO
    }
}

/// A robot at the medium, as its scheme sees it.
pub(super) struct Station<'a> {
    /// Who.
    pub robot: ActorId,
    /// The frame at the head of its queue.
    pub head: Option<Head>,
    /// Whether it is about to acknowledge a frame, or does.
    pub answers: bool,
    /// What reaches it.
    pub ear: &'a mut Ear,
    /// What is on air.
    pub bursts: &'a Bursts,
    /// What it makes of that.
    pub receiver: &'a Receiver,
    /// By how much its clock is fast, as a share.
    pub skew: f64,
    /// Its random numbers.
    pub draws: &'a mut Draws,
}

/// What a scheme knows of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Head {
    /// How often it was sent before.
    pub attempt: u32,
    /// How long it is on air.
    pub airtime: Span,
}

impl Station<'_> {
    /// A random number in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.draws.uniform(self.robot)
    }

    /// Whether it understood a burst that has ended, which stands at `place` in its ear; `None` if it did not even notice that there was a frame.
    pub fn understands(&mut self, place: usize, burst: &Burst) -> Option<bool> {
        let heard = self.ear.at(place);
        if heard.is_noise || !self.receiver.detects(self.ear, heard) {
            return None;
        }
        let waveform = self.receiver.waveform(burst);
        let verdict = self.receiver.judge(self.ear, place, (burst, &waveform), self.robot);
        Some(verdict.is_ok())
    }

    /// A random number of 0 to `most`.
    pub fn count(&mut self, most: u32) -> u32 {
        ((f64::from(most) + 1.0) * self.uniform()) as u32
    }
}

/// The random numbers of medium access: each robot has its own, one after another.
#[derive(Debug)]
pub(super) struct Draws {
    streams: KeyedStreams,
    drawn: Vec<u32>,
}

impl Draws {
    pub fn new(streams: Streams, robots: usize) -> Self {
        Self {
            streams: streams.keyed(Purpose::new("radio.access")),
            drawn: vec![0; robots],
        }
    }

    fn uniform(&mut self, robot: ActorId) -> f64 {
        let drawn = &mut self.drawn[robot.index()];
        let [bits, _] = self.streams.first_two(robot.0, 0, *drawn);
        *drawn = drawn.wrapping_add(1);
        crate::radio::draw::unit_interval(bits)
    }
}
