//! Beliefs held against the truth, as both change.

use crate::engine::{ActorId, SimTime, Span};
use crate::faults::Health;
use crate::protocol::{Evidence, Note, Reception};
use crate::radio::LossCause;

use super::log::StatusLog;
use super::record::{Cause, DetectionRecord, FailureOutcome, Missed, ObservedFailure, Suspicion, Verdict};

/// Scores the failure detectors of one run.
#[derive(Debug)]
pub struct Scorer {
    log: StatusLog,
    health: Vec<Health>,
    /// When each robot could not send; the last stretch may be open.
    silences: Vec<Vec<(SimTime, SimTime)>>,
    /// By observer: whom it watches.
    pairs: Vec<Vec<Pair>>,
    /// By subject: who watches it.
    watchers: Vec<Vec<ActorId>>,
    tally: Tally,
}

/// What has been counted.
#[derive(Debug, Default)]
struct Tally {
    monitored_nanos: u128,
    mistaken_nanos: u128,
    suspicions: Vec<Suspicion>,
    failures: Vec<ObservedFailure>,
}

/// A subject, at its observer.
#[derive(Debug)]
struct Pair {
    subject: ActorId,
    /// Since when the pair is monitored, in one stretch and with one belief; `NEVER` while it is not. There is a pair for
    /// every link of the swarm, so it is kept small.
    since: SimTime,
    /// The suspicion in force, by its place in the tally.
    suspicion: Option<u32>,
    /// Whether that is a mistake.
    mistaken: bool,
    /// The failure that is to be detected, by its place in the tally.
    failure: Option<u32>,
}

impl Scorer {
    /// A scorer of robots that all are well, which traces suspicions back by `memory` at least.
    pub fn new(robots: usize, memory: Span) -> Self {
        Self {
            log: StatusLog::new(robots, memory),
            health: vec![Health::WELL; robots],
            silences: vec![Vec::new(); robots],
            pairs: std::iter::repeat_with(Vec::new).take(robots).collect(),
            watchers: vec![Vec::new(); robots],
            tally: Tally::default(),
        }
    }

    /// `sender` sends a status, its frame number `sequence`.
    #[inline]
    pub fn sent(&mut self, now: SimTime, sender: ActorId, sequence: u32) {
        self.log.sent(now, sender, sequence);
    }

    /// Asks for what is known of the statuses of `robot`.
    pub fn prefetch_row(&self, robot: ActorId) {
        self.log.prefetch_row(robot);
    }

    /// Asks for where the next ones go.
    pub fn prefetch_contents(&self, robot: ActorId) {
        self.log.prefetch_contents(robot);
    }

    /// The copy of a status that was meant for `receiver` is lost.
    #[inline]
    pub fn lost(&mut self, receiver: ActorId, sender: ActorId, sequence: u32, cause: LossCause) {
        self.log.lost(receiver, sender, sequence, cause);
    }

    /// `observer` reported a belief; `waiting` is on its way to it.
    ///
    /// # Panics
    /// If it reports a belief about a robot that it does not watch.
    pub fn belief<M>(&mut self, now: SimTime, observer: ActorId, note: &Note, waiting: &[Reception<M>]) {
        match *note {
            Note::Watches(subject) => self.watch(now, observer, subject),
            Note::Suspects {
                robot,
                heard,
                sequence,
                evidence,
            } => {
                let missed = self.log.missed(now, [observer, robot], sequence, waiting);
                let subject_down = !self.health[robot.index()].sends;
                let is_failure = subject_down || self.silent(robot, heard, now) * 2 > now.since(heard);
                let suspicion = Suspicion {
                    observer,
                    subject: robot,
                    at: now,
                    heard,
                    sequence,
                    until: None,
                    subject_down,
                    cause: if is_failure {
                        Cause::Failure
                    } else {
                        cause(&missed, evidence)
                    },
                    missed,
                    duration: None,
                    cut_off: false,
                };
                self.suspect(suspicion);
            }
            Note::Trusts(subject) => self.trust(now, observer, subject),
            Note::Duplicate { .. } | Note::Informed { .. } | Note::Role(_) | Note::Target(_) | Note::Parents(_) => {}
        }
    }

