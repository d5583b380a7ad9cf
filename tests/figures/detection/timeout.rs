//! The timeout detector and its closed forms.
//!
//! # The arithmetic
//! A heartbeat is sent every η and arrives after a constant latency d; an observer suspects when none has arrived for TO,
//! and trusts at the next arrival. Let G be the number of periods between two arrivals and m = ⌊TO/η⌋: a gap with G > m
//! is a mistake of duration Gη − TO. Gaps are independent under Bernoulli and under Gilbert loss (an arrival finds the link
//! good). With q = P(G > m) and s the share of heartbeats that arrive,
//!
//! - E[T_MR] = μ = η/(s q); E[T_M] = η E[G | G>m] − TO; P_A = 1 − E[T_M]/μ; the closed forms of the two losses follow;
//! - mistakes recur as one gap with G > m and K gaps with G ≤ m, K geometric of mean (1−q)/q and variance (1−q)/q², so that
//!   Var[T_MR] = η² (Var[G | G>m] + E[K] Var[G | G≤m] + Var[K] E[G | G≤m]²);
//! - the number M of mistakes of many pairs has the relative standard error √(Var[T_MR]/μ²/E[M]) of a renewal process, and
//!   monitored time over M has it too; mean durations have √(η² Var[G | G>m] / M);
//! - 1 − P_A has the standard error √(Var[T_M − R T_MR]/M)/μ, R = E[T_M]/μ, where Cov[T_M, T_MR] = Var[T_M].
//!
//! A run is finite. A pair is watched for x from an arrival on, which may be the beginning of the first mistake; a mistake
//! needs TO to be one. On average over phases x holds n = (x − TO)/η − ½ heartbeats that are sent early enough, and
//! E[M] = q (1 + s n + (1−s) λ/(1−λ)), λ = 1−p−r under Gilbert loss, which is in the good state at the first arrival, and 0
//! under Bernoulli loss: a per cent more or less than x/μ. The mistake under way at the end is not counted in T_M, which takes
//! Var[T_M]/x off its mean.
//!
//! A figure must lie within four standard errors. Seeds are fixed: what passes goes on passing.

use desim::metrics::TrialRecord;
use desim::metrics::detection::{FailureOutcome, Verdict};

use super::{Channel, LATENCY, ROBOTS, SECONDS, assert_near, bernoulli, gilbert, heartbeats, moments, summary};

fn run(loss: &str, period: f64, timeout: f64, seconds: f64, more: &str) -> TrialRecord {
    heartbeats(&format!("Timeout({timeout:?})"), loss, period, seconds, more)
}

/// Asserts that recurrence, duration and accuracy are as they should be, and that there were mistakes enough to tell.
fn assert_mistakes(channel: &Channel, period: f64, timeout: f64) {
    let what = format!("{}, η = {period} s, TO = {timeout} s", channel.loss);
    let m = (timeout / period).floor() as usize;
    let q: f64 = channel.gaps[m..].iter().sum();
    let (long, long_variance) = moments(&channel.gaps, |gap| gap > m);
    let (short, short_variance) = moments(&channel.gaps, |gap| gap <= m);
    let recurrence = period / (channel.arriving * q);
    let duration = period * long - timeout;
    let variance = period.powi(2) * long_variance;
    let recurrence_variance = variance + period.powi(2) * (1.0 - q) / q * (short_variance + short.powi(2) / q);

    let record = run(&channel.loss, period, timeout, SECONDS, "");
    let pairs = record.detection.pairs as f64;
    assert_eq!(
        record.detection.pairs,
        u64::from(ROBOTS * (ROBOTS - 1)),
        "{what}: all hear each other"
    );
    let watched = record.detection.monitored_s / pairs;
    let figures = summary(record).detection;
    let mistakes = figures.mistakes.value as f64;
    assert_eq!(
        figures.suspicions.value, figures.mistakes.value,
        "{what}: nobody failed or left"
    );
    let heartbeats = (watched - timeout) / period - 0.5;
    let transient = (1.0 - channel.arriving) * channel.memory / (1.0 - channel.memory);
    let expected = pairs * q * (1.0 + channel.arriving * heartbeats + transient);
    assert!(expected > 300.0, "{what}: {expected} mistakes tell too little");
    // What a finite run makes of the rate.
    let finite = expected * recurrence / (pairs * watched);

    let error = (recurrence_variance / recurrence.powi(2) / mistakes).sqrt();
    let measured = figures.mistake_recurrence_s.estimate.value.unwrap();
    assert_near(
        &format!("{what}: E[T_MR]"),
        measured,
        recurrence / finite,
        recurrence * error,
    );
    let measured = figures.mistake_duration_s.estimate.value.unwrap();
    assert_near(
        &format!("{what}: E[T_M]"),
        measured,
        duration - variance / watched,
        (variance / mistakes).sqrt(),
    );
    let share = duration / recurrence;
    let spread = variance * (1.0 - 2.0 * share) + share.powi(2) * recurrence_variance;
    let measured = figures.query_accuracy.estimate.value.unwrap();
    assert_near(
        &format!("{what}: P_A"),
        measured,
        1.0 - share * finite,
        (spread / mistakes).sqrt() / recurrence,
    );
}

