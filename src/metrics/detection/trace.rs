//! One robot's statuses followed one by one: who asks why it was suspected runs the trial again with this.

use crate::engine::{ActorId, SimTime};
use crate::radio::LossCause;

/// Every status of one robot and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct StatusTrace {
    /// The robot.
    pub robot: ActorId,
    /// Its statuses, in the order in which it sent them.
    pub statuses: Vec<Status>,
}

/// A status.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Its number among the robot's frames.
    pub sequence: u32,
    /// When it was sent.
    pub sent_at: SimTime,
    /// How far each robot was then, metres, in order of ids.
    pub distances: Vec<f32>,
    /// Its copies, one for each robot in range.
    pub copies: Vec<Copy>,
}

/// A copy of a status.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Copy {
    /// For whom.
    pub receiver: ActorId,
    /// What became of it in the end.
    pub fate: CopyFate,
    /// When it arrived or was to arrive, heard or not; `None` if it was lost on its way.
    pub due: Option<SimTime>,
    /// When its receiver read it.
    pub read: Option<SimTime>,
}

/// What became of a copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CopyFate {
    /// It arrived then, or will.
    Arrives(SimTime),
    /// It was lost.
    Lost(LossCause),
}

impl Status {
    /// The copy for `receiver`, if that was in range.
    #[must_use]
    pub fn copy_for(&self, receiver: ActorId) -> Option<&Copy> {
        self.copies.iter().find(|copy| copy.receiver == receiver)
    }
}

impl StatusTrace {
    /// Nothing sent yet.
    pub(in crate::metrics) fn new(robot: ActorId) -> Self {
        Self {
            robot,
            statuses: Vec::new(),
        }
    }

    /// The robot sends a status.
    pub(in crate::metrics) fn sent(&mut self, now: SimTime, sequence: u32) {
        self.statuses.push(Status {
            sequence,
            sent_at: now,
            distances: Vec::new(),
            copies: Vec::new(),
        });
    }

    /// How far everybody is at `now`, when the robot may just have sent a status.
    pub fn distances(&mut self, now: SimTime, distances: Vec<f32>) {
        if let Some(status) = self.statuses.last_mut().filter(|status| status.sent_at == now) {
            status.distances = distances;
        }
    }

    /// A copy meets its fate; one that was to arrive may still be lost at its receiver.
    pub fn fate(&mut self, sequence: u32, receiver: ActorId, fate: CopyFate) {
        let Some(status) = self.status(sequence) else { return };
        match status.copies.iter_mut().find(|copy| copy.receiver == receiver) {
            Some(copy) => copy.fate = fate,
            None => status.copies.push(Copy {
                receiver,
                fate,
                due: match fate {
                    CopyFate::Arrives(at) => Some(at),
                    CopyFate::Lost(_) => None,
                },
                read: None,
            }),
        }
    }

    /// `receiver` reads its copy.
    pub fn read(&mut self, now: SimTime, sequence: u32, receiver: ActorId) {
        let Some(status) = self.status(sequence) else { return };
        if let Some(copy) = status.copies.iter_mut().find(|copy| copy.receiver == receiver) {
            copy.read = Some(now);
        }
    }

    fn status(&mut self, sequence: u32) -> Option<&mut Status> {
        self.statuses
            .iter_mut()
            .rev()
            .find(|status| status.sequence == sequence)
    }
}
