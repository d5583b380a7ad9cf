//! Detectors that listen: each status puts off the instant at which its sender is suspected, and a rule says to when.

use std::borrow::Borrow;

use super::{Monitored, Sign, TIMER};
use crate::engine::{ActorId, SimTime};
use crate::protocol::robot_table::{RobotRow, RobotTable};
use crate::protocol::{Evidence, Note, Output, Reception};

/// When silence becomes suspicious.
pub trait Rule {
    /// What it keeps of each robot beside the last arrival.
    type State;
    /// Whether a status can bring the suspicion forward that an earlier one had put off.
    const HASTENS: bool = false;

    /// Takes in the first status of a robot.
    fn first<M>(&self, status: &Reception<M>) -> Self::State;

    /// Takes in another one, of a robot that was last heard as `row` says.
    fn next<M>(&self, row: &mut Row<Self::State>, status: &Reception<M>);

    /// The instant from which on the robot is suspected, if no further status arrives.
    fn due(&self, row: &Row<Self::State>) -> SimTime;
}

/// Robots watched by one rule.
///
/// A suspicion is exact in time: it falls due between control steps too. Trust comes back when the robot reads what has
/// arrived.
#[derive(Debug)]
pub struct Watch<R: Rule> {
    rule: R,
    /// Robots ever heard.
    rows: RobotTable<Row<R::State>>,
    /// When the timer fires: never later than the earliest suspicion. It is checked then and set again, so that an arrival
    /// costs a store and not a timer.
    armed: SimTime,
}

/// What is known of a robot.
#[derive(Debug)]
pub struct Row<S> {
    id: ActorId,
    /// The newest of its frames that arrived.
    sequence: u32,
    heard: LastHeard,
    /// What the rule keeps of it.
    pub state: S,
}

/// When a robot was last heard, and whether it has come to be suspected since. One word: what an arrival costs in a large
/// swarm is the memory that it has to wait for.
#[derive(Clone, Copy, Debug)]
struct LastHeard(u64);

impl LastHeard {
    /// The bit that no instant of a run reaches, 292 years from its start.
    const SUSPECTED: u64 = 1 << 63;

    fn at(at: SimTime) -> Self {
        Self(at.as_nanos() & !Self::SUSPECTED)
    }

    fn instant(self) -> SimTime {
        SimTime::from_nanos(self.0 & !Self::SUSPECTED)
    }

    fn is_suspected(self) -> bool {
        self.0 & Self::SUSPECTED != 0
    }

    fn suspect(&mut self) {
        self.0 |= Self::SUSPECTED;
    }
}

impl<S> RobotRow for Row<S> {
    #[inline]
    fn robot(&self) -> ActorId {
        self.id
    }
}

impl<S> Row<S> {
    /// When the last status arrived.
    #[inline]
    #[must_use]
    pub fn heard(&self) -> SimTime {
        self.heard.instant()
    }
}

impl<R: Rule> Watch<R> {
    /// Nobody was heard yet.
    pub fn new(rule: R) -> Self {
        Self {
            rule,
            rows: RobotTable::default(),
            armed: SimTime::NEVER,
        }
    }

    /// Asks for its memory.
    #[inline]
    pub fn prefetch(&self) {
        self.rows.prefetch();
    }

    /// Takes in the statuses in `inbox`, which are in order of arrival.
    #[inline]
    pub fn read<H: Borrow<M>, M: Monitored>(&mut self, inbox: &[Reception<H>], output: &mut Output<M>) {
        for reception in inbox {
            if matches!(reception.frame.message.borrow().sign(), Sign::Status) {
                self.hear(reception, output);
            }
        }
    }

    #[inline]
    fn hear<H, M>(&mut self, status: &Reception<H>, output: &mut Output<M>) {
        let Some(row) = self.rows.get_mut(status.frame.sender) else {
            self.watch(status, output);
            return;
        };
        self.rule.next(row, status);
        let was_suspected = row.heard.is_suspected();
        row.heard = LastHeard::at(status.at);
        if status.frame.sequence.wrapping_sub(row.sequence).cast_signed() > 0 {
            row.sequence = status.frame.sequence;
        }
        if was_suspected {
            let due = self.rule.due(row);
            if due <= status.at {
                row.heard.suspect();
            } else {
                output.notes.push(Note::Trusts(row.id));
                self.arm(due, output);
            }
        } else if R::HASTENS {
            let due = self.rule.due(row);
            self.arm(due, output);
        }
    }

    /// Takes in the first status of a robot.
    fn watch<H, M>(&mut self, status: &Reception<H>, output: &mut Output<M>) {
        let id = status.frame.sender;
        let row = Row {
            id,
            sequence: status.frame.sequence,
            heard: LastHeard::at(status.at),
            state: self.rule.first(status),
        };
        let due = self.rule.due(&row);
        self.rows.add(row);
        output.notes.push(Note::Watches(id));
        self.arm(due, output);
    }

    /// The timer fired, and the robot has read all that arrived: suspects those whose time has run out.
    pub fn expire<M>(&mut self, now: SimTime, output: &mut Output<M>) {
        self.armed = SimTime::NEVER;
        let mut next = SimTime::NEVER;
        for row in self.rows.iter_mut().filter(|row| !row.heard.is_suspected()) {
            let due = self.rule.due(row);
            if due <= now {
                row.heard.suspect();
                output.notes.push(Note::Suspects {
                    robot: row.id,
                    heard: row.heard(),
                    sequence: row.sequence,
                    evidence: Evidence::Silence,
                });
            } else {
                next = next.min(due);
            }
        }
        if next < SimTime::NEVER {
            self.arm(next, output);
        }
    }

    /// When `robot` came to be suspected; `NEVER` if it is not.
    pub fn suspected_since(&self, robot: ActorId) -> SimTime {
        let row = self.rows.get(robot);
        row.filter(|row| row.heard.is_suspected())
            .map_or(SimTime::NEVER, |row| self.rule.due(row))
    }

    fn arm<M>(&mut self, due: SimTime, output: &mut Output<M>) {
        if due < self.armed {
            self.armed = due;
            output.timers.push((TIMER, Some(due)));
        }
    }
}