    fn watch(&mut self, now: SimTime, observer: ActorId, subject: ActorId) {
        let mut pair = Pair {
            subject,
            since: SimTime::NEVER,
            suspicion: None,
            mistaken: false,
            failure: None,
        };
        pair.resume(now, self.is_able(observer, subject));
        self.pairs[observer.index()].push(pair);
        self.watchers[subject.index()].push(observer);
    }

    fn suspect(&mut self, suspicion: Suspicion) {
        let Suspicion {
            observer, subject, at, ..
        } = suspicion;
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        pair.settle(at, &mut self.tally);
        pair.suspicion = Some(self.tally.suspicions.len() as u32);
        pair.mistaken = suspicion.verdict() == Verdict::Mistake;
        self.tally.suspicions.push(suspicion);
        pair.resume(at, able);
    }

    fn trust(&mut self, now: SimTime, observer: ActorId, subject: ActorId) {
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        pair.settle(now, &mut self.tally);
        pair.end_mistake(now, false, &mut self.tally);
        if let Some(suspicion) = pair.suspicion.take() {
            self.tally.suspicions[suspicion as usize].until = Some(now);
        }
        pair.resume(now, able);
    }

    /// `robot` can do from `now` on what `health` says.
    pub fn fault(&mut self, now: SimTime, robot: ActorId, health: Health) {
        let before = std::mem::replace(&mut self.health[robot.index()], health);
        if before.sends != health.sends {
            let silences = &mut self.silences[robot.index()];
            match silences.last_mut() {
                Some(last) if health.sends => last.1 = now,
                _ => silences.push((now, SimTime::NEVER)),
            }
            let mut watchers = std::mem::take(&mut self.watchers[robot.index()]);
            watchers.sort_unstable();
            for &observer in &watchers {
                self.subject_changes(now, observer, robot);
            }
            self.watchers[robot.index()] = watchers;
        }
        if before.hears != health.hears {
            self.observer_changes(now, robot);
        }
    }

    /// `subject` fails to send, or sends again: to `observer` a mistake about it is one no longer.
    fn subject_changes(&mut self, now: SimTime, observer: ActorId, subject: ActorId) {
        let able = self.is_able(observer, subject);
        let pair = find(&mut self.pairs, observer, subject);
        let was_monitored = pair.since < SimTime::NEVER;
        pair.settle(now, &mut self.tally);
        pair.end_mistake(now, true, &mut self.tally);
        if self.health[subject.index()].sends {
            pair.resolve(now, FailureOutcome::Recovered, &mut self.tally);
        } else if was_monitored {
            pair.failure = Some(self.tally.failures.len() as u32);
            self.tally.failures.push(ObservedFailure {
                subject,
                observer,
                at: now,
                outcome: FailureOutcome::Undetected,
                watched: Span::ZERO,
            });
        }
        pair.resume(now, able);
    }

    /// `observer` fails to hear, or hears again: what it believed meanwhile is not its detector's merit or fault.
    fn observer_changes(&mut self, now: SimTime, observer: ActorId) {
        let hears = self.health[observer.index()].hears;
        for pair in &mut self.pairs[observer.index()] {
            pair.settle(now, &mut self.tally);
            pair.end_mistake(now, true, &mut self.tally);
            if !hears {
                pair.resolve(now, FailureOutcome::ObserverFailed, &mut self.tally);
            }
            pair.resume(now, hears && self.health[pair.subject.index()].sends);
        }
    }

    /// Closes the books at `end`.
    pub fn finish(mut self, end: SimTime) -> DetectionRecord {
        for pair in self.pairs.iter_mut().flatten() {
            pair.settle(end, &mut self.tally);
            pair.end_mistake(end, true, &mut self.tally);
            pair.resolve(end, FailureOutcome::Undetected, &mut self.tally);
        }
        DetectionRecord {
            pairs: self.pairs.iter().map(|pairs| pairs.len() as u64).sum(),
            monitored_s: self.tally.monitored_nanos as f64 / 1e9,
            mistaken_s: self.tally.mistaken_nanos as f64 / 1e9,
            suspicions: self.tally.suspicions,
            failures: self.tally.failures,
        }
    }

