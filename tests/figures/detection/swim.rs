//! SWIM and its closed forms.
//!
//! To show what probes do alone, suspicion, dissemination and awareness are off in the closed forms, and nobody counts as out of
//! range: a probe that fails is then a belief at once, and the robot's next status, within a second or two, ends it.

use std::collections::BTreeMap;

use desim::metrics::detection::{Cause, FailureOutcome, Verdict};
use desim::protocol::detector::SwimConfig;

use super::{assert_near, heartbeats, mean_and_error, swarm};

const PROBES_ALONE: &str = "Swim(suspicion_mult: 0.0, retransmit_mult: 0, max_awareness: 1, leave_timeout: 1e6)";
/// Short, so that a probe takes no noticeable part of its interval.
const LATENCY: &str = "Constant(0.001)";

/// A probe fails if the ping or its acknowledgement is lost, 1 − (1−p)², and each of k ways through others has lost one of its
/// four messages, 1 − (1−p)⁴. Robots probe once a second each, so that the number of mistakes is binomial.
#[test]
fn a_probe_fails_by_loss_as_often_as_its_closed_form_says() {
    const ROBOTS: u32 = 20;
    for (p, k, expected) in [
        (0.2_f64, 3, 0.0741),
        (0.1, 3, 0.007_73),
        (0.2, 1, 0.2125),
        (0.1, 0, 0.19),
    ] {
        let swim = SwimConfig {
            indirect_checks: k,
            ..SwimConfig::default()
        };
        let closed_form = swim.probe_failure(p);
        assert!((closed_form - expected).abs() < 5e-5, "{closed_form}");
        let seconds = 500.0;
        let detector = PROBES_ALONE.replace("max_", &format!("indirect_checks: {k}, max_"));
        let record = swarm(
            ROBOTS,
            &detector,
            &format!("Bernoulli({p:?})"),
            LATENCY,
            1.0,
            seconds,
            "",
        );
        let mistakes = record.detection.suspicions.len() as f64;
        assert!(
            record
                .detection
                .suspicions
                .iter()
                .all(|suspicion| suspicion.cause == Cause::Unanswered),
            "statuses arrived all the while"
        );
        // Robots begin on average a second or so after the start; the last probe ends with the run.
        let probes = f64::from(ROBOTS) * (seconds - 2.0);
        let error = (probes * closed_form * (1.0 - closed_form)).sqrt();
        assert_near(&format!("loss {p}, {k} others"), mistakes, probes * closed_form, error);
    }
}

/// Each of N − 1 robots probes a given one with probability 1/(N−1) in a period, so that the number of the period in which
/// somebody first does is geometric: its mean is 1/(1 − (1 − 1/(N−1))^(N−1)), for many robots 1.582. As each robot takes turns,
/// and does not draw with replacement, w periods without a probe have the probability (1 − w/(N−1))^(N−1), and the mean is less
/// by a little: 1.556 instead of 1.572 for 30 robots.
#[test]
fn a_failed_robot_is_first_probed_in_the_period_that_the_closed_form_says() {
    const ROBOTS: u32 = 30;
    let others = f64::from(ROBOTS - 1);
    let published = SwimConfig::first_detection_periods(ROBOTS as usize);
    let in_turns: f64 = (0..ROBOTS).map(|w| (1.0 - f64::from(w) / others).powf(others)).sum();
    assert!((in_turns - published).abs() < 0.02);
    assert!((SwimConfig::first_detection_periods(100) - 1.5773).abs() < 5e-5);
    assert!((SwimConfig::first_detection_periods(1_000_000) - 1.582).abs() < 5e-4);

    // Robots fall silent one after the other, each for 12 s, at all phases of the periods.
    let failures: Vec<String> = (0..50)
        .map(|failure| {
            let at = 10.0 + 16.02 * f64::from(failure);
            format!("Mute(robots: [{}], at: {at:?}, lasts: For(12.0))", failure % ROBOTS)
        })
        .collect();
    let mut periods = Vec::new();
    for seed in 0..4 {
        let more = format!("seed: {seed}, faults: [{}],", failures.join(", "));
        let record = swarm(ROBOTS, PROBES_ALONE, "None", LATENCY, 1.0, 820.0, &more);
        let mut first: BTreeMap<_, f64> = BTreeMap::new();
        for failure in &record.detection.failures {
            if let FailureOutcome::Detected(after) = failure.outcome {
                let least = first.entry(failure.at).or_insert(f64::INFINITY);
                *least = least.min(after.as_secs());
            }
        }
        assert_eq!(first.len(), failures.len(), "everybody that failed was found out");
        // The probe that fails takes an interval of its own; one that was under way at the failure belongs to the first period.
        periods.extend(first.values().map(|after| (after - 1.0).ceil().max(1.0)));
    }
    let (mean, error) = mean_and_error(&periods);
    assert_near("first detection in turns", mean, in_turns, error);
    assert_near("first detection", mean, published, error);
}

