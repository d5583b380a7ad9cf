//! When a robot believes that a neighbour is down: the failure detector that every protocol runs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::row_index::RowIndex;
use super::{Note, Output, Reception, TimerId};
use crate::engine::{ActorId, SimTime, Span};
use crate::quantity::Positive;

/// The failure detector that robots run on each other's status.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DetectorConfig {
    /// A neighbour not heard for this many seconds is declared inactive (paper section 4.3).
    Timeout(Positive),
}

impl Default for DetectorConfig {
    fn default() -> Self {
        Self::Timeout(Positive::new(4.0))
    }
}

impl DetectorConfig {
    /// The longest silence after which a neighbour that was trusted is suspected.
    #[must_use]
    pub fn longest_silence(&self) -> Span {
        let Self::Timeout(timeout) = self;
        Span::from_secs(timeout.get())
    }
}

/// One robot's failure detector.
///
/// A robot shows it every status that it reads ([`hear`](Self::hear)) and passes on its timer ([`expire`](Self::expire));
/// the detector notes whom it watches, suspects and trusts. A suspicion is exact in time: it falls due at the last
/// arrival plus the timeout, between control steps too. Trust comes back when the robot reads what has arrived.
#[derive(Debug)]
pub struct Detector {
    timeout: Span,
    /// Neighbours ever heard, a row each.
    rows: Vec<Row>,
    index: RowIndex,
    /// When the timer fires: never later than the earliest timeout. It is checked then and set again, so that an arrival
    /// costs a store and not a timer.
    armed: SimTime,
}

#[derive(Debug)]
struct Row {
    id: ActorId,
    /// The newest of its frames that arrived.
    sequence: u32,
    /// When the last status arrived.
    heard: SimTime,
    suspected: bool,
}

impl Detector {
    /// The one timer that it sets: a protocol that runs a detector keeps it free.
    pub const TIMER: TimerId = TimerId(0);

    /// A detector that has heard nobody yet.
    #[must_use]
    pub fn new(config: &DetectorConfig) -> Self {
        Self {
            timeout: config.longest_silence(),
            rows: Vec::new(),
            index: RowIndex::default(),
            armed: SimTime::NEVER,
        }
    }

    /// Takes in a status; receptions come in order of arrival.
    #[inline]
    pub fn hear<M>(&mut self, status: &Reception<M>, output: &mut Output<M>) {
        let Some(row) = self.index.get(status.frame.sender) else {
            self.watch(status, output);
            return;
        };
        let row = &mut self.rows[row];
        row.heard = status.at;
        if status.frame.sequence.wrapping_sub(row.sequence).cast_signed() > 0 {
            row.sequence = status.frame.sequence;
        }
        if row.suspected {
            row.suspected = false;
            output.notes.push(Note::Trusts(row.id));
            self.arm(status.at + self.timeout, output);
        }
    }

    /// Takes in the first status of a robot.
    fn watch<M>(&mut self, status: &Reception<M>, output: &mut Output<M>) {
        let id = status.frame.sender;
        self.index.set(id, self.rows.len());
        self.rows.push(Row {
            id,
            sequence: status.frame.sequence,
            heard: status.at,
            suspected: false,
        });
        output.notes.push(Note::Watches(id));
        self.arm(status.at + self.timeout, output);
    }

    /// Its timer fired, and the robot has read all that arrived: suspects those whose time has run out.
    pub fn expire<M>(&mut self, now: SimTime, output: &mut Output<M>) {
        self.armed = SimTime::NEVER;
        let mut next = SimTime::NEVER;
        for row in self.rows.iter_mut().filter(|row| !row.suspected) {
            let due = row.heard + self.timeout;
            if due <= now {
                row.suspected = true;
                output.notes.push(Note::Suspects {
                    robot: row.id,
                    heard: row.heard,
                    sequence: row.sequence,
                });
            } else {
                next = next.min(due);
            }
        }
        if next < SimTime::NEVER {
            self.arm(next, output);
        }
    }

    /// Whether it believes that `robot` is down. Of a robot that it never heard it believes nothing.
    #[must_use]
    pub fn suspects(&self, robot: ActorId) -> bool {
        self.index.get(robot).is_some_and(|row| self.rows[row].suspected)
    }

