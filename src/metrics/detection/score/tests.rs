//! Beliefs of one observer of one subject.

use super::*;
use crate::protocol::{Address, Frame, Reception};

mod links;

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

/// How long the detector waits.
const PATIENCE_S: f64 = 2.5;

/// A status of the subject that arrives as it is sent, `number` seconds after the start.
fn status(number: u32) -> Reception<()> {
    Reception {
        at: at(f64::from(number)),
        frame: Frame {
            sender: SUBJECT,
            sequence: number,
            sent_at: at(f64::from(number)),
            payload_bytes: 4,
            rides: false,
            address: Address::Everyone,
            message: (),
        },
        displacement: [0.0; 2],
    }
}

/// One observer that has watched one subject since 1 s, and statuses number 0, 1, … of it at 0, 1, … s.
struct Bench(Scorer);

impl Bench {
    fn new() -> Self {
        Self::meeting(0, 1)
    }

    /// The observer is in range from status `met` on, and reads `first` first, as it arrives.
    fn meeting(met: u32, first: u32) -> Self {
        let watching = Watching {
            memory: Span::from_secs(1000.0),
            patience: Span::from_secs(PATIENCE_S),
            reach: Reach::Disk(2.0),
        };
        let mut bench = Self(Scorer::new(2, watching, &Scratch::default()));
        (0..=first).for_each(|second| bench.0.sent(at(f64::from(second)), SUBJECT, second, None));
        bench.lose(met..first);
        bench.believe(f64::from(first), &Note::Watches(SUBJECT), &[status(first)]);
        (first + 1..30).for_each(|second| bench.0.sent(at(f64::from(second)), SUBJECT, second, None));
        bench
    }

    fn believe(&mut self, seconds: f64, note: &Note, read: &[Reception<()>]) {
        let inbox = Inbox { read, waiting: &[] };
        self.0.belief(at(seconds), OBSERVER, note, &inbox);
    }

    /// The two part, or meet again.
    fn cross(&mut self, seconds: f64, within: bool) {
        self.0.cross(at(seconds), OBSERVER, SUBJECT, within);
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
            &[],
        );
    }

    fn trust(&mut self, seconds: f64) {
        self.believe(seconds, &Note::Trusts(SUBJECT), &[]);
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
    for (what, told, expected) in [
        ("monitored", record.monitored_s, monitored),
        ("mistaken", record.mistaken_s, mistaken),
    ] {
        assert!((told - expected).abs() < 1e-9, "{what} {told} s");
    }
}

fn first(record: &DetectionRecord) -> Suspicion {
    record.suspicions.first().expect("somebody was suspected")
}

#[test]
fn a_mistake_counts_as_monitored_time_and_lasts_until_trust() {
    let mut bench = Bench::new();
    bench.lose(4..6);
    bench.suspect(5.5, 3);
    bench.trust(6.0);
    let (record, _) = bench.outcomes();
    assert_time(&record, 29.0, 0.5);
    let suspicion = &first(&record);
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
    assert_eq!(first(&record).verdict(), Verdict::OutOfRange);
    assert_eq!((first(&record).missed.out_of_range, first(&record).duration), (3, None));
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
    let suspicion = &first(&record);
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
    assert_eq!(cut(&first(&record)), (Some(Span::from_secs(1.5)), true, None));

    let mut deaf = Bench::new();
    deaf.lose(4..6);
    deaf.suspect(5.5, 3);
    deaf.0.fault(at(7.25), OBSERVER, DEAF);
    deaf.0.fault(at(9.0), OBSERVER, Health::WELL);
    deaf.trust(10.0);
    let (record, _) = deaf.outcomes();
    assert_eq!(
        cut(&first(&record)),
        (Some(Span::from_secs(1.75)), true, Some(at(10.0))),
        "trust after the failure says nothing of how long the mistake would have lasted"
    );
}