    fn is_able(&self, observer: ActorId, subject: ActorId) -> bool {
        self.health[observer.index()].hears && self.health[subject.index()].sends
    }

    /// How long `robot` could not send within `from..to`.
    fn silent(&self, robot: ActorId, from: SimTime, to: SimTime) -> Span {
        let silences = self.silences[robot.index()].iter();
        let overlaps = silences.map(|&(since, until)| until.min(to).since(since.max(from)));
        overlaps.fold(Span::ZERO, |sum, overlap| sum + overlap)
    }
}

/// What a suspicion of a robot that was well was due to. Who goes by probes does not go by statuses: these only tell whether
/// the two could hear each other.
fn cause(missed: &Missed, evidence: Evidence) -> Cause {
    let cause = missed.cause();
    let hindered = matches!(cause, Cause::OutOfRange | Cause::Lost(LossCause::ReceiverDown));
    match evidence {
        Evidence::Probes if !hindered => Cause::Unanswered,
        Evidence::Probes | Evidence::Silence => cause,
    }
}

/// The pair of `observer` and `subject`.
fn find(pairs: &mut [Vec<Pair>], observer: ActorId, subject: ActorId) -> &mut Pair {
    let mut watched = pairs[observer.index()].iter_mut();
    let found = watched.find(|pair| pair.subject == subject);
    found.unwrap_or_else(|| panic!("robot {observer} believes something of robot {subject}, which it does not watch"))
}

impl Pair {
    /// Counts the stretch that ends at `now`.
    fn settle(&mut self, now: SimTime, tally: &mut Tally) {
        // A pair that is not monitored began to be so `NEVER`, no time ago.
        let nanos = u128::from(now.since(std::mem::replace(&mut self.since, SimTime::NEVER)).as_nanos());
        tally.monitored_nanos += nanos;
        tally.mistaken_nanos += if self.mistaken { nanos } else { 0 };
    }

    /// Begins a stretch at `now`, if both robots are `able` and the belief says something of the detector's quality.
    fn resume(&mut self, now: SimTime, able: bool) {
        let tells = self.suspicion.is_none() || self.mistaken;
        self.since = if able && tells { now } else { SimTime::NEVER };
    }

    /// A mistake, if there is one, ends at `now`: in trust, or cut off.
    fn end_mistake(&mut self, now: SimTime, cut_off: bool, tally: &mut Tally) {
        if let (true, Some(suspicion)) = (std::mem::take(&mut self.mistaken), self.suspicion) {
            let suspicion = &mut tally.suspicions[suspicion as usize];
            suspicion.duration = Some(now.since(suspicion.at));
            suspicion.cut_off = cut_off;
        }
    }

