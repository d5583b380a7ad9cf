//! A robot's radio: what waits to be sent, and what it is doing.

use std::collections::VecDeque;

use super::agenda::Stamp;
use super::burst::BurstId;
use crate::engine::{ActorId, SimTime, Span};
use crate::radio::{FrameId, LossCause, Reading};

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
    /// How long it has been sending, what is on air now to its end.
    pub sent: Span,
    /// How long it has been turning from hearing to sending and back.
    pub turned: Span,
    /// How long it was switched off, neither sending nor hearing, and since when it is; `NEVER` if it is on.
    pub off: Span,
    pub off_since: SimTime,
    /// When its battery was empty; `NEVER` if it is not.
    pub empty_at: SimTime,
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
    /// When it was handed over, and when there was nothing left before it.
    pub handed_over: SimTime,
    pub at_head: SimTime,
    /// How often it was sent before.
    pub attempt: u32,
    /// When it first went on air.
    pub began: Option<SimTime>,
    /// Who has not got it yet.
    pub open: Vec<Open>,
    /// Whether the one robot that it is for has got it.
    pub arrived: bool,
}

/// A copy that has not arrived.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub receiver: ActorId,
    /// Why it has not, as far as that is known.
    pub cause: LossCause,
    /// How far away and how strong its sender was when it was last sent, or how far away when it was handed over: metres, dBm.
    pub distance: f32,
    pub power: f32,
}

impl Open {
    pub fn new(receiver: ActorId, distance: f64) -> Self {
        Self {
            receiver,
            cause: LossCause::BelowSensitivity,
            distance: distance as f32,
            power: f32::NEG_INFINITY,
        }
    }

    pub fn reading(&self, received: bool) -> Reading {
        Reading {
            receiver: self.receiver,
            distance: self.distance,
            power: self.power,
            received,
        }
    }
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
            sent: Span::ZERO,
            turned: Span::ZERO,
            off: Span::ZERO,
            off_since: SimTime::NEVER,
            empty_at: SimTime::NEVER,
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
