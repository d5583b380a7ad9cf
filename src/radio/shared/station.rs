//! A robot's radio: what waits to be sent, and what it is doing.

use std::collections::VecDeque;

use super::agenda::Stamp;
use super::burst::BurstId;
use crate::engine::{ActorId, SimTime, Span};
use crate::radio::{FrameId, LossCause};

/// One robot's.
#[derive(Debug)]
pub(super) struct Radio {
    /// Frames to be sent; the first is being sent, or on its way to the medium.
    pub queue: VecDeque<Queued>,
    pub doing: Doing,
    /// Its present plan: what the agenda holds with another stamp has lost its meaning.
    pub stamp: Stamp,
    /// Until when it answers a frame.
    pub answers_until: SimTime,
    /// Whether it can send.
    pub sends: bool,
    /// Since when it can hear; `NEVER` if it cannot.
    pub hears_from: SimTime,
    /// Bursts that it has begun: those that were cut short too.
    pub bursts: u32,
}

/// What a radio is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doing {
    /// Nothing is planned.
    Rests,
    /// It is stepped when its medium access says so.
    Contends,
    /// It is about to send.
    Turns,
    /// It sends.
    Sends(BurstId),
    /// It waits for an acknowledgement of this burst.
    Waits(BurstId),
}

/// A frame that a robot has to send.
#[derive(Debug)]
pub(super) struct Queued {
    pub frame: FrameId,
    /// The one robot that it is for, if it is.
    pub to: Option<ActorId>,
    pub payload: u32,
    pub airtime: Span,
    /// When it was handed over.
    pub at: SimTime,
    /// How often it was sent before.
    pub attempt: u32,
    /// When it first went on air.
    pub began: Option<SimTime>,
    /// Who has not got it yet, and why not.
    pub open: Vec<(ActorId, LossCause)>,
    /// Whether the one robot that it is for has got it.
    pub arrived: bool,
}

impl Default for Radio {
    fn default() -> Self {
        Self {
            queue: VecDeque::new(),
            doing: Doing::Rests,
            stamp: 0,
            answers_until: SimTime::ZERO,
            sends: true,
            hears_from: SimTime::ZERO,
            bursts: 0,
        }
    }
}

impl Radio {
    /// Makes a new plan: what was planned before does not happen.
    pub fn replan(&mut self, doing: Doing) -> Stamp {
        self.doing = doing;
        self.stamp = self.stamp.wrapping_add(1);
        self.stamp
    }
}