    /// The failure ends at `now`: it was detected if the subject is suspected, else the `outcome` is another.
    fn resolve(&mut self, now: SimTime, outcome: FailureOutcome, tally: &mut Tally) {
        if let Some(failure) = self.failure.take() {
            let failure = &mut tally.failures[failure as usize];
            let detected = self
                .suspicion
                .map(|suspicion| tally.suspicions[suspicion as usize].at.since(failure.at));
            failure.outcome = detected.map_or(outcome, FailureOutcome::Detected);
            failure.watched = detected.unwrap_or_else(|| now.since(failure.at));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBSERVER: ActorId = ActorId(0);
    const SUBJECT: ActorId = ActorId(1);
    const MUTE: Health = Health {
        sends: false,
        ..Health::WELL
    };
    const DEAF: Health = Health {
        hears: false,
        ..Health::WELL
    };

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs(seconds)
    }

    /// One observer that has watched one subject since 1 s, and statuses number 0, 1, … of it at 0, 1, … s.
    struct Bench(Scorer);

    impl Bench {
        fn new() -> Self {
            let mut scorer = Scorer::new(2, Span::from_secs(1000.0));
            (0..30).for_each(|second| scorer.sent(at(f64::from(second)), SUBJECT, second));
            let mut bench = Self(scorer);
            bench.believe(1.0, &Note::Watches(SUBJECT));
            bench
        }

        fn believe(&mut self, seconds: f64, note: &Note) {
            self.0.belief(at(seconds), OBSERVER, note, &[] as &[Reception<()>]);
        }

        /// A suspicion, the last status heard being number `heard` at its own second.
        fn suspect(&mut self, seconds: f64, heard: u32) {
            self.suspect_for(Evidence::Silence, seconds, heard);
        }

        fn suspect_for(&mut self, evidence: Evidence, seconds: f64, heard: u32) {
            self.believe(
                seconds,
                &Note::Suspects {
                    robot: SUBJECT,
                    heard: at(f64::from(heard)),
                    sequence: heard,
                    evidence,
                },
            );
        }

        fn trust(&mut self, seconds: f64) {
            self.believe(seconds, &Note::Trusts(SUBJECT));
        }

        /// The channel loses statuses `lost`.
        fn lose(&mut self, lost: std::ops::Range<u32>) {
            lost.for_each(|status| self.0.lost(OBSERVER, SUBJECT, status, LossCause::Channel));
        }

        fn outcomes(self) -> (DetectionRecord, Vec<FailureOutcome>) {
            let record = self.0.finish(at(30.0));
            let outcomes = record.failures.iter().map(|failure| failure.outcome).collect();
            (record, outcomes)
        }
    }

    fn assert_time(record: &DetectionRecord, monitored: f64, mistaken: f64) {
        assert!(
            (record.monitored_s - monitored).abs() < 1e-9,
            "monitored {} s",
            record.monitored_s
        );
        assert!(
            (record.mistaken_s - mistaken).abs() < 1e-9,
            "mistaken {} s",
            record.mistaken_s
        );
    }

    #[test]
    fn a_mistake_counts_as_monitored_time_and_lasts_until_trust() {
        let mut bench = Bench::new();
        bench.lose(4..6);
        bench.suspect(5.5, 3);
        bench.trust(6.0);
        let (record, _) = bench.outcomes();
        assert_time(&record, 29.0, 0.5);
        let suspicion = &record.suspicions[0];
        assert_eq!(
            (suspicion.verdict(), suspicion.cause),
            (Verdict::Mistake, Cause::Lost(LossCause::Channel))
        );
        assert_eq!(
            (suspicion.duration, suspicion.until),
            (Some(Span::from_secs(0.5)), Some(at(6.0)))
        );
    }

    #[test]
    fn a_robot_out_of_range_is_not_mistaken_for_a_failed_one_and_not_monitored_until_it_is_back() {
        let mut bench = Bench::new();
        bench.suspect(10.0, 6);
        bench.trust(20.0);
        let (record, _) = bench.outcomes();
        assert_eq!(record.suspicions[0].verdict(), Verdict::OutOfRange);
        assert_eq!(
            (record.suspicions[0].missed.out_of_range, record.suspicions[0].duration),
            (3, None)
        );
        assert_time(&record, 9.0 + 10.0, 0.0);
    }

    #[test]
    fn a_failure_is_detected_at_the_suspicion_that_stays() {
        let mut bench = Bench::new();
        bench.0.fault(at(10.0), SUBJECT, MUTE);
        bench.suspect(12.0, 9);
        bench.trust(12.5);
        bench.suspect(15.0, 9);
        bench.0.fault(at(20.0), SUBJECT, Health::WELL);
        bench.trust(21.0);
        let (record, outcomes) = bench.outcomes();
        assert_eq!(outcomes, [FailureOutcome::Detected(Span::from_secs(5.0))]);
        assert!(
            record
                .suspicions
                .iter()
                .all(|suspicion| suspicion.verdict() == Verdict::Right)
        );
        assert_time(&record, 9.0 + 9.0, 0.0);
    }

    #[test]
    fn a_mistake_that_comes_true_is_a_detection_without_delay_and_is_cut_off() {
        let mut bench = Bench::new();
        bench.lose(7..10);
        bench.suspect(9.5, 6);
        bench.0.fault(at(10.0), SUBJECT, MUTE);
        let (record, outcomes) = bench.outcomes();
        assert_eq!(outcomes, [FailureOutcome::Detected(Span::ZERO)]);
        let suspicion = &record.suspicions[0];
        assert_eq!(
            (suspicion.duration, suspicion.cut_off),
            (Some(Span::from_secs(0.5)), true)
        );
        assert_time(&record, 9.0, 0.5);
    }

    #[test]
    fn mistakes_that_the_end_or_the_observers_own_failure_cuts_off_say_how_long_they_had_lasted() {
        let mut ended = Bench::new();
        ended.lose(25..29);
        ended.suspect(28.5, 24);
        let (record, _) = ended.outcomes();
        let cut = |suspicion: &Suspicion| (suspicion.duration, suspicion.cut_off, suspicion.until);
        assert_eq!(cut(&record.suspicions[0]), (Some(Span::from_secs(1.5)), true, None));

        let mut deaf = Bench::new();
        deaf.lose(4..6);
        deaf.suspect(5.5, 3);
        deaf.0.fault(at(7.25), OBSERVER, DEAF);
        deaf.0.fault(at(9.0), OBSERVER, Health::WELL);
        deaf.trust(10.0);
        let (record, _) = deaf.outcomes();
        assert_eq!(
            cut(&record.suspicions[0]),
            (Some(Span::from_secs(1.75)), true, Some(at(10.0))),
            "trust after the failure says nothing of how long the mistake would have lasted"
        );
    }

    #[test]
    fn each_failure_says_how_long_it_was_watched() {
        let mut detected = Bench::new();
        detected.0.fault(at(10.0), SUBJECT, MUTE);
        detected.suspect(13.5, 9);
        assert_eq!(detected.outcomes().0.failures[0].watched, Span::from_secs(3.5));

        let mut recovered = Bench::new();
        recovered.0.fault(at(10.0), SUBJECT, MUTE);
        recovered.0.fault(at(11.25), SUBJECT, Health::WELL);
        assert_eq!(recovered.outcomes().0.failures[0].watched, Span::from_secs(1.25));

        let mut late = Bench::new();
        late.0.fault(at(29.0), SUBJECT, MUTE);
        assert_eq!(late.outcomes().0.failures[0].watched, Span::from_secs(1.0));
    }

    #[test]
    fn failures_end_undetected_when_the_robot_the_observer_or_the_run_is_quicker() {
        let mut recovered = Bench::new();
        recovered.0.fault(at(10.0), SUBJECT, MUTE);
        recovered.0.fault(at(11.0), SUBJECT, Health::WELL);
        assert_eq!(recovered.outcomes().1, [FailureOutcome::Recovered]);

        let mut deaf = Bench::new();
        deaf.0.fault(at(10.0), SUBJECT, MUTE);
        deaf.0.fault(at(11.0), OBSERVER, DEAF);
        deaf.suspect(13.0, 9);
        assert_eq!(deaf.outcomes().1, [FailureOutcome::ObserverFailed]);

        let mut late = Bench::new();
        late.0.fault(at(29.0), SUBJECT, MUTE);
        assert_eq!(late.outcomes().1, [FailureOutcome::Undetected]);
    }

    #[test]
    fn a_suspicion_after_a_failure_that_filled_most_of_the_silence_is_due_to_it() {
        let mut bench = Bench::new();
        bench.0.fault(at(4.0), SUBJECT, MUTE);
        bench.0.fault(at(7.5), SUBJECT, Health::WELL);
        bench.suspect(8.0, 3);
        let suspicion = &bench.outcomes().0.suspicions[0];
        assert_eq!(
            (suspicion.verdict(), suspicion.cause),
            (Verdict::Mistake, Cause::Failure)
        );
    }

    #[test]
    fn a_suspicion_by_probes_is_due_to_them_unless_the_two_could_not_hear_each_other() {
        let mut bench = Bench::new();
        bench.lose(4..5);
        bench.suspect_for(Evidence::Probes, 5.5, 3);
        bench.trust(6.0);
        bench.suspect_for(Evidence::Probes, 12.5, 6);
        let suspicions = bench.outcomes().0.suspicions;
        let judged = suspicions
            .iter()
            .map(|suspicion| (suspicion.cause, suspicion.verdict()));
        assert_eq!(
            judged.collect::<Vec<_>>(),
            [
                (Cause::Unanswered, Verdict::Mistake),
                (Cause::OutOfRange, Verdict::OutOfRange)
            ]
        );
    }
}
