//! Figures of failure detection.

use super::*;
use crate::spool::Spool;

#[test]
fn mistakes_that_were_cut_off_count_as_having_lasted_longer() {
    let lasted = |duration: f64, cut_off| Suspicion {
        observer: ActorId(1),
        subject: ActorId(0),
        at: SimTime::from_secs(5.0),
        heard: SimTime::from_secs(1.0),
        sequence: 3,
        until: None,
        subject_down: false,
        cause: Cause::Lost(LossCause::Channel),
        missed: Missed::default(),
        duration: Some(Span::from_secs(duration)),
        cut_off,
    };
    let mut records = [trial(0, 8), trial(1, 6)];
    records[0].detection.suspicions = [lasted(1.0, false), lasted(2.0, true)].into_iter().collect();
    records[1].detection.suspicions = [lasted(4.0, false), lasted(5.0, true)].into_iter().collect();
    let found = Summary::of("duet", &TOPICS, &ROLES, &records)
        .detection
        .mistake_duration_s;
    // S is 3/4 from 1 s and 3/8 from 4 s on, to 5 s: 1 + 3 · 3/4 + 1 · 3/8.
    assert!((found.estimate.value.unwrap() - 3.625).abs() < 1e-12);
    assert_eq!((found.cut_off, found.restricted_to), (2, Some(5.0)));
}

#[test]
fn detection_figures_are_ratios_of_sums_over_trials() {
    let mistake = |duration: f64| Suspicion {
        observer: ActorId(1),
        subject: ActorId(0),
        at: SimTime::from_secs(5.0),
        heard: SimTime::from_secs(1.0),
        sequence: 3,
        until: None,
        subject_down: false,
        cause: Cause::Lost(LossCause::Channel),
        missed: Missed::default(),
        duration: Some(Span::from_secs(duration)),
        cut_off: false,
    };
    let mut records = [trial(0, 8), trial(1, 6)];
    records[0].detection = DetectionRecord {
        pairs: 2,
        monitored_s: 100.0,
        mistaken_s: 4.0,
        suspicions: [mistake(1.0), mistake(3.0)].into_iter().collect(),
        failures: Spool::default(),
    };
    records[1].detection.monitored_s = 60.0;
    let detection = Summary::of("duet", &TOPICS, &ROLES, &records).detection;
    assert_eq!((detection.suspicions.value, detection.mistakes.value), (2, 2));
    let value = |measured: &Measured| measured.estimate.value;
    let lasted = |lasted: &Lasted| lasted.estimate.value;
    assert_eq!(
        value(&detection.mistake_recurrence_s),
        Some(80.0),
        "a trial without a mistake counts too"
    );
    assert_eq!(value(&detection.mistake_rate_hz), Some(1.0 / 80.0));
    assert_eq!(lasted(&detection.mistake_duration_s), Some(2.0));
    assert_eq!(value(&detection.query_accuracy), Some(1.0 - 4.0 / 160.0));
    assert_eq!(lasted(&detection.detection_time_s), None, "nobody failed");
    let [low, high] = detection.query_accuracy.estimate.ci95;
    assert!(low < Some(0.975) && high > Some(0.975) && detection.query_accuracy.estimate.n == 2);
}
