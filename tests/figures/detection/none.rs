//! Robots without a failure detector.

use super::{heartbeats, summary};

#[test]
fn robots_without_a_detector_suspect_nobody_whoever_fails_and_wake_for_no_timer() {
    let faults = "faults: [Mute(robots: [3], at: 20.3), Deaf(robots: [5], at: 30.0)],";
    let without = heartbeats("None", "Bernoulli(0.5)", 1.0, 60.0, faults);
    let seen = &without.detection;
    assert_eq!((seen.pairs, seen.suspicions.len(), seen.failures.len()), (0, 0, 0));
    assert!(without.ledger[0].delivered > 0 && without.faults.len() == 2);

    let patient = heartbeats("Timeout(1e6)", "Bernoulli(0.5)", 1.0, 60.0, faults);
    assert_eq!(without.ledger, patient.ledger, "what is sent and heard is the same");
    assert_eq!(without.events, patient.events, "a timer that is never due wakes nobody");

    let figures = summary(without).detection;
    for estimate in [
        figures.mistake_rate_hz.estimate,
        figures.query_accuracy.estimate,
        figures.mistake_recurrence_s.estimate,
    ] {
        assert_eq!(estimate.value, None);
    }
}
