//! What a shared radio has to do, in order of time.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::burst::BurstId;
use crate::engine::SimTime;

/// One thing to do. At one instant what ends comes before what begins, and that before those who listen whether anything is on air; of equals, the
/// robot with the lower number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Task {
    /// A burst ends.
    End(BurstId),
    /// A robot's battery is looked at.
    Battery(u32),
    /// A jammer is on.
    Jam(u32),
    /// A robot that has lost the power to send gives up what it still has to send, a frame at a time.
    Flush(u32),
    /// A robot begins to send: the head of its queue, unless it has thought better of it since (its stamp is another by now).
    Begin(u32, Stamp),
    /// A robot answers a frame to it alone.
    Acknowledge(u32, BurstId),
    /// Medium access of a robot goes on, unless it has been told otherwise since.
    Access(u32, Stamp),
    /// A robot waits no longer for an acknowledgement, unless it came.
    Timeout(u32, Stamp),
}

/// Tells a robot's present plan from those that it has dropped.
pub(super) type Stamp = u32;

/// All of it.
#[derive(Debug, Default)]
pub(super) struct Agenda(BinaryHeap<Reverse<(SimTime, Task)>>);

impl Agenda {
    /// Puts `task` down for `at`.
    pub fn add(&mut self, at: SimTime, task: Task) {
        self.0.push(Reverse((at, task)));
    }

    /// When the next is due; `NEVER` if there is none.
    pub fn next(&self) -> SimTime {
        self.0.peek().map_or(SimTime::NEVER, |Reverse((at, _))| *at)
    }

    /// Takes the next.
    pub fn take(&mut self) -> Option<Task> {
        self.0.pop().map(|Reverse((_, task))| task)
    }
}
