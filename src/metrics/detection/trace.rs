//! One robot's statuses followed one by one: who asks why it was suspected runs the trial again with this.

use crate::engine::{ActorId, SimTime};
use crate::happenings::{self, Sent, Vocabulary, Watch};
use crate::motion::World;
use crate::protocol::Topic;
use crate::radio::LossCause;

/// Every status of one robot and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct StatusTrace {
    /// The robot.
    pub robot: ActorId,
    /// The topic of statuses, once the run has begun.
    topic: Option<Topic>,
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
    /// Nothing sent yet by `robot`.
    #[must_use]
    pub fn new(robot: ActorId) -> Self {
        Self {
            robot,
            topic: None,
            statuses: Vec::new(),
        }
    }

    #[inline]
    fn follows(&self, copy: &happenings::Copy) -> bool {
        copy.sender == self.robot && Some(copy.topic) == self.topic
    }

    fn fate(&mut self, sequence: u32, receiver: ActorId, fate: CopyFate) {
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

    fn read(&mut self, sequence: u32, receiver: ActorId, read: Option<SimTime>) {
        let Some(status) = self.status(sequence) else { return };
        if let Some(copy) = status.copies.iter_mut().find(|copy| copy.receiver == receiver) {
            copy.read = read;
        }
    }

    fn status(&mut self, sequence: u32) -> Option<&mut Status> {
        self.statuses
            .iter_mut()
            .rev()
            .find(|status| status.sequence == sequence)
    }
}

impl Watch for StatusTrace {
    fn begin(&mut self, vocabulary: &Vocabulary, _: &World) {
        self.topic = vocabulary.status;
    }

    fn sent(&mut self, message: &Sent<'_>) {
        if message.sender == self.robot && Some(message.topic) == self.topic {
            self.statuses.push(Status {
                sequence: message.sequence,
                sent_at: message.at,
                distances: Vec::new(),
                copies: Vec::new(),
            });
        }
    }

    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
        if robot != self.robot {
            return;
        }
        if let Some(status) = self.statuses.last_mut().filter(|status| status.sent_at == now) {
            let here = world.position(robot, now);
            let distance = |other| (world.position(ActorId(other), now) - here).norm() as f32;
            status.distances = (0..world.positions().len() as u32).map(distance).collect();
        }
    }

    fn arrives(&mut self, copy: &happenings::Copy, at: SimTime) {
        if self.follows(copy) {
            self.fate(copy.sequence, copy.receiver, CopyFate::Arrives(at));
        }
    }

    fn lost(&mut self, copy: &happenings::Copy, cause: LossCause, _: SimTime) {
        if self.follows(copy) {
            self.fate(copy.sequence, copy.receiver, CopyFate::Lost(cause));
        }
    }

    fn delivered(&mut self, copy: &happenings::Copy, _: SimTime, read: Option<SimTime>) {
        if self.follows(copy) {
            self.read(copy.sequence, copy.receiver, read);
        }
    }
}