#[test]
fn mistakes_under_independent_loss_recur_and_last_as_the_closed_form_says() {
    for (period, timeouts) in [(1.0, [1.25, 2.5]), (0.5, [1.25, 1.75])] {
        for timeout in timeouts {
            for p in [0.1, 0.2, 0.5] {
                assert_mistakes(&bernoulli(p), period, timeout);
            }
        }
    }
}

#[test]
fn mistakes_under_bursts_recur_and_last_as_the_closed_form_says() {
    for (period, timeout) in [(1.0, 2.5), (1.0, 3.5), (0.5, 1.25), (0.5, 1.75)] {
        assert_mistakes(&gilbert(0.05, 0.2), period, timeout);
    }
}

/// The general law above gives the published forms: of Bernoulli loss η/((1−p) pᵐ) and (m + 1/(1−p)) η − TO, of Gilbert's
/// η(p+r)/(r p (1−r)^(m−1)) and (m + 1/r) η − TO, for η = 1 s and TO = 3.5 s.
#[test]
fn the_laws_of_the_gaps_give_the_published_figures() {
    for (channel, recurrence, duration) in [(bernoulli(0.2), 156.25, 0.75), (gilbert(0.05, 0.2), 39.0625, 4.5)] {
        let q: f64 = channel.gaps[3..].iter().sum();
        assert!((1.0 / (channel.arriving * q) - recurrence).abs() < 1e-6);
        assert!((moments(&channel.gaps, |gap| gap > 3).0 - 3.5 - duration).abs() < 1e-6);
    }
}

/// A robot that fails at phase u of its period, after k losses in a row, is detected TO + d − (u + k) η later, or at once if it
/// was suspected by then: E[T_D] ≈ TO + d − η (½ + p/(1−p)). Observers of one failure share u, whose part of the variance
/// counts once a failure and not once an observer; that of k is p/(1−p)² and counts once a pair.
#[test]
fn failures_are_detected_after_the_time_that_the_closed_form_says() {
    const FAILING: u32 = 10;
    const RUNS: u32 = 30;
    for (period, timeout, p) in [(1.0, 3.5, 0.2), (1.0, 2.5, 0.1), (0.5, 1.75, 0.5)] {
        let what = format!("loss {p}, η = {period} s, TO = {timeout} s");
        let mute: Vec<u32> = (0..FAILING).collect();
        let mut times = Vec::new();
        for seed in 0..RUNS {
            let more = format!("seed: {seed}, faults: [Mute(robots: {mute:?}, at: 20.3)],");
            let record = run(&bernoulli(p).loss, period, timeout, 30.0, &more);
            assert_eq!(
                record.detection.failures.len(),
                (FAILING * (ROBOTS - 1)) as usize,
                "{what}"
            );
            times.extend(record.detection.failures.iter().map(|failure| match failure.outcome {
                FailureOutcome::Detected(after) => after.as_secs(),
                other => panic!("{what}: {other:?}"),
            }));
        }
        assert!(
            times.iter().all(|&after| after <= timeout + LATENCY),
            "{what}: T_D is at most TO + d"
        );
        // Over u uniform and k geometric, no time below zero.
        let expected: f64 = (0..200)
            .map(|k| {
                let chance = (1.0 - p) * f64::powi(p, k);
                let at_most = timeout + LATENCY - period * f64::from(k);
                let at_least = (at_most - period).max(0.0);
                chance
                    * if at_most > 0.0 {
                        (at_most.powi(2) - at_least.powi(2)) / (2.0 * period)
                    } else {
                        0.0
                    }
            })
            .sum();
        let (failures, observed) = (f64::from(FAILING * RUNS), times.len() as f64);
        let variance = period.powi(2) * (1.0 / 12.0 / failures + p / (1.0 - p).powi(2) / observed);
        let mean = times.iter().sum::<f64>() / observed;
        assert_near(&format!("{what}: E[T_D]"), mean, expected, variance.sqrt());
    }
}

#[test]
fn a_robot_that_is_down_is_rightly_suspected_and_a_deaf_observer_is_to_blame_itself() {
    let faults = "faults: [Mute(robots: [0], at: 100.0), Deaf(robots: [1], at: 300.0, lasts: For(50.0))],";
    let record = run("None", 1.0, 2.5, SECONDS, faults);
    let of = |verdict| {
        let suspicions = record.detection.suspicions.iter();
        suspicions.filter(move |suspicion| suspicion.verdict() == verdict)
    };
    assert_eq!(of(Verdict::Right).count(), ROBOTS as usize - 1);
    assert!(of(Verdict::Right).all(|suspicion| suspicion.subject.0 == 0 && suspicion.until.is_none()));
    assert_eq!(
        of(Verdict::Observer).count(),
        ROBOTS as usize - 2,
        "it already suspects robot 0"
    );
    assert!(of(Verdict::Observer).all(|suspicion| suspicion.observer.0 == 1 && suspicion.until.is_some()));
    assert_eq!(of(Verdict::Mistake).count(), 0);
    assert_eq!(record.detection.mistaken_s.to_bits(), 0.0_f64.to_bits());
}