/// With everything on, at 20 % loss: suspicions are denied in time, and nobody that is well is taken for down. Who fails is
/// taken for down by everybody, on average when a probe, the suspicion of 4 · log₁₀ 20 s = 5.2 s and the news of it are over.
#[test]
fn whole_swim_takes_nobody_for_down_that_is_well_and_everybody_learns_of_a_failure() {
    let faults = "faults: [Mute(robots: [7], at: 100.3)],";
    let record = heartbeats("Swim()", "Bernoulli(0.2)", 1.0, 130.0, faults);
    // The robot that fell silent gets no answers any more: whom it takes for down is its own mistake.
    let suspicions: Vec<_> = record
        .detection
        .suspicions
        .iter()
        .filter(|suspicion| suspicion.observer.0 != 7)
        .collect();
    assert!(
        suspicions.iter().all(|suspicion| suspicion.verdict() == Verdict::Right),
        "{suspicions:?}"
    );
    let times: Vec<f64> = record
        .detection
        .failures
        .iter()
        .map(|failure| match failure.outcome {
            FailureOutcome::Detected(after) => after.as_secs(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(times.len(), 19);
    let usual = 1.582 + 0.5 + 5.204;
    let mean = mean_and_error(&times).0;
    assert!(
        (usual - 1.5..usual + 2.0).contains(&mean),
        "{mean} s on average, about {usual} s expected"
    );
}

/// A robot that goes out of range, or stays in it and falls silent for good, is taken for down after the leave timeout at the
/// latest, even if nobody is left to probe it.
#[test]
fn whoever_is_not_heard_at_all_counts_as_out_of_range() {
    let detector = "Swim(suspicion_mult: 100.0, leave_timeout: 6.0)";
    let record = swarm(
        2,
        detector,
        "None",
        LATENCY,
        1.0,
        30.0,
        "faults: [Mute(robots: [1], at: 10.4)],",
    );
    let suspicion = record
        .detection
        .suspicions
        .iter()
        .find(|suspicion| suspicion.observer.0 == 0)
        .unwrap();
    let after = suspicion.at.since(suspicion.heard).as_secs();
    assert!((after - 6.0).abs() < 1e-9, "{after}");
}

/// A status a second: of a silence no more can have been missed than the seconds in it and one, though twice as many probes and answers
/// were lost meanwhile.
#[test]
fn a_suspicion_counts_the_statuses_that_were_missed_and_no_probe() {
    let record = heartbeats("Swim(suspicion_mult: 1.0)", "Bernoulli(0.7)", 1.0, 60.0, "");
    let suspicions = &record.detection.suspicions;
    assert!(suspicions.len() > 20, "{}", suspicions.len());
    for suspicion in suspicions {
        let missed = &suspicion.missed;
        let missed = missed.lost.iter().sum::<u32>() + missed.under_way + missed.out_of_range;
        let sent = suspicion.at.since(suspicion.heard).as_secs().floor() + 1.0;
        assert!(f64::from(missed) <= sent, "{suspicion:?}");
    }
}