#[test]
fn each_failure_says_how_long_it_was_watched() {
    let watched = |bench: Bench| bench.outcomes().0.failures.first().map(|failure| failure.watched);
    let mut detected = Bench::new();
    detected.0.fault(at(10.0), SUBJECT, MUTE);
    detected.suspect(13.5, 9);
    assert_eq!(watched(detected), Some(Span::from_secs(3.5)));

    let mut recovered = Bench::new();
    recovered.0.fault(at(10.0), SUBJECT, MUTE);
    recovered.0.fault(at(11.25), SUBJECT, Health::WELL);
    assert_eq!(watched(recovered), Some(Span::from_secs(1.25)));

    let mut late = Bench::new();
    late.0.fault(at(29.0), SUBJECT, MUTE);
    assert_eq!(watched(late), Some(Span::from_secs(1.0)));
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
    let suspicion = first(&bench.outcomes().0);
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

#[test]
fn a_mistake_is_cut_off_when_the_two_part_and_so_is_its_time() {
    let mut bench = Bench::new();
    bench.lose(7..10);
    bench.suspect(9.5, 6);
    bench.cross(10.25, false);
    bench.cross(20.0, true);
    bench.trust(20.5);
    let (record, _) = bench.outcomes();
    let mistake = &first(&record);
    assert_eq!(mistake.verdict(), Verdict::Mistake);
    assert_eq!(
        (mistake.duration, mistake.cut_off, mistake.until),
        (Some(Span::from_secs(0.75)), true, Some(at(20.5)))
    );
    // Until they part, and again from the detector's patience after they meet.
    assert_time(&record, 9.25 + 7.5, 0.75);
}

#[test]
fn who_falls_silent_by_leaving_is_not_mistaken_however_much_was_lost_before() {
    let mut bench = Bench::new();
    bench.lose(7..9);
    bench.cross(9.0, false);
    bench.suspect(9.5, 6);
    let (record, _) = bench.outcomes();
    let suspicion = &first(&record);
    assert_eq!(
        (suspicion.verdict(), suspicion.cause, suspicion.duration),
        (Verdict::OutOfRange, Cause::OutOfRange, None)
    );
    assert_time(&record, 8.0, 0.0);
}

#[test]
fn a_silence_that_began_before_the_two_met_again_is_not_the_detectors() {
    let mut bench = Bench::new();
    bench.cross(7.5, false);
    bench.cross(8.5, true);
    bench.lose(9..10);
    bench.suspect(9.5, 7);
    bench.trust(10.0);
    let (record, _) = bench.outcomes();
    assert_eq!(first(&record).verdict(), Verdict::OutOfRange);
    assert_time(&record, 6.5 + 19.0, 0.0);

    let mut longer = Bench::new();
    longer.cross(7.5, false);
    longer.cross(8.5, true);
    longer.lose(9..12);
    longer.suspect(9.5, 7);
    longer.trust(12.0);
    let (record, _) = longer.outcomes();
    assert_eq!(first(&record).duration, None);
    assert_time(&record, 6.5 + 19.0, 1.0);
}

#[test]
fn who_is_in_range_for_the_whole_patience_and_still_suspected_is_mistaken_from_then_on() {
    let mut bench = Bench::new();
    bench.cross(7.5, false);
    bench.suspect(9.5, 7);
    bench.cross(15.0, true);
    bench.lose(15..19);
    bench.trust(19.0);
    bench.lose(20..23);
    bench.suspect(21.5, 19);
    bench.trust(23.0);
    let (record, _) = bench.outcomes();
    assert_eq!(
        record
            .suspicions
            .iter()
            .map(|suspicion| suspicion.verdict())
            .collect::<Vec<_>>(),
        [Verdict::OutOfRange, Verdict::Mistake]
    );
    assert_eq!(
        first(&record).duration,
        None,
        "it is not known when it would have begun"
    );
    assert_time(&record, 6.5 + 12.5, 1.5 + 1.5);
}

#[test]
fn a_failure_out_of_range_is_observed_by_nobody_and_one_in_range_is_followed_wherever_they_go() {
    let mut away = Bench::new();
    away.cross(8.0, false);
    away.0.fault(at(9.0), SUBJECT, MUTE);
    away.suspect(10.5, 8);
    assert_eq!(away.outcomes().1, []);

    let mut met_just_now = Bench::new();
    met_just_now.cross(8.0, false);
    met_just_now.cross(8.5, true);
    met_just_now.0.fault(at(9.0), SUBJECT, MUTE);
    assert_eq!(met_just_now.outcomes().1, []);

    let mut near = Bench::new();
    near.0.fault(at(9.0), SUBJECT, MUTE);
    near.cross(9.5, false);
    near.suspect(10.5, 8);
    near.cross(12.0, true);
    let (record, outcomes) = near.outcomes();
    assert_eq!(outcomes, [FailureOutcome::Detected(Span::from_secs(1.5))]);
    assert_time(&record, 8.0, 0.0);
}

#[test]
fn robots_that_meet_in_the_run_are_monitored_a_patience_after_the_statuses_show_that_they_have_met() {
    // Status 4 was sent out of range, 5 was lost and 6 read: they met at 4.5 s, give or take half a second.
    let (record, _) = Bench::meeting(5, 6).outcomes();
    assert_time(&record, 30.0 - 4.5 - PATIENCE_S, 0.0);
    // In range from the start, they are monitored from the first status on.
    let (record, _) = Bench::meeting(0, 6).outcomes();
    assert_time(&record, 24.0, 0.0);
}
