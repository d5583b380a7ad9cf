//! NFD-S and the theorem of its quality (Chen, Toueg and Aguilera, 2002, theorem 5).
//!
//! Pairs of robots are independent samples: each link loses and delays on its own. What is counted in each begins after
//! BEGIN seconds, by which every robot has been heard and every freshness point had its chance, so that the detector is in its
//! steady state and no edge has to be reckoned with.

use std::collections::BTreeMap;

use desim::engine::SimTime;
use desim::metrics::TrialRecord;
use desim::metrics::detection::FailureOutcome;
use desim::protocol::detector::{DetectorConfig, Link, NfdSConfig, Quality, nfd_s_quality};
use desim::quantity::Positive;

use super::{LATENCY, ROBOTS, SECONDS, assert_near, heartbeats, mean_and_error, swarm};

const BEGIN: f64 = 20.0;

/// Holds the mistakes in `record` against `expected`.
fn assert_quality(what: &str, record: &TrialRecord, expected: &Quality) {
    let pairs = record.detection.pairs as usize;
    assert_eq!(pairs, (ROBOTS * (ROBOTS - 1)) as usize);
    let mut mistakes: BTreeMap<_, (f64, f64)> = BTreeMap::new();
    let mut durations = Vec::new();
    for suspicion in &record.detection.suspicions {
        let (since, until) = (
            suspicion.at.as_secs(),
            suspicion.until.map_or(SECONDS, SimTime::as_secs),
        );
        let pair = mistakes.entry((suspicion.observer, suspicion.subject)).or_default();
        pair.0 += f64::from(since >= BEGIN);
        pair.1 += (until - since.max(BEGIN)).max(0.0);
        // Of those that begin late in the run only the short ones end in it.
        if (BEGIN..SECONDS - BEGIN).contains(&since) {
            durations.push(until - since);
        }
    }
    let per_pair = |of: fn(&(f64, f64)) -> f64| -> Vec<f64> {
        let silent = std::iter::repeat_n(0.0, pairs - mistakes.len());
        mistakes.values().map(of).chain(silent).collect()
    };
    let watched = SECONDS - BEGIN;
    let (count, error) = mean_and_error(&per_pair(|pair| pair.0));
    assert!(count * pairs as f64 > 300.0, "{what}: too few mistakes to tell");
    assert_near(
        &format!("{what}: λ_M"),
        count / watched,
        1.0 / expected.mistake_recurrence_s,
        error / watched,
    );
    let (duration, error) = mean_and_error(&durations);
    assert_near(&format!("{what}: E[T_M]"), duration, expected.mistake_duration_s, error);
    let (mistaken, error) = mean_and_error(&per_pair(|pair| pair.1));
    assert_near(
        &format!("{what}: P_A"),
        1.0 - mistaken / watched,
        expected.query_accuracy,
        error / watched,
    );
}

#[test]
fn mistakes_under_independent_loss_and_random_latency_are_as_the_theorem_says() {
    // The mean latency is half an interval, so that statuses overtake each other, and some come too late.
    for (shift, p, mean) in [(1.3_f64, 0.1, 0.5), (0.6, 0.05, 0.3), (2.0, 0.3, 0.2)] {
        let arrived = |x: f64| (1.0 - p) * (1.0 - (-x.max(0.0) / mean).exp());
        let expected = nfd_s_quality(1.0, shift, arrived);
        let latency = format!("Exponential(mean: {mean:?})");
        let detector = format!("NfdS(shift: {shift:?})");
        let record = swarm(
            ROBOTS,
            &detector,
            &format!("Bernoulli({p:?})"),
            &latency,
            1.0,
            SECONDS,
            "",
        );
        assert_quality(
            &format!("δ = {shift} s, loss {p}, latency {mean} s"),
            &record,
            &expected,
        );
    }
}

#[test]
fn mistakes_under_bursts_are_those_of_a_timeout_that_is_shorter_by_the_latency() {
    let link = Link {
        interval_s: 1.0,
        good_to_bad: 0.05,
        bad_to_good: 0.2,
        latency_s: LATENCY,
    };
    let detector = DetectorConfig::NfdS(NfdSConfig {
        shift: Positive::new(2.55),
    });
    let expected = detector.quality(&link).unwrap();
    // TO = δ + η − d = 3.5 s: the published figures.
    assert!((expected.mistake_recurrence_s - 39.0625).abs() < 1e-6 && (expected.mistake_duration_s - 4.5).abs() < 1e-6);
    let loss = "GilbertElliott(good_to_bad: 0.05, bad_to_good: 0.2)";
    let record = heartbeats("NfdS(shift: 2.55)", loss, 1.0, SECONDS, "");
    assert_quality("bursts", &record, &expected);
}

/// Observers of one failure share its phase: they count once a failure, which the standard error over failures does.
#[test]
fn failures_are_detected_within_shift_and_interval_and_on_average_as_reckoned() {
    let (shift, p, mean) = (1.7, 0.2, 0.3);
    let arrived = |x: f64| (1.0 - p) * (1.0 - (-x.max(0.0) / mean).exp());
    let expected = nfd_s_quality(1.0, shift, arrived);
    let mut failures = Vec::new();
    for seed in 0..20 {
        let mute: Vec<u32> = (0..10).collect();
        let more = format!("seed: {seed}, faults: [Mute(robots: {mute:?}, at: 20.3)],");
        let latency = format!("Exponential(mean: {mean:?})");
        let record = swarm(ROBOTS, "NfdS(shift: 1.7)", "Bernoulli(0.2)", &latency, 1.0, 30.0, &more);
        let mut times: BTreeMap<_, Vec<f64>> = BTreeMap::new();
        for failure in &record.detection.failures {
            let FailureOutcome::Detected(after) = failure.outcome else {
                panic!("{failure:?}")
            };
            assert!(
                after.as_secs() <= expected.longest_detection_s + 1e-9,
                "T_D is at most δ + η"
            );
            times.entry(failure.subject).or_default().push(after.as_secs());
        }
        failures.extend(times.values().map(|times| mean_and_error(times).0));
    }
    assert_eq!(failures.len(), 200);
    let (measured, error) = mean_and_error(&failures);
    assert_near("E[T_D]", measured, expected.detection_time_s, error);
}