    /// Whether it came to believe so before `now`: what falls due at the very instant of a control step counts from the
    /// next one on, so that a status of exactly that age is not yet too old.
    #[must_use]
    pub fn suspected_before(&self, now: SimTime, robot: ActorId) -> bool {
        let row = self.index.get(robot).map(|row| &self.rows[row]);
        row.is_some_and(|row| row.suspected && row.heard + self.timeout < now)
    }

    fn arm<M>(&mut self, due: SimTime, output: &mut Output<M>) {
        if due < self.armed {
            self.armed = due;
            output.timers.push((Self::TIMER, Some(due)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::Frame;

    const TIMEOUT_S: f64 = 2.5;

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs(seconds)
    }

    fn detector() -> Detector {
        Detector::new(&DetectorConfig::Timeout(Positive::new(TIMEOUT_S)))
    }

    fn status(sender: u32, sequence: u32, arrival_s: f64) -> Reception<()> {
        Reception {
            at: at(arrival_s),
            frame: Frame {
                sender: ActorId(sender),
                sequence,
                sent_at: SimTime::ZERO,
                payload_bytes: 4,
                message: (),
            },
            displacement: [0.0; 2],
        }
    }

    /// What the detector answers to `act`: its notes, and when it wants to be woken.
    fn answer(
        detector: &mut Detector,
        act: impl FnOnce(&mut Detector, &mut Output<()>),
    ) -> (Vec<Note>, Option<SimTime>) {
        let mut output = Output::default();
        act(detector, &mut output);
        (output.notes, output.timers.last().and_then(|timer| timer.1))
    }

    fn suspicion(robot: u32, heard_s: f64, sequence: u32) -> Note {
        Note::Suspects {
            robot: ActorId(robot),
            heard: at(heard_s),
            sequence,
        }
    }

    #[test]
    fn a_robot_is_watched_from_its_first_status_and_suspected_exactly_a_timeout_after_its_last() {
        let mut detector = detector();
        let first = answer(&mut detector, |d, out| d.hear(&status(3, 0, 1.0), out));
        assert_eq!(first, (vec![Note::Watches(ActorId(3))], Some(at(3.5))));
        let second = answer(&mut detector, |d, out| d.hear(&status(3, 1, 1.75), out));
        assert_eq!(second, (vec![], None), "a later arrival does not move the timer");
        assert_eq!(
            answer(&mut detector, |d, out| d.expire(at(3.5), out)),
            (vec![], Some(at(4.25)))
        );
        assert!(!detector.suspects(ActorId(3)));
        let expired = answer(&mut detector, |d, out| d.expire(at(4.25), out));
        assert_eq!(expired, (vec![suspicion(3, 1.75, 1)], None));
        assert!(detector.suspects(ActorId(3)) && !detector.suspects(ActorId(4)));
        assert!(!detector.suspected_before(at(4.25), ActorId(3)) && detector.suspected_before(at(4.26), ActorId(3)));
    }

    #[test]
    fn a_suspected_robot_is_trusted_at_its_next_status_and_watched_anew() {
        let mut detector = detector();
        answer(&mut detector, |d, out| d.hear(&status(3, 0, 1.0), out));
        answer(&mut detector, |d, out| d.expire(at(3.5), out));
        let again = answer(&mut detector, |d, out| d.hear(&status(3, 7, 5.0), out));
        assert_eq!(again, (vec![Note::Trusts(ActorId(3))], Some(at(7.5))));
        assert!(!detector.suspects(ActorId(3)));
    }

    #[test]
    fn a_status_overtaken_on_the_way_is_a_sign_of_life_and_not_the_newest() {
        let mut detector = detector();
        for (sequence, arrival) in [(0, 1.0), (2, 1.2), (1, 1.3)] {
            answer(&mut detector, |d, out| d.hear(&status(3, sequence, arrival), out));
        }
        answer(&mut detector, |d, out| d.expire(at(3.5), out));
        let expired = answer(&mut detector, |d, out| d.expire(at(3.8), out));
        assert_eq!(expired, (vec![suspicion(3, 1.3, 2)], None));
    }
}
