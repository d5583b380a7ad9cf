//! What became of the statuses of late: kept so that a suspicion can be traced to them, and no longer.

use crate::engine::{ActorId, SimTime, Span, prefetch, prefetch_end, push_tight};
use crate::happenings::Inbox;
use crate::protocol::Reception;
use crate::radio::LossCause;

use super::record::Missed;

/// Statuses sent and copies of them lost, for the last while. What is delivered leaves no trace here: that is by far the
/// most, and a status that was sent, not lost and is not under way was either read or out of range.
#[derive(Debug)]
pub struct StatusLog {
    memory: Span,
    senders: Vec<Sender>,
}

/// The statuses of one robot. Small and in one place: at each status it is written to, and seldom read.
#[derive(Debug, Default)]
struct Sender {
    sent: Vec<Sent>,
    lost: Vec<Lost>,
    /// When the first status in `sent` was sent.
    since: SimTime,
    /// The robot's first frame that was a status, if it has sent one.
    first: Option<u32>,
}

#[derive(Debug)]
struct Sent {
    sequence: u32,
    /// The number of the robot that it was sent to; `EVERYONE` if it was for all in range.
    to: u32,
    at: SimTime,
}

/// No robot's number.
const EVERYONE: u32 = u32::MAX;

impl Sent {
    /// Whether `observer` was to hear it.
    fn is_for(&self, observer: ActorId) -> bool {
        self.to == EVERYONE || self.to == observer.0
    }
}

/// A lost copy, at its sender: what one frame loses lies together in memory.
#[derive(Debug)]
struct Lost {
    sequence: u32,
    /// The receiver, and the number of the cause in the bits above it: a swarm has a million robots at most.
    receiver_and_cause: u32,
}

impl Lost {
    const RECEIVER_BITS: u32 = 24;

    fn new(receiver: ActorId, sequence: u32, cause: LossCause) -> Self {
        debug_assert!(
            receiver.0 >> Self::RECEIVER_BITS == 0,
            "robot {receiver} has no number of 24 bits"
        );
        Self {
            sequence,
            receiver_and_cause: receiver.0 | (cause as u32) << Self::RECEIVER_BITS,
        }
    }

    fn receiver(&self) -> ActorId {
        ActorId(self.receiver_and_cause & ((1 << Self::RECEIVER_BITS) - 1))
    }

    /// The place of its cause among all.
    fn cause(&self) -> usize {
        (self.receiver_and_cause >> Self::RECEIVER_BITS) as usize
    }
}

impl StatusLog {
    /// An empty log that reaches back `memory`; zero where no suspicion will ever be traced.
    pub fn new(robots: usize, memory: Span) -> Self {
        Self {
            memory,
            senders: std::iter::repeat_with(Sender::default).take(robots).collect(),
        }
    }

    /// Asks for what is known of the statuses of `sender`.
    pub fn prefetch_row(&self, sender: ActorId) {
        prefetch(&self.senders[sender.index()]);
    }

    /// Asks for where the next ones go.
    pub fn prefetch_contents(&self, sender: ActorId) {
        let Sender { sent, lost, .. } = &self.senders[sender.index()];
        prefetch_end(sent);
        prefetch_end(lost);
    }

    /// `sender` sends a status, its frame number `sequence`: to one robot alone, or to all in range.
    pub fn sent(&mut self, now: SimTime, sender: ActorId, sequence: u32, to: Option<ActorId>) {
        if self.memory == Span::ZERO {
            return;
        }
        let sender = &mut self.senders[sender.index()];
        // What is too old goes a quarter of the memory at a time, so that a push is mostly a push.
        if sender.since + self.memory + self.memory / 4 < now {
            sender.forget_before(now - self.memory);
        }
        if sender.sent.is_empty() {
            sender.since = now;
            sender.first.get_or_insert(sequence);
        }
        let status = Sent {
            sequence,
            to: to.map_or(EVERYONE, |robot| robot.0),
            at: now,
        };
        push_tight(&mut sender.sent, status);
    }

    /// The copy of a status that was meant for `receiver` is lost.
    #[inline]
    pub fn lost(&mut self, receiver: ActorId, sender: ActorId, sequence: u32, cause: LossCause) {
        if self.memory == Span::ZERO {
            return;
        }
        let lost = &mut self.senders[sender.index()].lost;
        push_tight(lost, Lost::new(receiver, sequence, cause));
    }

    /// What became at `observer`, until `now`, of the statuses that `subject` sent after its frame number `sequence` and
    /// before `now`, as far back as the memory reaches, with `waiting` under way to the observer. Whoever sends at this very
    /// instant does not count: whether it did so before the observer or after it is an accident.
    pub fn missed<M>(
        &self,
        now: SimTime,
        [observer, subject]: [ActorId; 2],
        sequence: u32,
        waiting: &[Reception<M>],
    ) -> Missed {
        let subject_log = &self.senders[subject.index()];
        let recent = (now - self.memory)..now;
        let statuses = subject_log.sent.iter().filter(|status| status.is_for(observer));
        let statuses = statuses.filter(|status| is_newer(status.sequence, sequence) && recent.contains(&status.at));
        let (mut missed, mut total, mut ends) = (Missed::default(), 0, None);
        for status in statuses {
            total += 1;
            ends = Some((ends.map_or(status.sequence, |(first, _)| first), status.sequence));
        }
        let Some((first, last)) = ends else { return missed };
        let counts = |status: u32| !is_newer(first, status) && !is_newer(status, last);
        for copy in &subject_log.lost {
            if copy.receiver() == observer && counts(copy.sequence) {
                missed.lost[copy.cause()] += 1;
            }
        }
        let under_way = waiting.iter().map(|reception| &reception.frame);
        let under_way = under_way.filter(|frame| frame.sender == subject && counts(frame.sequence));
        missed.under_way = self.statuses(subject, under_way.map(|frame| frame.sequence));
        let accounted = missed.lost.iter().sum::<u32>() + missed.under_way;
        missed.out_of_range = u32::saturating_sub(total, accounted);
        missed
    }

