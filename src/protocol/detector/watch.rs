//! Detectors that listen: each status puts off the instant at which its sender is suspected, and a rule says to when.

use super::{Monitored, Sign, TIMER};
use crate::engine::{ActorId, SimTime};
use crate::protocol::row_index::RowIndex;
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
    /// Robots ever heard, a row each.
    rows: Vec<Row<R::State>>,
    index: RowIndex,
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
    /// When the last status arrived.
    pub heard: SimTime,
    suspected: bool,
    /// What the rule keeps of it.
    pub state: S,
}

impl<R: Rule> Watch<R> {
    /// Nobody was heard yet.
    pub fn new(rule: R) -> Self {
        Self {
            rule,
            rows: Vec::new(),
            index: RowIndex::default(),
            armed: SimTime::NEVER,
        }
    }

    /// Takes in the statuses in `inbox`, which are in order of arrival.
    #[inline]
    pub fn read<M: Monitored>(&mut self, inbox: &[Reception<M>], output: &mut Output<M>) {
        for reception in inbox {
            if matches!(reception.frame.message.sign(), Sign::Status) {
                self.hear(reception, output);
            }
        }
    }

    #[inline]
    fn hear<M>(&mut self, status: &Reception<M>, output: &mut Output<M>) {
        let Some(row) = self.index.get(status.frame.sender) else {
            self.watch(status, output);
            return;
        };
        let row = &mut self.rows[row];
        self.rule.next(row, status);
        row.heard = status.at;
        if status.frame.sequence.wrapping_sub(row.sequence).cast_signed() > 0 {
            row.sequence = status.frame.sequence;
        }
        if row.suspected {
            let due = self.rule.due(row);
            if due > status.at {
                row.suspected = false;
                output.notes.push(Note::Trusts(row.id));
                self.arm(due, output);
            }
        } else if R::HASTENS {
            let due = self.rule.due(row);
            self.arm(due, output);
        }
    }

    /// Takes in the first status of a robot.
    fn watch<M>(&mut self, status: &Reception<M>, output: &mut Output<M>) {
        let id = status.frame.sender;
        let row = Row {
            id,
            sequence: status.frame.sequence,
            heard: status.at,
            suspected: false,
            state: self.rule.first(status),
        };
        let due = self.rule.due(&row);
        self.index.set(id, self.rows.len());
        self.rows.push(row);
        output.notes.push(Note::Watches(id));
        self.arm(due, output);
    }

    /// The timer fired, and the robot has read all that arrived: suspects those whose time has run out.
    pub fn expire<M>(&mut self, now: SimTime, output: &mut Output<M>) {
        self.armed = SimTime::NEVER;
        let mut next = SimTime::NEVER;
        for row in self.rows.iter_mut().filter(|row| !row.suspected) {
            let due = self.rule.due(row);
            if due <= now {
                row.suspected = true;
                output.notes.push(Note::Suspects {
                    robot: row.id,
                    heard: row.heard,
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
        let row = self.index.get(robot).map(|row| &self.rows[row]);
        row.filter(|row| row.suspected)
            .map_or(SimTime::NEVER, |row| self.rule.due(row))
    }

    fn arm<M>(&mut self, due: SimTime, output: &mut Output<M>) {
        if due < self.armed {
            self.armed = due;
            output.timers.push((TIMER, Some(due)));
        }
    }
}
