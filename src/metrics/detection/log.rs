//! What became of the statuses of late: kept so that a suspicion can be traced to them, and no longer.

use crate::engine::{ActorId, SimTime, Span};
use crate::protocol::Reception;
use crate::radio::LossCause;

use super::record::Missed;

/// Statuses sent and copies of them lost, for the last while. What is delivered leaves no trace here: that is by far the
/// most, and a status that was sent, not lost and is not under way was either read or out of range.
#[derive(Debug)]
pub struct StatusLog {
    memory: Span,
    turn_at: SimTime,
    sent: Vec<Generations<Sent>>,
    lost: Vec<Generations<Lost>>,
}

/// Entries of the present stretch of time and of the one before: old ones go all together, and a push is a push.
#[derive(Debug)]
struct Generations<T> {
    old: Vec<T>,
    new: Vec<T>,
}

#[derive(Debug)]
struct Sent {
    sequence: u32,
    at: SimTime,
}

/// A lost copy, at its sender: what one frame loses lies together in memory.
#[derive(Debug)]
struct Lost {
    receiver: u32,
    sequence: u32,
    cause: LossCause,
}

impl<T> Generations<T> {
    fn new(robots: usize) -> Vec<Self> {
        let none = || Self {
            old: Vec::new(),
            new: Vec::new(),
        };
        std::iter::repeat_with(none).take(robots).collect()
    }

    fn turn(&mut self) {
        std::mem::swap(&mut self.old, &mut self.new);
        self.new.clear();
    }

    fn iter(&self) -> impl Iterator<Item = &T> {
        self.old.iter().chain(&self.new)
    }
}

impl StatusLog {
    /// An empty log that reaches back at least `memory`.
    pub fn new(robots: usize, memory: Span) -> Self {
        Self {
            memory,
            turn_at: SimTime::ZERO + memory,
            sent: Generations::new(robots),
            lost: Generations::new(robots),
        }
    }

    /// `sender` sends a status, its frame number `sequence`.
    pub fn sent(&mut self, now: SimTime, sender: ActorId, sequence: u32) {
        if now >= self.turn_at {
            self.turn_at = now + self.memory;
            self.sent.iter_mut().for_each(Generations::turn);
            self.lost.iter_mut().for_each(Generations::turn);
        }
        self.sent[sender.index()].new.push(Sent { sequence, at: now });
    }

    /// The copy of a status that was meant for `receiver` is lost.
    #[inline]
    pub fn lost(&mut self, receiver: ActorId, sender: ActorId, sequence: u32, cause: LossCause) {
        self.lost[sender.index()].new.push(Lost {
            receiver: receiver.0,
            sequence,
            cause,
        });
    }

    /// What became at `observer`, until `now`, of the statuses that `subject` sent after its frame number `sequence` and
    /// before `now`, with `waiting` under way to the observer. Whoever sends at this very instant does not count: whether
    /// it did so before the observer or after it is an accident.
    pub fn missed<M>(
        &self,
        now: SimTime,
        [observer, subject]: [ActorId; 2],
        sequence: u32,
        waiting: &[Reception<M>],
    ) -> Missed {
        let is_newer = |status: u32| status.wrapping_sub(sequence).cast_signed() > 0;
        let sent = self.sent[subject.index()].iter();
        let (mut missed, mut total, mut last) = (Missed::default(), 0, sequence);
        for status in sent.filter(|status| is_newer(status.sequence) && status.at < now) {
            total += 1;
            last = status.sequence;
        }
        let counts = |status: u32| is_newer(status) && last.wrapping_sub(status).cast_signed() >= 0;
        let lost = self.lost[subject.index()].iter();
        for copy in lost.filter(|copy| copy.receiver == observer.0 && counts(copy.sequence)) {
            missed.lost[copy.cause as usize] += 1;
        }
        let under_way = waiting.iter().map(|reception| &reception.frame);
        let under_way = under_way.filter(|frame| frame.sender == subject && counts(frame.sequence));
        missed.under_way = self.statuses(subject, under_way.map(|frame| frame.sequence));
        let accounted = missed.lost.iter().sum::<u32>() + missed.under_way;
        missed.out_of_range = u32::saturating_sub(total, accounted);
        missed
    }

    /// How many of the frames `sequences` of `subject` are statuses.
    fn statuses(&self, subject: ActorId, sequences: impl Iterator<Item = u32>) -> u32 {
        let sent = &self.sent[subject.index()];
        sequences
            .filter(|sequence| sent.iter().any(|status| status.sequence == *sequence))
            .count() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::Frame;

    const OBSERVER: ActorId = ActorId(0);
    const SUBJECT: ActorId = ActorId(1);

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs(seconds)
    }

    fn under_way(sequence: u32) -> Reception<()> {
        Reception {
            at: at(9.0),
            frame: Frame {
                sender: SUBJECT,
                sequence,
                sent_at: at(0.0),
                payload_bytes: 4,
                message: (),
            },
            displacement: [0.0; 2],
        }
    }

    /// Statuses number 0, 10, 20 … 60, a second apart: other topics have the numbers between.
    fn log(memory_s: f64) -> StatusLog {
        let mut log = StatusLog::new(2, Span::from_secs(memory_s));
        for status in 0..7_u32 {
            log.sent(at(f64::from(status)), SUBJECT, 10 * status);
        }
        log
    }

    #[test]
    fn each_status_since_the_newest_heard_is_lost_under_way_or_was_out_of_range() {
        let mut log = log(100.0);
        for lost in [0, 20, 30, 60] {
            log.lost(OBSERVER, SUBJECT, lost, LossCause::Channel);
        }
        let waiting = [under_way(40), under_way(45), under_way(60)];
        let missed = log.missed(at(6.0), [OBSERVER, SUBJECT], 10, &waiting);
        assert_eq!(
            missed.lost[LossCause::Channel as usize],
            2,
            "20 and 30: 0 is older, 60 is sent only now"
        );
        assert_eq!((missed.under_way, missed.out_of_range), (1, 1), "40, and then 50");
    }

    #[test]
    fn what_was_sent_longer_ago_than_twice_the_memory_is_forgotten() {
        // The log turns at 2 s, 4 s and 6 s: before 4 s nothing is left.
        let missed = log(2.0).missed(at(6.5), [OBSERVER, SUBJECT], 0, &[] as &[Reception<()>]);
        assert_eq!(missed.out_of_range, 3);
    }
}