    /// When `observer` came into range of `subject`, of which it now reads statuses for the first time: half-way between the last status that was sent while it was out of range and the first
    /// that was not. `None` if there was no such status, that is, if it has been in range from the start.
    pub fn met<M>(&self, [observer, subject]: [ActorId; 2], inbox: &Inbox<'_, M>) -> Option<SimTime> {
        let Sender { sent, lost, first, .. } = &self.senders[subject.index()];
        let reached = |status: &&Sent| {
            let mut frames = inbox.read.iter().chain(inbox.waiting).map(|reception| &reception.frame);
            lost.iter()
                .any(|copy| copy.sequence == status.sequence && copy.receiver() == observer)
                || frames.any(|frame| frame.sequence == status.sequence && frame.sender == subject)
        };
        // Newer ones may have been sent when the two had parted again.
        let meant = || sent.iter().rev().filter(|status| status.is_for(observer));
        let met = meant().skip_while(|status| !reached(status));
        let Some(begun) = met.take_while(reached).last() else {
            return sent.last().map(|status| status.at);
        };
        let before = meant().find(|status| is_newer(begun.sequence, status.sequence));
        match before {
            Some(before) => Some(before.at + begun.at.since(before.at) / 2),
            None => (*first != Some(begun.sequence)).then_some(begun.at),
        }
    }

    /// How many of the frames `sequences` of `subject` are statuses.
    fn statuses(&self, subject: ActorId, sequences: impl Iterator<Item = u32>) -> u32 {
        let sent = &self.senders[subject.index()].sent;
        sequences
            .filter(|sequence| sent.iter().any(|status| status.sequence == *sequence))
            .count() as u32
    }
}

impl Sender {
    /// Forgets statuses sent before `oldest`, and what was lost of them.
    fn forget_before(&mut self, oldest: SimTime) {
        let kept = self.sent.partition_point(|status| status.at < oldest);
        self.sent.drain(..kept);
        match self.sent.first() {
            Some(first) => {
                self.since = first.at;
                self.lost.retain(|copy| !is_newer(first.sequence, copy.sequence));
            }
            None => self.lost.clear(),
        }
    }
}

/// Whether frame number `a` of a robot is a later one than `b`: numbers go round.
fn is_newer(a: u32, b: u32) -> bool {
    a.wrapping_sub(b).cast_signed() > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{Address, Frame};

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
                rides: false,
                address: Address::Everyone,
                message: (),
            },
            displacement: [0.0; 2],
        }
    }

    /// Statuses number 0, 10, 20 … 60, a second apart: other topics have the numbers between.
    fn log(memory_s: f64) -> StatusLog {
        let mut log = StatusLog::new(2, Span::from_secs(memory_s));
        for status in 0..7_u32 {
            log.sent(at(f64::from(status)), SUBJECT, 10 * status, None);
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

    /// Statuses for one robot alone: the observer misses those for itself, and those for all.
    #[test]
    fn a_status_for_another_is_missed_by_nobody_else() {
        let mut log = StatusLog::new(3, Span::from_secs(100.0));
        let addressees = [None, Some(ActorId(2)), Some(OBSERVER), Some(ActorId(2)), None];
        for (second, to) in (0..).zip(addressees) {
            log.sent(at(f64::from(second)), SUBJECT, second, to);
        }
        let none = [] as [Reception<()>; 0];
        let out_of_range = |observer| log.missed(at(9.0), [observer, SUBJECT], 0, &none).out_of_range;
        assert_eq!(out_of_range(OBSERVER), 2, "2 for itself, 4 for all");
        assert_eq!(out_of_range(ActorId(2)), 3, "1 and 3 for itself, 4 for all");
    }

    #[test]
    fn what_was_sent_longer_ago_than_the_memory_does_not_count_however_much_of_it_is_kept() {
        let none = [] as [Reception<()>; 0];
        for (memory_s, counted) in [(2.0, 2), (2.5, 3), (100.0, 6)] {
            let mut log = log(memory_s);
            for lost in [20, 50] {
                log.lost(OBSERVER, SUBJECT, lost, LossCause::Channel);
            }
            let missed = log.missed(at(6.5), [OBSERVER, SUBJECT], 0, &none);
            let lost = missed.lost[LossCause::Channel as usize];
            assert_eq!(
                lost + missed.out_of_range,
                counted,
                "of 10, 20 … 60, sent at 1 s, 2 s … 6 s"
            );
            assert_eq!(lost, if memory_s > 4.5 { 2 } else { 1 });
        }
    }

    #[test]
    fn old_statuses_and_their_losses_take_no_room() {
        let mut log = StatusLog::new(2, Span::from_secs(2.0));
        for status in 0..1000_u32 {
            log.sent(at(f64::from(status)), SUBJECT, status, None);
            log.lost(OBSERVER, SUBJECT, status, LossCause::Channel);
        }
        let kept = &log.senders[SUBJECT.index()];
        assert!(
            kept.sent.len() <= 4 && kept.lost.len() <= 4,
            "one a second, kept for three at most"
        );
    }
}
